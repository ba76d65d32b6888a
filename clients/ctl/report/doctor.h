#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/ctl/report/facts.h"

namespace footing::ctl::doctor {

enum class Severity { kError, kWarning, kNote };

const char* Name(Severity severity);

struct Finding {
  std::string id;  ///< Stable: "node_without_permission".
  Severity severity = Severity::kNote;
  std::string what;
  std::string where;   ///< A serial, a file, an adapter.
  std::string remedy;  ///< What to type or do; never empty.
};

/// Everything found, errors first; within a severity in the order of the checks.
std::vector<Finding> Examine(const Facts& facts);

/// No error among them.
bool Healthy(const std::vector<Finding>& findings);

/// {ok, findings: [{id, severity, what, where, remedy}]}
nlohmann::ordered_json ToJson(const std::vector<Finding>& findings);
std::string ToText(const std::vector<Finding>& findings);

/// The ids of all checks, in order.
std::vector<std::string> CheckIds();

}  // namespace footing::ctl::doctor

#pragma once

#include <string>
#include <vector>

#include "clients/ctl/commands.h"
#include "common/guide/acceptance.h"

namespace footing::ctl {

struct AcceptanceOptions {
  std::string rig = "main";
  double minutes = 10;
  std::string out;  ///< The recording.
  bool replace = false;
  bool script = false;
};

struct AcceptanceVerdict {
  std::vector<guide::Check> checks;
  std::string recording;
};

/// Leads through the phases, records everything that footingd sends meanwhile and keeps the verdict
/// in the recording's metadata "acceptance".
Result<AcceptanceVerdict> RunAcceptance(Session& session, const AcceptanceOptions& options);

/// Computes the checks again from a recording that RunAcceptance made. InvalidData when it is none.
Result<AcceptanceVerdict> ReplayAcceptance(const std::string& path);

}  // namespace footing::ctl

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::study::plan {

/// Reads the keys of a JSON object. The first fault is kept; its message names file, key, value and
/// what is allowed. A key that is missing leaves the value as it is.
class Reader {
 public:
  /// `place` names the object in messages: the file, or "FILE: survey".
  Reader(const nlohmann::ordered_json& object, std::string place);

  void Text(const std::string& key, std::string& value);
  void Flag(const std::string& key, bool& value);
  void Number(const std::string& key, double& value, double least, double greatest);
  void Whole(const std::string& key, std::uint64_t& value, std::uint64_t least,
             std::uint64_t greatest);
  /// A list of different texts; `least` to `greatest` of them.
  void Texts(const std::string& key, std::vector<std::string>& value, std::size_t least,
             std::size_t greatest);
  /// An object of its own; null when the key is missing.
  const nlohmann::ordered_json* Object(const std::string& key);
  void Require(const std::string& key);
  void Fail(const std::string& key, const std::string& what);

  /// The first fault; a key that nothing above has read is one.
  Result<void> Finish();

 private:
  const nlohmann::ordered_json* Find(const std::string& key);
  void Wrong(const std::string& key, const nlohmann::ordered_json& value,
             const std::string& allowed);

  const nlohmann::ordered_json& object_;
  std::string place_;
  std::vector<std::string> known_;
  std::optional<Error> fault_;
};

}  // namespace footing::study::plan

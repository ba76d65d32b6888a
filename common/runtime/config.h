#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"

namespace footing::config {

/// Binds keys to the fields of config structs: defaults < file < --set key=value.
///
/// A struct's owner binds each field once, with its allowed range and one line of documentation;
/// the field's value at that time is the default. Every error is one line: key, value, allowed
/// range, file.
class Binder {
 public:
  Binder() = default;
  /// For a file that is not a config; errors begin with `what` it is.
  explicit Binder(std::string what) : what_(std::move(what)) {}

  void Number(const std::string& key, double& value, double min, double max,
              const std::string& documentation);
  void Integer(const std::string& key, std::int64_t& value, std::int64_t min, std::int64_t max,
               const std::string& documentation);
  void Flag(const std::string& key, bool& value, const std::string& documentation);
  void Text(const std::string& key, std::string& value, const std::string& documentation);
  void TextList(const std::string& key, std::vector<std::string>& value,
                const std::string& documentation);
  /// An object of text values, e.g. serial to role. `check` returns what is wrong, or nothing.
  void TextMap(const std::string& key, std::map<std::string, std::string>& value,
               const std::string& documentation,
               std::function<std::string(const std::string&)> check);

  /// Applies a JSON object (comments allowed) whose unknown keys and wrong values are errors.
  Result<void> ApplyFile(const std::string& path);
  Result<void> ApplyText(const std::string& text, const std::string& origin);
  /// Applies one "key=value"; the value is JSON, or plain text for a text key.
  /// `option` is what gave it, for errors and origins.
  Result<void> ApplySetting(const std::string& setting, const std::string& option = "--set");

  /// Both in their order: `file` where it is not empty, then each of `settings`.
  Result<void> Apply(const std::string& file, const std::vector<std::string>& settings);

  bool Has(const std::string& key) const { return Find(key) != nullptr; }

  /// The effective config as a JSON object, in the order bound.
  std::string Print() const;
  /// The same with the origin of each value, a line a key: "KEY": {"value": ..., "origin":
  /// "default", "FILE:LINE" or the option}.
  std::string PrintOrigins() const;
  /// One line a key: key, range, default, documentation.
  std::string Describe() const;

 private:
  struct Entry {
    std::string key;
    std::string allowed;
    std::string documentation;
    std::function<bool(const nlohmann::ordered_json&)> assign;
    std::function<nlohmann::ordered_json()> read;
    bool text = false;
    std::string origin = "default";
    /// Reason why a value is not assigned, where `allowed` does not say it.
    std::function<std::string(const nlohmann::ordered_json&)> why = {};
  };

  /// `where` is named in errors, `origin` in PrintOrigins.
  Result<void> Assign(const std::string& key, const nlohmann::ordered_json& value,
                      const std::string& where, const std::string& origin);
  const Entry* Find(const std::string& key) const;
  Entry* Find(const std::string& key);

  std::string AllKeys() const;

  std::string what_ = "config";
  std::vector<Entry> entries_;
};

/// A key whose values differ, both as JSON.
struct Change {
  std::string key;
  std::string before;
  std::string after;
};

/// Between two configs with the same keys, in the order bound.
std::vector<Change> Differences(const Binder& before, const Binder& after);

/// The line, from 1, on which each key of the outermost object of a JSON text with comments stands
/// (the last one of a key that stands twice). Of a text that is not JSON those before the fault.
std::map<std::string, int> LinesOfKeys(const std::string& text);

/// Lines of a program that has read its config again: `before` held until now, `after` holds from
/// now on, and `wanted` was read. `files` are settings whose files have another content. One line,
/// and another one where what was read needs a restart.
std::vector<std::string> DescribeReload(const Binder& before, const Binder& after,
                                        const Binder& wanted,
                                        const std::vector<std::string>& files);

/// The same of three configs with a function Bind(Binder&).
template <typename Config>
std::vector<std::string> DescribeReload(Config before, Config after, Config wanted,
                                        const std::vector<std::string>& files) {
  Binder bound[3];
  before.Bind(bound[0]);
  after.Bind(bound[1]);
  wanted.Bind(bound[2]);
  return DescribeReload(bound[0], bound[1], bound[2], files);
}

}  // namespace footing::config

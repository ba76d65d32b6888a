#include "common/runtime/reload.h"

namespace footing::config {
namespace {

std::string Listed(const std::vector<Change>& changes) {
  std::string text;
  for (const Change& change : changes) {
    text += (text.empty() ? "" : ", ") + change.key + " " + change.before + " -> " + change.after;
  }
  return text;
}

}  // namespace

std::vector<std::string> DescribeReload(const Binder& before, const Binder& after,
                                        const Binder& wanted,
                                        const std::vector<std::string>& files) {
  const auto taken = Differences(before, after), left = Differences(after, wanted);
  std::string now = Listed(taken);
  for (const std::string& file : files) now += (now.empty() ? "" : ", ") + ("contents of " + file);
  std::vector<std::string> lines;
  if (!now.empty()) lines.push_back("config reloaded: " + now);
  if (!left.empty()) lines.push_back("config: takes effect after a restart: " + Listed(left));
  if (lines.empty()) lines.push_back("config reloaded: nothing has changed");
  return lines;
}

}  // namespace footing::config

#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/tune/search.h"

namespace footing::tune {

/// What decides a run: a kept one is gone on with only when all of it is the same.
struct RunKey {
  std::string gait;
  std::vector<double> speeds_mps;
  std::uint64_t seed = 1;
  std::string method;
  int trials = 0;
  double step = 1;
  std::string from;  ///< All gains it starts from, as text.

  bool operator==(const RunKey&) const = default;
};

/// As JSON text, to the last bit of every number.
std::string KeepRun(const RunKey& key, const std::vector<SearchState>& searches);

/// The searches of a kept run. Invalid data when the text is damaged or of another run; `path` is
/// named.
Result<std::vector<SearchState>> ResumeRun(const std::string& text, const RunKey& key,
                                           const std::string& path);

}  // namespace footing::tune

#pragma once

#include <optional>
#include <string>

#include "common/runtime/child.h"

namespace footing::log_client {

/// A recording of the pose engine with poses that also use the time after them, as footing-eval
/// smooth writes it: a copy that is removed with this object. A recording without such an engine,
/// or one whose poses had a lag when they were live, stands for itself.
class SmoothedCopy {
 public:
  /// `lag_ms` is 0, 100 or 200; 0 makes no copy. The copy is in a folder of its own within
  /// `folder`, which is made.
  SmoothedCopy(const std::string& recording, int lag_ms, const std::string& folder);

  /// Path of the copy, or of the recording itself.
  const std::string& path() const { return path_; }
  /// Reason, for a person, that a copy was asked for and could not be made; otherwise empty.
  const std::string& why_live() const { return why_live_; }

 private:
  std::optional<process::TemporaryFolder> folder_;
  std::string path_;
  std::string why_live_;
};

}  // namespace footing::log_client

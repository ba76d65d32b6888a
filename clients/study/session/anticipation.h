#pragma once

#include <cstdint>
#include <optional>

#include "common/stream/gait.h"

namespace footing::study {

/// How long before the character reached the line of a task the participant had commanded what the
/// task asks for. The gait paper asks whether "needed changes in behavior can be anticipated"
/// (section 1), since the character itself cannot answer at once.
class Anticipation {
 public:
  /// From each frame, in their order; `to_mark_m` is the distance left to the line, negative behind
  /// it, and `wanted` the gait of the task.
  void Add(std::int64_t host_ns, double to_mark_m, stream::Gait commanded, stream::Gait wanted);

  /// Instant at the line less that of the command, of the newest approach, s: negative where the
  /// command came after the line. Ahead of the line the last command counts, behind it the first
  /// one, unless there was one ahead. Nothing before both.
  std::optional<double> seconds() const;

 private:
  std::int64_t command_ns_ = 0;
  std::int64_t line_ns_ = 0;
  bool commanded_ = false;
  bool ahead_ = false;
  bool answered_ = false;  ///< This approach has its command.
};

}  // namespace footing::study

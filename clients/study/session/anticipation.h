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
  /// What a frame shows of a task.
  struct Sight {
    std::int64_t host_ns = 0;
    double to_mark_m = 0;  ///< Left to the line; negative behind it.
    stream::Gait commanded = stream::Gait::kUnspecified;
    stream::Gait running = stream::Gait::kUnspecified;  ///< The character's.
    stream::Gait wanted = stream::Gait::kUnspecified;   ///< The task's.
  };
  /// From each frame, in their order.
  void Add(const Sight& frame);

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

#pragma once

#include <string>
#include <vector>

#include "clients/view/scene/align.h"
#include "clients/view/scene/play_head.h"
#include "clients/view/scene/timeline.h"

namespace footing::timeline {

/// "0:12.3", "-0:01.5", "1:02:03.4".
std::string ClockText(double seconds);

/// "0:12.3 of 1:00.0   speed 0.25   paused".
std::string PositionText(const PlayHead& head);

/// "trial p07-1   failed attempts 2 (curve 1, jump 1)": what is so at a position; empty without a
/// trial.
std::string TrialText(const Timeline& timeline, double at_s);

/// "ended", "not begun", or empty while it plays.
std::string StateText(const SideState& state);

/// One line a mark, by time, as a terminal shows them.
std::vector<std::string> MarkLines(const Timeline& timeline);

}  // namespace footing::timeline

#pragma once

#include <string>
#include <vector>

#include "clients/view/app/play_session.h"

namespace footing::view {

/// One JSON object: the summary of a live view, and beside it `playback` with the position and all
/// trials, failures and tasks of what is played; of two recordings the second one as `beside`.
/// `seconds` is how long the viewer ran.
std::string PlaySummary(const PlaySession& session, double seconds);

/// The state at the head's position, in lines for a terminal: position, trials, and of each
/// recording what StatusScreen says of a live view.
std::vector<std::string> PlayScreenText(const PlaySession& session);
/// The same in one line.
std::string PlayLine(const PlaySession& session);

}  // namespace footing::view

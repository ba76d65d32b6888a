#pragma once

#include <string>
#include <vector>

#include "clients/view/app/options.h"
#include "common/base/result.h"

namespace footing::view {

/// The live state in the terminal: one screen redrawn four times a second, or, when standard output
/// is not a terminal, a line a second. Runs until Ctrl-C or options.seconds.
Result<void> RunTextView(const Options& options);

/// How often text is written: a terminal's screen, or a line elsewhere.
inline constexpr double kScreenEveryS = 0.25;
inline constexpr double kLineEveryS = 1;

/// True where the options and standard output want the redrawn screen, not lines.
bool WantsScreen(const Options& options);
/// One screen: clears the terminal first, says last how to leave.
std::string ScreenText(const std::vector<std::string>& lines);

}  // namespace footing::view

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/view/scene/model.h"

namespace footing::scene {

/// A number with that many decimals (0 to 9), as screens show it: "1.5". No locale.
std::string Fixed(double value, int decimals);

/// "falls 3 (curve 2, jump 1), put back by the operator 1": how often the character failed, and
/// why.
std::string FallText(const stream::GaitState& gait);
/// " (curve 2, jump 1)": failures by cause; empty without any.
std::string CauseText(const stream::FailureCounts& failures);
/// A state of a gait controller as a screen shows it: "fall", the second half of a walking step, is
/// "descend", since beside a count of falls it reads like one.
std::string PhaseTitle(const std::string& phase);
/// "WALK"; "-" for kUnspecified.
std::string GaitTitle(stream::Gait gait);

/// What one connection waits for and how to start it, in two lines; empty once it is live.
std::vector<std::string> WaitingLines(const LinkReport& link);

/// "slow motion: 1.2 s before the fall", at so many seconds from it, negative before.
std::string ReplayLine(double from_fall_s);

/// The whole state in one screen of plain text, for a terminal.
std::vector<std::string> StatusScreen(const Model& model, std::int64_t now_ns);
/// The same in one line, for a log.
std::string StatusLine(const Model& model, std::int64_t now_ns);

}  // namespace footing::scene

#pragma once

#include <optional>
#include <string>

#include "common/guide/recent.h"
#include "common/stream/setup.h"

namespace footing::guide {

/// The boards from above, drawn for a terminal; empty when there is no preset of that name.
std::string LayoutPicture(const std::string& preset);

/// Loads while the person did as asked. A board that is not there has no samples.
struct Stance {
  Load left;  ///< Of the board that has the role left_board.
  Load right;
};

struct LayoutObserved {
  std::optional<Stance> left_alone;  ///< Both are needed to find swapped boards.
  std::optional<Stance> right_alone;
  Stance upright;
  Stance forward;
};

enum class LayoutFault { kNone, kNoContact, kSwapped, kLeftTurned, kRightTurned, kBothTurned };

struct LayoutVerdict {
  LayoutFault fault = LayoutFault::kNone;
  bool degraded = false;
  double residual_mm = 0;  ///< Sideways movement of the COP while leaning forward: 0 is ideal.
  double rest_n = 0;       ///< Largest force on a board that should have been free.
  std::string note;        ///< What is wrong and what to do, or the figures.

  bool passed() const { return fault == LayoutFault::kNone; }
};

/// Leaning forward must move each board's COP forward in W; standing left must load the left one.
LayoutVerdict CheckLayout(const stream::BoardLayout& layout, const LayoutObserved& observed);

inline constexpr double kLeastLeanM = 0.015;  ///< Less movement than this does not count as a lean.

}  // namespace footing::guide

#pragma once

#include "daemon/offline/learning/examples.h"

namespace footing::learning {

/// Two interlocking spirals of three turns (Lang & Witbrock 1988, as Fahlman & Lebiere used them):
/// 194 points (x, y) within 6.5 -> +-1/2. With `denser` > 1, that many times as many points along
/// the same spirals.
Examples TwoSpirals(int denser = 1);

}  // namespace footing::learning

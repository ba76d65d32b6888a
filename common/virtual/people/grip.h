#pragma once

#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/virtual/people/style.h"

namespace footing::users {

/// How a user is to hold the remotes, in place of what the style draws.
struct GripWish {
  double rotation_rad = 0;
  /// Both about the same way, to the left or to the right; else as mirror images of each other.
  bool same = false;
};

/// From options: degrees, and `way` "mirrored" or "same". Only users of wrist and arm hold remotes
/// that they swing: a usage error else.
Result<GripWish> ParseGrip(double rotation_deg, const std::string& way,
                           stream::UserInterface interface);

/// The style of a user of this interface, with the grips and the motions given, or as drawn. Which
/// hand, and which way, is a matter of the seed.
Style StyleOf(std::uint64_t seed, stream::UserInterface interface,
              const std::optional<GripWish>& grip, const StyleWish& wish = {});

}  // namespace footing::users

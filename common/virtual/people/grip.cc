#include "common/virtual/people/grip.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::users {

using stream::UserInterface;

namespace {

constexpr double kMostDeg = 90;

Style WithGrip(std::uint64_t seed, UserInterface interface, const std::optional<GripWish>& grip) {
  if (!grip) return DrawStyle(seed, interface);
  Style style = DrawStyle(seed);
  const double side = seed % 2 == 0 ? 1 : -1;
  style.left_grip_rad = side * grip->rotation_rad;
  style.right_grip_rad = grip->same ? style.left_grip_rad : -style.left_grip_rad;
  return style;
}

}  // namespace

Result<GripWish> ParseGrip(double rotation_deg, const std::string& way, UserInterface interface) {
  if (interface != UserInterface::kWrist && interface != UserInterface::kArm) {
    return UsageError("--grip-deg: only the users of wrist and arm hold remotes that they swing");
  }
  if (!(std::fabs(rotation_deg) <= kMostDeg)) {
    return UsageError("--grip-deg takes -90 to 90 degrees");
  }
  if (way != "mirrored" && way != "same") {
    return UsageError("unknown --grip-way " + way + "; there are: mirrored, same");
  }
  return GripWish{.rotation_rad = DegreesToRadians(rotation_deg), .same = way == "same"};
}

Style StyleOf(std::uint64_t seed, UserInterface interface, const std::optional<GripWish>& grip,
              const StyleWish& wish) {
  Style style = WithGrip(seed, interface, grip);
  style.tempo = wish.tempo.value_or(style.tempo);
  style.amplitude = wish.amplitude.value_or(style.amplitude);
  style.asymmetry = wish.asymmetry.value_or(style.asymmetry);
  return style;
}

}  // namespace footing::users

#include <gtest/gtest.h>

#include <cmath>

#include "common/virtual/people/person.h"
#include "daemon/offline/eval/user_devices.h"

namespace footing::eval {
namespace {

using stream::Gait;

constexpr auto kArm = stream::UserInterface::kArm;
constexpr double kChangeS = 3, kEndS = 9;
/// 0.4 s in which the arms change over, and 1.9 cycles of 1.1 Hz (docs/interfaces.md).
constexpr double kFollowsS = 2.2;

/// How long a hand of somebody who turns while walking, then running faster and faster, shows
/// another tempo than that of the arms, once the change is over, s.
double WrongTempoS(std::uint64_t seed) {
  users::Person person(kArm, users::DrawStyle(seed, kArm), seed);
  UserDevices devices(kArm, stream::TurnSource::kUnspecified, seed);
  double wrong_s = 0;
  for (int i = 1; i * UserDevices::kTickS < kEndS; ++i) {
    const double t_s = i * UserDevices::kTickS;
    const bool runs = t_s > kChangeS;
    person.Advance(t_s, {.gait = runs ? Gait::kRun : Gait::kWalk,
                         .turn_rad = std::fmod(t_s, 1.2) < 0.5 ? 0.0873 : 0,
                         .effort = runs ? (t_s - kChangeS) / (kEndS - kChangeS) : 0.8});
    const mapping::Inputs inputs = devices.Take(person.felt());
    const auto wrong = [&person](const mapping::LimbFeatures& hand) {
      return !hand.frequency_valid || std::fabs(hand.frequency_hz / person.limb_hz() - 1) > 0.25;
    };
    const bool over = t_s > kChangeS + kFollowsS;
    if (over && (wrong(inputs.hands.left) || wrong(inputs.hands.right))) {
      wrong_s += UserDevices::kTickS;
    }
  }
  return wrong_s;
}

/// Of 120 users these are the ones of whom one hand showed half its tempo to the end.
TEST(UserTempo, OfArmsThatBeginToRunInATurnIsThatOfBothHands) {
  for (const std::uint64_t seed : {39, 75, 100}) EXPECT_LT(WrongTempoS(seed), 0.1) << seed;
}

}  // namespace
}  // namespace footing::eval

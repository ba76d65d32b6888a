#include "common/guide/mounting.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::guide {
namespace {

constexpr double kStillMps2 = 0.8;     // A standing person's hands and shins stay under half.
constexpr double kSteppingMps2 = 1.5;  // The slowest step shakes a shin or wrist more.
constexpr std::int64_t kWindowNs = 500'000'000;        // Of the shake that Advance is given.
constexpr std::int64_t kStepsLeastNs = 1'000'000'000;  // Three steps take longer.
constexpr std::int64_t kStepsMostNs = 12'000'000'000;
constexpr std::int64_t kStandAgainNs = 700'000'000;

constexpr const char* kShin = R"(
        the leg from its outside
          |       |
          (       ) knee
          | .---. |
         =|=|[_]|=|=  <- strap    ^
          | | + | |               |  front (camera) up
          | |(A)| |
          | |ooo| |     buttons away from the leg
         =|=|   |=|=  <- strap
          | '---' |
          |       '----.
          '------------'  toes ->
)";

constexpr const char* kHead = R"(
             _^__^___^___
            |_________[_]|==>  front (camera)
           .-'----------'-.      where you look
          /                \     buttons up
         |==================|  <- head band
         |     c         o  |
         |                  >
          \            .____|
           |          |
)";

constexpr const char* kTrunk = R"(
            .--.         .--.
           /    '-------'    \
          |      .-----.      |   front (camera) up
          |======|[_]  |======|   <- strap
          |      | +   |      |
          |      |(A)  |      |   buttons away from the chest
          |      '-----'      |
)";

constexpr const char* kWrist = R"(
        front (camera) to the fingers  ==>
                                 ___
      ______________________.---'  /.______
              ||       ||          '-------)
         .----||-------||----.      -------)
         |::: ||o ooo  ||( + [|     -------)
         '----||-------||----'      ------)
      ________||_______||_______.________)
              ^ straps ^
        buttons up, on the back of the wrist; or held in the hand
)";

struct Mounted {
  const char* picture = "";
  const char* text = "";
};

/// How a device of that role is worn; nothing for one that needs no mounting.
Mounted MountedAs(stream::DeviceRole role) {
  switch (role) {
    case stream::DeviceRole::kLeftLeg:
      return {kShin, "left leg: outside of the shin, buttons outwards, front up"};
    case stream::DeviceRole::kRightLeg:
      return {kShin, "right leg: outside of the shin, buttons outwards, front up"};
    case stream::DeviceRole::kHead:
      return {kHead, "head: on top under the band, buttons up, front where you look"};
    case stream::DeviceRole::kTrunk:
      return {kTrunk, "trunk: on the breastbone under the strap, buttons outwards, front up"};
    case stream::DeviceRole::kLeftHand:
      return {kWrist, "left wrist: buttons up, front along the fingers"};
    case stream::DeviceRole::kRightHand:
      return {kWrist, "right wrist: buttons up, front along the fingers"};
    case stream::DeviceRole::kLeftBoard:
    case stream::DeviceRole::kRightBoard:
    case stream::DeviceRole::kLeftUpperArm:
    case stream::DeviceRole::kRightUpperArm:
    case stream::DeviceRole::kLeftForearm:
    case stream::DeviceRole::kRightForearm:
    case stream::DeviceRole::kEditor:
    case stream::DeviceRole::kUnspecified:
      return {};
  }
  return {};
}

}  // namespace

bool NeedsMounting(stream::DeviceRole role) {
  return CanBeMounted(role) && role != stream::DeviceRole::kLeftHand &&
         role != stream::DeviceRole::kRightHand;
}

bool CanBeMounted(stream::DeviceRole role) { return !Wearing(role).empty(); }

std::string Picture(stream::DeviceRole role) { return MountedAs(role).picture; }

std::string Wearing(stream::DeviceRole role) { return MountedAs(role).text; }

double StillThenSteps::still_s(std::int64_t now_ns) const {
  if (still_from_ns_ == 0) return 0;
  return std::clamp(NanosecondsToSeconds(now_ns - kWindowNs - still_from_ns_), 0.0, kStillForS);
}

void StillThenSteps::Advance(std::int64_t now_ns, double moving_mps2) {
  if (phase_ == Phase::kStill) {
    if (moving_mps2 > kStillMps2) {
      still_from_ns_ = 0;
      return;
    }
    // The whole window that the shake is taken over was still.
    if (still_from_ns_ == 0) still_from_ns_ = now_ns - kWindowNs;
    // The newest window may hold the beginning of a movement: it belongs to the steps.
    still_to_ns_ = now_ns - kWindowNs;
    if (NanosecondsToSeconds(still_to_ns_ - still_from_ns_) < kStillForS) return;
    moved_first_ns_ = 0;
    phase_ = Phase::kSteps;
    return;
  }
  if (phase_ == Phase::kDone) return;
  if (moving_mps2 > kSteppingMps2) {
    if (moved_first_ns_ == 0) moved_first_ns_ = now_ns;
    moved_last_ns_ = now_ns;
  } else if (moved_first_ns_ == 0) {
    // Still standing: the newest stillness is the one that counts, up to the first movement.
    if (moving_mps2 <= kStillMps2) {
      still_to_ns_ = now_ns - kWindowNs;
      still_from_ns_ =
          std::max(still_from_ns_, still_to_ns_ - SecondsToNanoseconds(2 * kStillForS));
    }
    return;
  }
  const bool stands_again = now_ns - moved_last_ns_ > kStandAgainNs;
  const bool took_steps = moved_last_ns_ - moved_first_ns_ > kStepsLeastNs;
  if (stands_again && !took_steps) {  // A twitch.
    *this = StillThenSteps();
    return;
  }
  if (stands_again || now_ns - moved_first_ns_ > kStepsMostNs) {
    steps_to_ns_ = now_ns;
    phase_ = Phase::kDone;
  }
}

}  // namespace footing::guide

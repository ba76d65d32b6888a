#include "common/guide/own_motion.h"

namespace footing::guide {
namespace {

constexpr std::array<MotionStep, kMotionSteps> kMotionTable{{
    {"t_pose", 8, "Stand in the T-pose, arms out to the sides, and hold still."},
    {"stand", 5, "Lower your arms and stand upright."},
    {"squat", 14, "Squat three times, as deep as is comfortable, arms to the front."},
    {"slow_squat", 12, "Squat once more, slowly: five seconds down, five seconds up."},
    {"lean", 10, "Lean forward and back from the ankles, then to the left and to the right."},
    {"stoop", 12, "Reach for the floor twice, with nearly straight legs."},
    {"twist", 10, "Turn your trunk to the left and to the right, twice each."},
    {"knees", 14, "Raise the left knee, then the right knee, twice each."},
    {"reach", 12, "Reach up, to the front, and to each side."},
    {"arms", 8, "Circle both arms slowly."},
    {"free", 15, "Move as you will later, with both feet on the boards."},
}};

}  // namespace

const std::array<MotionStep, kMotionSteps>& OwnMotionSteps() { return kMotionTable; }

double OwnMotionSeconds() {
  double seconds = 0;
  for (const MotionStep& step : kMotionTable) seconds += step.seconds;
  return seconds;
}

}  // namespace footing::guide

#include "common/virtual/people/range_acts.h"

#include <cmath>

namespace footing::users {
namespace {

using stream::Gait;
using stream::UserInterface;

/// Which side; how far is a matter of the style.
constexpr double kLeftRad = 0.1, kRightRad = -0.1;
/// Size of a gentle jump.
constexpr double kGentle = 0.5;

void AddBothSides(std::vector<Act>& acts, Gait gait, double effort, double duration_s) {
  for (const double turn_rad : {kLeftRad, kRightRad}) {
    acts.push_back({{.gait = gait, .turn_rad = turn_rad, .effort = effort}, duration_s});
  }
}

/// A heel rise that was begun is finished; a user who wants it for longer walks on after it.
std::vector<Act> BoardActs() {
  std::vector<Act> acts{{{.gait = Gait::kWalk, .effort = 0}, 5},
                        {{.gait = Gait::kRun, .effort = 1}, 4},
                        {{.gait = Gait::kStep}, 1.5}};
  for (const double size : {kGentle, kGentle, kGentle, 1.0, 1.0, 1.0}) {
    acts.push_back({{.gait = Gait::kJump, .size = size}, 0.4});
    acts.push_back({{.gait = Gait::kStep}, 1.2});
  }
  AddBothSides(acts, Gait::kWalk, 0.5, 4);
  AddBothSides(acts, Gait::kStep, 0, 3);
  return acts;
}

std::vector<Act> LimbActs(Gait turning) {
  std::vector<Act> acts{{{.gait = Gait::kWalk, .effort = 0}, 5},
                        {{.gait = Gait::kRun, .effort = 1}, 3},
                        {{.gait = Gait::kJump, .size = kGentle}, 3.5},
                        {{.gait = Gait::kJump}, 3.5}};
  AddBothSides(acts, turning, 0, 2.5);
  return acts;
}

/// Straight arms walk; bent ones run and incline.
std::vector<Act> ArmActs() {
  std::vector<Act> acts{
      {{.gait = Gait::kWalk, .effort = 0}, 4},       {{.gait = Gait::kWalk, .effort = 1}, 3},
      {{.gait = Gait::kRun, .effort = 0}, 3.5},      {{.gait = Gait::kRun, .effort = 1}, 2.5},
      {{.gait = Gait::kJump, .size = kGentle}, 2.5}, {{.gait = Gait::kJump}, 2.5}};
  AddBothSides(acts, Gait::kRun, 0, 2);
  return acts;
}

}  // namespace

std::vector<Act> RangeActs(UserInterface interface, stream::TurnSource turn_by) {
  switch (interface) {
    case UserInterface::kBoards:
      return BoardActs();
    case UserInterface::kArm:
      return ArmActs();
    case UserInterface::kLeg:
      return LimbActs(turn_by == stream::TurnSource::kFeet ? Gait::kWalk : Gait::kStep);
    case UserInterface::kWrist:
      return LimbActs(Gait::kStep);
    case UserInterface::kJoystick:
    case UserInterface::kUnspecified:
      return {};
  }
  return {};
}

const Intention& WantedAt(const std::vector<Act>& acts, double time_s) {
  double all_s = 0;
  for (const Act& act : acts) all_s += act.duration_s;
  double left_s = std::fmod(time_s, all_s);
  for (const Act& act : acts) {
    if (left_s < act.duration_s) return act.wanted;
    left_s -= act.duration_s;
  }
  return acts.back().wanted;
}

}  // namespace footing::users

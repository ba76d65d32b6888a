#include "tests/scenarios/person/body.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/units/units.h"

namespace footing::scenario {
namespace {

constexpr double kWeight_n = 70 * kStandardGravityMps2;
constexpr double kLean_m = 0.05;
constexpr double kFollow_s = 0.1;
constexpr double kHalfX_m = 0.433 / 2;  // Sensor distances of the board.
constexpr double kHalfY_m = 0.238 / 2;
// One foot on each: long axes fore and aft, power buttons outwards.
constexpr double kYaw_rad[2] = {-kPi / 2, kPi / 2};
constexpr double kTremor_mps2 = 0.05;
constexpr double kSway_m = 0.002;
const Eigen::Vector3d kSwing_S = Eigen::Vector3d(0, 0.6, 0.8);

double Follow(double value, double target, double elapsed_s) {
  return target + (value - target) * std::exp(-elapsed_s / kFollow_s);
}

}  // namespace

bool Body::Tell(const std::string& line) {
  std::istringstream words(line);
  std::string verb;
  std::string which;
  words >> verb;
  if (verb == "slip") {
    double degrees = 0;
    if (!(words >> degrees)) return false;
    slip_rad_ = DegreesToRadians(degrees);
    return true;
  }
  words >> which;
  const int side = which == "right" ? 1 : 0;
  const auto both = [this](const Swing& swing) { swing_ = {swing, swing}; };
  if (verb == "off" || verb == "left" || verb == "right" || verb == "both") {
    stance_ = verb;
    lean_m_ = 0;
  } else if (verb == "lean") {
    lean_m_ = kLean_m;
  } else if (verb == "still") {
    both({});
  } else if (verb == "shake") {
    both({});
    swing_[side] = {4, 0, 20};
  } else if (verb == "walk" || verb == "steps") {
    both({1.3, kPi, 8});
  } else if (verb == "run") {
    both({2.6, kPi, 14});
  } else if (verb == "jump") {
    both({1.3, 0, 14});
  } else if (verb == "swap") {
    swapped_ = !swapped_;
  } else if (verb == "turn") {
    turned_[side] = !turned_[side];
  } else {
    return false;
  }
  return true;
}

/// Share of the weight on the board that lies left (0) or right (1).
double Body::Share(int place) const {
  if (stance_ == "both") return 0.5;
  return stance_ == (place == 0 ? "left" : "right") ? 1 : 0;
}

device_models::CornerForces Body::Board(int board, double t_s) {
  const auto i = static_cast<std::size_t>(board);
  const double elapsed_s = std::max(0.0, t_s - board_s_[i]);
  board_s_[i] = t_s;
  const int place = swapped_ ? 1 - board : board;
  share_[i] = Follow(share_[i], Share(place), elapsed_s);
  leaning_m_[i] = Follow(leaning_m_[i], lean_m_, elapsed_s);
  const double yaw_rad = kYaw_rad[place] + (turned_[i] ? kPi : 0);
  const double forward_m = leaning_m_[i] + kSway_m * std::sin(2 * kPi * 0.7 * t_s);
  // In the plate's frame: x to the right, y to the front; yaw turns the front away from forward.
  const double x = forward_m * std::sin(yaw_rad) / kHalfX_m;
  const double y = forward_m * std::cos(yaw_rad) / kHalfY_m;
  const double quarter_n = (share_[i] * kWeight_n + 0.5 * random_.Normal()) / 4;
  return {quarter_n * (1 - x) * (1 + y), quarter_n * (1 + x) * (1 + y),
          quarter_n * (1 - x) * (1 - y), quarter_n * (1 + x) * (1 - y)};
}

Eigen::Vector3d Body::Hand(int hand, double t_s) {
  const auto i = static_cast<std::size_t>(hand);
  const double elapsed_s = std::max(0.0, t_s - hand_s_[i]);
  hand_s_[i] = t_s;
  const Swing& swing = swing_[i];
  // Both angles advance alike; their difference follows the phase that is asked for.
  angle_rad_[i] += 2 * kPi * swing.frequency_hz * elapsed_s;
  const double phase_rad = angle_rad_[i] + (i == 1 ? swing.phase_rad : 0);
  const double wave = std::sin(phase_rad) + 0.3 * std::sin(2 * phase_rad + 0.6);
  Eigen::Vector3d force =
      Eigen::Vector3d(0, 0, -kStandardGravityMps2) + swing.amplitude_mps2 * wave * kSwing_S;
  for (int axis = 0; axis < 3; ++axis) force[axis] += kTremor_mps2 * random_.Normal();
  if (i != 1) return force;
  return Eigen::AngleAxisd(slip_rad_, Eigen::Vector3d::UnitX()) * force;
}

}  // namespace footing::scenario

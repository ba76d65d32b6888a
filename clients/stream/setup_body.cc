#include "clients/stream/setup_body.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/base/units.h"

namespace footing::stream_client {
namespace {

constexpr double kLeanM = 0.05;
constexpr double kFollowS = 0.1;
constexpr double kHalfXM = board::kBalanceBoard.sensor_distance_x_m / 2;
constexpr double kHalfYM = board::kBalanceBoard.sensor_distance_y_m / 2;
constexpr double kTremorMps2 = 0.05;
constexpr double kSwayM = 0.002;
constexpr double kOvertone = 0.25;  // Without it half a period would look like a whole one.
constexpr double kRattleRad = 0.5;  // How far a loose strap turns about the limb, to and fro.
constexpr double kRattleHz = 0.35;  // Slow, so that two parts of three steps differ.
const Eigen::Vector3d kSwing_M = Eigen::Vector3d(0, 0.6, 0.8);

/// How the straps sit in truth: f_S = this * f_M.
Eigen::Quaterniond Askew(int limb) {
  return limb == 0 ? Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized()
                   : Eigen::Quaterniond(0.5, -0.6, 0.2, 0.5).normalized();
}

double Follow(double value, double target, double elapsed_s) {
  return target + (value - target) * std::exp(-elapsed_s / kFollowS);
}

}  // namespace

SetupBody::SetupBody(Place place, double mass_kg, int boards)
    : place_(place), weight_n_(KilogramsToNewtons(mass_kg)), boards_(boards) {
  const auto poses = board::OneFootEach(0);
  Lay(poses[0].yaw_rad, poses[1].yaw_rad);
}

stream::DeviceRole SetupBody::Role(int limb) const {
  using stream::DeviceRole;
  if (place_ == Place::kShins) return limb == 0 ? DeviceRole::kLeftLeg : DeviceRole::kRightLeg;
  return limb == 0 ? DeviceRole::kLeftHand : DeviceRole::kRightHand;
}

bool SetupBody::Do(const std::string& line) {
  std::istringstream words(line);
  std::string verb;
  std::string which;
  words >> verb >> which;
  const auto side = static_cast<std::size_t>(which == "right" ? 1 : 0);
  const auto both = [this](const Swing& swing) {
    swing_ = {swing, swing};
    swinging_s_ = {};
  };
  if (verb == "off" || verb == "left" || verb == "right" || verb == "both") {
    stance_ = verb;
    lean_m_ = 0;
  } else if (verb == "lean") {
    lean_m_ = kLeanM;
  } else if (verb == "still") {
    both({});
  } else if (verb == "shake") {
    both({});
    swing_[side] = {4, 20, false};
  } else if (verb == "walk") {
    both({1.3, 8, true});
  } else if (verb == "run") {
    both({2.6, 14, true});
  } else if (verb == "jump") {
    both({1.3, 14, false});
  } else if (verb == "swap") {
    swapped_ = !swapped_;
  } else if (verb == "turn") {
    turned_[side] = !turned_[side];
  } else if (verb == "slip") {
    double degrees = 0;
    if (!(words >> degrees)) return false;
    strap_[side].slip_rad = DegreesToRadians(degrees);
  } else if (verb == "loose") {
    strap_[side].loose = !strap_[side].loose;
  } else {
    return false;
  }
  return true;
}

/// Share of the weight on the board that lies left (0) or right (1).
double SetupBody::Share(int place) const {
  if (stance_ == "both") return boards_ == 1 ? 1 : 0.5;
  return stance_ == (place == 0 ? "left" : "right") ? 1 : 0;
}

virtual_devices::CornerForces SetupBody::Board(int board, double t_s) {
  const auto i = static_cast<std::size_t>(board);
  const double elapsed_s = std::max(0.0, t_s - board_s_[i]);
  board_s_[i] = t_s;
  const int place = swapped_ ? 1 - board : board;
  share_[i] = Follow(share_[i], Share(place), elapsed_s);
  leaning_m_[i] = Follow(leaning_m_[i], lean_m_, elapsed_s);
  const double yaw_rad = yaw_rad_[static_cast<std::size_t>(place)] + (turned_[i] ? kPi : 0);
  const double forward_m = leaning_m_[i] + kSwayM * std::sin(2 * kPi * 0.7 * t_s);
  // In the plate's frame: x to the right, y to the front; yaw turns the front away from forward.
  const double x = forward_m * std::sin(yaw_rad) / kHalfXM;
  const double y = forward_m * std::cos(yaw_rad) / kHalfYM;
  const double quarter_n = (share_[i] * weight_n_ + 0.5 * random_.Normal()) / 4;
  return {quarter_n * (1 - x) * (1 + y), quarter_n * (1 + x) * (1 + y),
          quarter_n * (1 - x) * (1 - y), quarter_n * (1 + x) * (1 - y)};
}

/// Along kSwing_M, from rest, in units of the amplitude.
double SetupBody::Wave(int limb) const {
  const auto i = static_cast<std::size_t>(limb);
  const Swing& swing = swing_[i];
  double cycles = swing.frequency_hz * swinging_s_[i];
  if (swing.in_turns && place_ == Place::kShins && limb == 1) cycles -= 0.5;
  if (cycles <= 0) return 0;
  const bool back = swing.in_turns && place_ != Place::kShins && limb == 0;
  const double angle_rad = 2 * kPi * cycles + (back ? kPi : 0);
  return std::sin(angle_rad) + kOvertone * std::sin(2 * angle_rad);
}

Eigen::Vector3d SetupBody::Limb(int limb, double t_s) {
  const auto i = static_cast<std::size_t>(limb);
  const double elapsed_s = std::max(0.0, t_s - limb_s_[i]);
  limb_s_[i] = t_s;
  swinging_s_[i] += elapsed_s;
  Eigen::Vector3d force_M = Eigen::Vector3d(0, 0, -kStandardGravityMps2) +
                            swing_[i].amplitude_mps2 * Wave(limb) * kSwing_M;
  for (int axis = 0; axis < 3; ++axis) force_M[axis] += kTremorMps2 * random_.Normal();
  double about_limb_rad = strap_[i].slip_rad;
  if (strap_[i].loose && swing_[i].amplitude_mps2 > 0) {
    about_limb_rad += kRattleRad * std::sin(2 * kPi * kRattleHz * swinging_s_[i]);
  }
  const Eigen::Quaterniond strapped =
      place_ == Place::kHands ? Eigen::Quaterniond::Identity() : Askew(limb);
  return strapped * (Eigen::AngleAxisd(about_limb_rad, Eigen::Vector3d::UnitZ()) * force_M);
}

}  // namespace footing::stream_client

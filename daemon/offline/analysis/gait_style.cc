#include "daemon/offline/analysis/gait_style.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::style {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFootRadiusM = 0.02;
/// A contact that changes for less than this chatters.
constexpr double kChatterS = 0.02;
constexpr int kJerkTicks = 10;
constexpr std::size_t kHips[] = {1, 3}, kShanks[] = {2, 4};  // EngineOutput::links.

/// Weights of a half wave (the stride's) and of a whole one in a step.
Vector2d Wave(double phase, double turns) {
  return {std::cos(turns * 2 * kPi * phase), std::sin(turns * 2 * kPi * phase)};
}

/// Hinge angles yaw, roll, pitch of R = Rz Rx Ry, and the length.
std::array<double, 4> Joints(const engine::EngineOutput& output, std::size_t side) {
  const Eigen::Matrix3d R =
      (output.links[0].orientation.conjugate() * output.links[kShanks[side]].orientation)
          .toRotationMatrix();
  const Vector3d foot_m = output.contacts[side].position_m + Vector3d(0, 0, kFootRadiusM);
  return {std::atan2(-R(0, 1), R(1, 1)), std::asin(std::clamp(R(2, 1), -1.0, 1.0)),
          std::atan2(-R(2, 0), R(2, 2)), (output.links[kHips[side]].position_m - foot_m).norm()};
}

Swing SwingOf(const Vector2d& harmonic, int steps, double turns) {
  return {harmonic.norm() / std::max(1, steps),
          std::atan2(harmonic.y(), harmonic.x()) / (2 * kPi * turns)};
}

double Difference(double left, double right) {
  const double mean = (left + right) / 2;
  return mean != 0 ? std::fabs(left - right) / std::fabs(mean) : 0;
}

}  // namespace

void StyleMeter::AddSide(const engine::EngineOutput& output, std::size_t side) {
  Side& leg = sides_[side];
  const stream::Contact& contact = output.contacts[side];
  const Eigen::Quaterniond& shank = output.links[kShanks[side]].orientation;
  const std::array<double, 4> joints = Joints(output, side);
  if (time_s_ > 0) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      sums_.energy_j += std::fabs(output.joint_efforts[4 * side + j] * (joints[j] - leg.joints[j]));
    }
    // The ball rolls: its touching point moves less than its centre does.
    const Eigen::AngleAxisd turn(shank * leg.shank.conjugate());
    const Vector3d moved_m = contact.position_m - leg.p_W_m +
                             turn.angle() * turn.axis().cross(Vector3d(0, 0, -kFootRadiusM));
    if (leg.down && contact.touching) leg.slid_m += moved_m.head<2>();
  }
  leg.furthest_m = std::max(leg.furthest_m, leg.slid_m.norm());
  if (contact.touching) {
    sums_.penetration_m = std::max(sums_.penetration_m, -contact.position_m.z());
  }
  if (contact.touching == leg.down) leg.changed_s = time_s_;
  const bool lands = contact.touching && !leg.down;
  if (lands || time_s_ - leg.changed_s > kChatterS) {
    if (!lands && leg.landed_s > 0) {
      slides_.sum_m += leg.furthest_m;
      slides_.max_m = std::max(slides_.max_m, leg.furthest_m);
      ++slides_.stances;
    }
    leg.down = contact.touching;
    leg.changed_s = time_s_;
    if (lands) leg.landed_s = time_s_;
    leg.slid_m.setZero();
    leg.furthest_m = 0;
  }
  leg.p_W_m = contact.position_m;
  leg.shank = shank;
  leg.joints = joints;
}

void StyleMeter::AddJerk(const engine::EngineOutput& output) {
  if (ticks_++ % kJerkTicks != 0) return;
  const double interval_s = kJerkTicks * step_s_;
  if (ticks_ > 2 * kJerkTicks) {
    const Vector3d jerk =
        (output.v_WC_mps - 2 * velocities_[0] + velocities_[1]) / (interval_s * interval_s);
    sums_.jerk_squared += jerk.squaredNorm();
    ++sums_.jerks;
  }
  velocities_ = {output.v_WC_mps, velocities_[0]};
}

void StyleMeter::EndStep(const engine::EngineOutput& output) {
  const double side = biped::Side(static_cast<int>(carries_));
  const auto count = static_cast<double>(step_.size());
  double lowest_m = INFINITY, highest_m = -INFINITY, pitch_sum = 0;
  for (std::size_t i = 0; i < step_.size(); ++i) {
    const Sample& sample = step_[i];
    const double phase = static_cast<double>(i) / count;
    const Vector2d once = 2 / count * Wave(phase, 1), half = 2 / count * side * Wave(phase, 0.5);
    sums_.height += sample.height_m * once;
    sums_.pitch += sample.pitch_rad * once;
    sums_.left += sample.left_m * half;
    sums_.roll += sample.roll_rad * half;
    sums_.yaw -= sample.yaw_rad * half;
    pitch_sum += sample.pitch_rad;
    lowest_m = std::min(lowest_m, sample.height_m);
    highest_m = std::max(highest_m, sample.height_m);
  }
  const double way_m = (output.p_WC_m - started_W_m).head<2>().norm();
  sums_.lean_rad += pitch_sum / count;
  sums_.bob_m += highest_m - lowest_m;
  sums_.way_m += way_m;
  sums_.time_s += count * step_s_;
  ++sums_.steps;
  Side& leg = sides_[carries_];
  leg.times_s += count * step_s_;
  leg.lengths_m += way_m;
  ++leg.steps;
}

void StyleMeter::Add(const engine::EngineOutput& output) {
  AddSide(output, 0);
  AddSide(output, 1);
  AddJerk(output);
  const double heading_rad = output.gait.heading_rad;
  const bool touches = steps_ && output.gait.steps != *steps_;
  if (touches) {
    if (whole_) EndStep(output);
    whole_ = true;
    step_.clear();
    started_W_m = output.p_WC_m;
    carries_ = sides_[0].landed_s > sides_[1].landed_s ? 0 : 1;
    Side& lands = sides_[carries_];
    const Vector3d between_H =
        gait::ToHeading(heading_rad, lands.p_W_m - sides_[1 - carries_].foothold_W_m);
    lands.foothold_W_m = lands.p_W_m;
    if (sums_.steps > 1 && output.gait.gait != stream::Gait::kJump) {
      sums_.width_m += biped::Side(static_cast<int>(carries_)) * between_H.y();
      ++sums_.widths;
    }
  }
  steps_ = output.gait.steps;
  const Eigen::Matrix3d R = output.links[0].orientation.toRotationMatrix();
  const Vector3d up_H = gait::ToHeading(heading_rad, R.col(2));
  const Vector3d ahead_H = gait::ToHeading(heading_rad, R.col(0));
  step_.push_back({output.p_WC_m.z(), gait::ToHeading(heading_rad, output.p_WC_m).y(),
                   std::atan2(up_H.x(), up_H.z()), -std::atan2(up_H.y(), up_H.z()),
                   std::atan2(ahead_H.y(), ahead_H.x())});
  const bool left = output.contacts[0].touching, right = output.contacts[1].touching;
  if (left && right) sums_.both_s += step_s_;
  if (!left && !right) sums_.none_s += step_s_;
  time_s_ += step_s_;
}

GaitStyle StyleMeter::Report() const {
  GaitStyle style;
  style.steps = sums_.steps;
  if (sums_.steps == 0 || !(time_s_ > 0)) return style;
  style.speed_mps = sums_.way_m / sums_.time_s;
  style.cadence_hz = sums_.steps / sums_.time_s;
  style.step_length_m = sums_.way_m / sums_.steps;
  style.step_width_m = sums_.width_m / std::max(1, sums_.widths);
  style.bob_m = sums_.bob_m / sums_.steps;
  style.bob_low_phase = SwingOf(-sums_.height, sums_.steps, 1).peak_phase;
  style.sway_m = 2 * sums_.left.norm() / sums_.steps;
  style.lean_rad = sums_.lean_rad / sums_.steps;
  style.pitch = SwingOf(sums_.pitch, sums_.steps, 1);
  style.roll = SwingOf(sums_.roll, sums_.steps, 0.5);
  style.yaw = SwingOf(sums_.yaw, sums_.steps, 0.5);
  style.double_support_share = sums_.both_s / time_s_;
  style.flight_share = sums_.none_s / time_s_;
  style.slide_mean_m = slides_.sum_m / std::max(1, slides_.stances);
  style.slide_max_m = slides_.max_m;
  style.penetration_m = sums_.penetration_m;
  style.jerk_rms_mps3 = std::sqrt(sums_.jerk_squared / std::max(1, sums_.jerks));
  const double way_m = style.speed_mps * time_s_;
  if (way_m > 0) style.work_n = sums_.energy_j / way_m;
  if (sides_[0].steps > 0 && sides_[1].steps > 0) {
    const auto mean = [this](std::size_t side, double sum) { return sum / sides_[side].steps; };
    style.asymmetry =
        std::max(Difference(mean(0, sides_[0].times_s), mean(1, sides_[1].times_s)),
                 Difference(mean(0, sides_[0].lengths_m), mean(1, sides_[1].lengths_m)));
  }
  return style;
}

double AlexanderCadence(double speed_mps, double hip_height_m) {
  const double stride_m =
      std::pow(speed_mps * std::pow(hip_height_m, 1.17) / (0.25 * std::sqrt(kStandardGravityMps2)),
               1 / 1.67);
  return stride_m > 0 ? 2 * speed_mps / stride_m : 0;
}

double OrendurffBob(double speed_mps) {
  constexpr double kSlowMps = 0.7, kFastMps = 1.6, kSlowM = 0.0274, kFastM = 0.0483;
  return kSlowM + (kFastM - kSlowM) * (speed_mps - kSlowMps) / (kFastMps - kSlowMps);
}

PelvisReference SaundersPelvis(double speed_mps) {
  constexpr double kFreeMps = 1.2, kRollDeg = 5, kRollPhase = 0.4, kYawDeg = 4;
  const auto step_m = [](double mps) {
    const double cadence_hz = AlexanderCadence(mps, kHipHeightM);
    return cadence_hz > 0 ? mps / cadence_hz : 0;
  };
  const double share = step_m(speed_mps) / step_m(kFreeMps);
  return {{share * DegreesToRadians(kRollDeg), kRollPhase}, {share * DegreesToRadians(kYawDeg), 0}};
}

double Distance(double amplitude, double phase, double other_amplitude, double other_phase,
                double turns) {
  return (amplitude * Wave(phase, turns) - other_amplitude * Wave(other_phase, turns)).norm();
}

}  // namespace footing::style

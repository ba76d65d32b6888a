#include "daemon/offline/tune/gait_meter.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/offline/analysis/leg_gap.h"

namespace footing::tune {
namespace {

constexpr double kWindowS = 0.5;
constexpr double kChatterS = 0.02;

}  // namespace

void GaitMeter::Watch(Contact& contact, bool down, double time_s) {
  if (!contact.known || down == contact.down) {
    contact.known = true;
    contact.down = down;
    contact.changed_s = -1;
    return;
  }
  if (contact.changed_s < 0) contact.changed_s = time_s;
  if (time_s - contact.changed_s < kChatterS) return;
  if (contact.since_s >= 0) {
    (contact.down ? stance_s_ : flight_s_).Add(contact.changed_s - contact.since_s);
  }
  contact = {.known = true, .down = down, .since_s = contact.changed_s};
}

void GaitMeter::AddStride(const engine::EngineOutput& output) {
  if (output.gait.steps == steps_) return;
  const bool both = task_.gait == stream::Gait::kJump;
  const double now_m = output.gait.distance_m;
  if (step_m_ >= 0) stride_m_.Add((now_m - step_m_) * (both ? 1 : 2));
  step_m_ = steps_ == 0 ? -1 : now_m;
  steps_ = output.gait.steps;
}

void GaitMeter::Add(const engine::EngineOutput& output, double step_s) {
  if (time_s_ == 0) mean_speed_mps_ = task_.speed_mps;
  time_s_ += step_s;
  mean_speed_mps_ += step_s / kWindowS * (output.gait.speed_mps - mean_speed_mps_);
  const double error_mps = mean_speed_mps_ - task_.speed_mps;
  squared_error_.Add(error_mps * error_mps);
  const Eigen::Vector3d ahead = output.links[0].orientation * Eigen::Vector3d::UnitX();
  const double heading_error_rad =
      WrapAngle(std::atan2(ahead.y(), ahead.x()) - output.gait.heading_rad);
  squared_heading_error_.Add(heading_error_rad * heading_error_rad);
  const bool left = output.contacts[0].touching, right = output.contacts[1].touching;
  if (task_.gait == stream::Gait::kRun || task_.gait == stream::Gait::kJump) {
    Watch(contacts_[0], left || right, time_s_);
  } else {
    Watch(contacts_[0], left, time_s_);
    Watch(contacts_[1], right, time_s_);
  }
  AddStride(output);
  leg_gap_m_ = std::min(leg_gap_m_, legs::LegGap(output));
}

void GaitMeter::Report(TrialResult& result) const {
  result.speed_error_mps = std::sqrt(squared_error_.value());
  result.heading_error_rad = std::sqrt(squared_heading_error_.value());
  result.flight_s = flight_s_.value();
  result.stance_s = stance_s_.value();
  result.stride_m = stride_m_.value();
  result.leg_gap_m = leg_gap_m_;
}

}  // namespace footing::tune

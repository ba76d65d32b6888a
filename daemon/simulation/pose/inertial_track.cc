#include "daemon/simulation/pose/inertial_track.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "common/base/rotation.h"
#include "common/base/units.h"
#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::inertial {
namespace {

constexpr double kLatestS = 0.15;  // Delay of an observation behind readings of its time.
constexpr double kOtherClockS = 1;
constexpr double kGravityS = 0.5;     // Least duration of the mean that shows what is up.
constexpr double kGravityLastsS = 2;  // Later readings replace the earlier ones.
constexpr double kLeastForceMps2 = 1;
constexpr double kTiltSdRad = 0.03, kMostTiltSdRad = 0.4;  // Device at rest; any device.
// Chi squared of three degrees of freedom: one in 1000 if both are right.
constexpr double kContradiction = 16.3;
constexpr int kMostContradictions = 5;  // One after the other: no accident.
// A hand from one frame to the next; after a pause it may be anywhere.
constexpr double kFastestHandMps = 6, kStepM = 0.03, kPauseS = 0.06;
constexpr double kWaitsS = 1, kRestSpreadMps2 = 0.5;  // For a motion that shows the heading.

}  // namespace

Track::Track(const Eigen::Vector3d& p_SP_m) : p_SP_m_(p_SP_m), base_{Filter(p_SP_m), {}} {}

void Track::Restart() {
  const Track fresh(p_SP_m_);
  const std::size_t taken = taken_, refused = refused_;
  *this = fresh;
  taken_ = taken;
  refused_ = refused;
}

void Track::Point::AdvanceTo(const Timed& next) {
  const double step_s = next.time_s - last.time_s;
  if (step_s > 0)
    filter.Advance(last.reading, next.reading, step_s,
                   last.reading.clipped || next.reading.clipped ? Filter::Trust::kClipped
                                                                : Filter::Trust::kMeasured);
  last = next;
}

arms::HandReading Track::Between(const Timed& a, const Timed& b, double time_s) {
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  arms::HandReading reading;
  reading.specific_force_S_mps2 =
      (1 - share) * a.reading.specific_force_S_mps2 + share * b.reading.specific_force_S_mps2;
  reading.angular_velocity_S_radps =
      (1 - share) * a.reading.angular_velocity_S_radps + share * b.reading.angular_velocity_S_radps;
  reading.clipped = a.reading.clipped || b.reading.clipped;
  return reading;
}

void Track::AdvanceThrough(const std::vector<Timed>& readings, double time_s, Point& point) {
  for (const Timed& next : readings) {
    if (next.time_s <= point.last.time_s) continue;
    if (next.time_s > time_s) {
      if (time_s > point.last.time_s) point.AdvanceTo({time_s, Between(point.last, next, time_s)});
      return;
    }
    point.AdvanceTo(next);
  }
}

void Track::DropBefore(double time_s) {
  const auto later = std::find_if(readings_.begin(), readings_.end(),
                                  [&](const Timed& one) { return one.time_s > time_s; });
  readings_.erase(readings_.begin(), later);
}

void Track::FeelGravity(const arms::HandReading& reading, double step_s) {
  if (!(step_s > 0) || step_s > kGapS) return;
  const double kept = std::max(0.0, 1 - step_s / kGravityLastsS);
  R_GS_ = R_GS_ * arms::Turned(reading.angular_velocity_S_radps * step_s);
  force_sum_ = kept * force_sum_ + step_s * (R_GS_ * reading.specific_force_S_mps2);
  square_sum_ = kept * square_sum_ + step_s * reading.specific_force_S_mps2.squaredNorm();
  felt_s_ = kept * felt_s_ + step_s;
}

void Track::Feel(double time_s, const arms::HandReading& reading) {
  if (!reading.specific_force_S_mps2.allFinite() || !reading.angular_velocity_S_radps.allFinite())
    return;
  const double newest_s = readings_.empty() ? base_.last.time_s : readings_.back().time_s;
  const bool first = readings_.empty() && base_.last.time_s == 0;
  if (!first && (time_s < newest_s - kOtherClockS || time_s > newest_s + kGapS))
    Restart();
  else if (!first && time_s <= newest_s)
    return;
  FeelGravity(reading, time_s - newest_s);
  readings_.push_back({time_s, reading});
  std::vector<Waiting> waiting;
  waiting.swap(waiting_);
  for (const Waiting& one : waiting) See(one.time_s, one.seen);
  if (!started_) return DropBefore(time_s - kLatestS);
  if (base_.last.time_s >= time_s - kLatestS) return;
  AdvanceThrough(readings_, time_s - kLatestS, base_);
  DropBefore(base_.last.time_s - kLatestS);
}

void Track::See(double time_s, const Filter::Observation& seen) {
  if (readings_.empty() && !started_) return;
  const double newest_s = readings_.empty() ? base_.last.time_s : readings_.back().time_s;
  if (time_s > newest_s + kGapS || time_s < newest_s - kLatestS) return;
  if (time_s > newest_s) {
    waiting_.push_back({time_s, seen});
    return;
  }
  Apply({time_s, seen});
}

double Track::SpreadMps2() const {
  const Eigen::Vector3d mean = force_sum_ / felt_s_;
  return std::sqrt(std::max(0.0, square_sum_ / felt_s_ - mean.squaredNorm()));
}

bool Track::Start(const Waiting& one) {
  if (felt_s_ < kGravityS || readings_.empty() || one.time_s < readings_.front().time_s)
    return false;
  const Eigen::Vector3d mean = force_sum_ / felt_s_;
  if (mean.norm() < kLeastForceMps2) return false;
  // R_GS_ is of the newest reading; back to the observation's time.
  Eigen::Matrix3d R_GS = R_GS_;
  for (std::size_t i = readings_.size() - 1; i > 0 && readings_[i].time_s > one.time_s; --i) {
    const double step_s = readings_[i].time_s - std::max(one.time_s, readings_[i - 1].time_s);
    R_GS = R_GS * arms::Turned(-readings_[i].reading.angular_velocity_S_radps * step_s);
  }
  R_GS = LeastTurn(mean, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R_GS;
  const double tilt_sd_rad =
      std::min(kMostTiltSdRad, kTiltSdRad + 0.5 * SpreadMps2() / kStandardGravityMps2);
  base_.filter.Start(one.seen, R_GS, tilt_sd_rad);
  base_.last = readings_.front();
  for (std::size_t i = 1; i < readings_.size() && readings_[i - 1].time_s <= one.time_s; ++i)
    base_.last = {one.time_s, Between(readings_[i - 1], readings_[i], one.time_s)};
  base_.last.time_s = one.time_s;
  return true;
}

/// As a hand does from frame to frame. After a pause nobody can say.
bool Track::FollowsTheLast(const Waiting& one) const {
  const double step_s = one.time_s - last_seen_.time_s;
  return step_s < kPauseS &&
         (one.seen.p_W_m - last_seen_.seen.p_W_m).norm() < kStepM + kFastestHandMps * step_s;
}

/// The filter is wrong, not the camera: the observations move like a hand and contradict it.
bool Track::IsLost() {
  return !base_.filter.IsPlausible() || (!jumped_ && contradictions_ >= kMostContradictions);
}

void Track::Apply(const Waiting& one) {
  jumped_ = jumped_ || !FollowsTheLast(one);
  last_seen_ = one;
  bool starts = !started_;
  if (started_) {
    if (one.time_s < base_.last.time_s) return;
    AdvanceThrough(readings_, one.time_s, base_);
    DropBefore(base_.last.time_s - kLatestS);
    // At rest the newest mean force shows best what is up; which way is ahead is not known yet.
    starts = !base_.filter.KnowsHeading() && one.time_s - started_s_ > kWaitsS &&
             SpreadMps2() < kRestSpreadMps2;
    if (!starts && base_.filter.Distance(one.seen) > kContradiction) {
      ++contradictions_;
      ++refused_;
      starts = IsLost() || one.time_s - taken_s_ > kBridgedS;
      if (!starts) return;
    }
  }
  if (starts) {
    started_ = Start(one);
    if (!started_) return;
    started_s_ = one.time_s;
  } else {
    base_.filter.Update(one.seen);
  }
  ++taken_;
  taken_s_ = one.time_s;
  contradictions_ = 0;
  jumped_ = false;
}

Track::State Track::At(double time_s) const {
  State state;
  const double newest_s = readings_.empty() ? base_.last.time_s : readings_.back().time_s;
  if (!started_ || !base_.filter.KnowsHeading() || time_s - taken_s_ > kBridgedS ||
      time_s - newest_s > kGapS)
    return state;
  Point now = base_;
  AdvanceThrough(readings_, time_s, now);
  if (time_s > now.last.time_s)
    now.filter.Advance(now.last.reading, now.last.reading, time_s - now.last.time_s,
                       Filter::Trust::kHeld);
  state.valid = true;
  state.p_W_m = now.filter.p_W_m();
  state.v_W_mps = now.filter.v_W_mps();
  state.covariance = now.filter.covariance().topLeftCorner<6, 6>();
  return state;
}

}  // namespace footing::inertial

#include "common/board/geometry.h"

#include <algorithm>
#include <cmath>

namespace footing::board {

bool IsSound(const stream::BoardGeometry& geometry) {
  // False for what is not a number, too.
  const auto within = [](double length_m) {
    return length_m >= kLeastLengthM && length_m <= kMostLengthM;
  };
  return within(geometry.plate_x_m) && within(geometry.plate_y_m) &&
         within(geometry.sensor_distance_x_m) && within(geometry.sensor_distance_y_m);
}

stream::BoardGeometry GeometryOr(const std::optional<stream::BoardGeometry>& published) {
  return published && IsSound(*published) ? *published : kBalanceBoard;
}

Eigen::Vector2d InWorld(const stream::BoardPose& pose, double right_m, double front_m) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  return {pose.x_m + right_m * s + front_m * c, pose.y_m - right_m * c + front_m * s};
}

std::array<Eigen::Vector2d, kCorners> SensorPlaces(const stream::BoardPose& pose,
                                                   const stream::BoardGeometry& geometry) {
  std::array<Eigen::Vector2d, kCorners> places;
  for (std::size_t i = 0; i < kCorners; ++i) {
    places[i] = InWorld(pose, 0.5 * kCornerRight[i] * geometry.sensor_distance_x_m,
                        0.5 * kCornerFront[i] * geometry.sensor_distance_y_m);
  }
  return places;
}

CornerForces operator-(const CornerForces& a, const CornerForces& b) {
  return {a.top_left_n - b.top_left_n, a.top_right_n - b.top_right_n,
          a.bottom_left_n - b.bottom_left_n, a.bottom_right_n - b.bottom_right_n};
}

double Total(const CornerForces& forces) {
  return forces.top_left_n + forces.top_right_n + forces.bottom_left_n + forces.bottom_right_n;
}

PlatePoint CentreOfPressure(const CornerForces& forces, double total_n,
                            const stream::BoardGeometry& geometry) {
  const double left = forces.top_left_n + forces.bottom_left_n;
  const double right = forces.top_right_n + forces.bottom_right_n;
  const double front = forces.top_left_n + forces.top_right_n;
  const double rear = forces.bottom_left_n + forces.bottom_right_n;
  return {geometry.sensor_distance_x_m / 2 * (right - left) / total_n,
          geometry.sensor_distance_y_m / 2 * (front - rear) / total_n};
}

PlateReading Plate::Advance(const CornerForces& forces) {
  PlateReading reading;
  reading.repeated = started_ && forces == last_;
  started_ = true;
  last_ = forces;

  const double left = forces.top_left_n + forces.bottom_left_n;
  const double right = forces.top_right_n + forces.bottom_right_n;
  reading.total_n = left + right;
  contact_ = reading.total_n > (contact_ ? config_.contact_off_n : config_.contact_on_n);
  reading.contact = contact_;
  reading.cop_valid = reading.total_n > config_.contact_off_n;
  if (reading.cop_valid) {
    const PlatePoint cop = CentreOfPressure(forces, reading.total_n, config_.geometry);
    reading.cop_x_m = cop.x_m;
    reading.cop_y_m = cop.y_m;
  }
  return reading;
}

namespace {

constexpr std::size_t kLeastPoints = 3;
constexpr double kCatchUpS = 0.5;      // The delay comes back to its nominal value in this time,
constexpr double kMostCatchUp = 0.05;  // by at most such a part of the time that passes.
constexpr double kMostAstrayS = 0.1;   // Further off, it starts again.

}  // namespace

void ImpulseMeter::Add(double sampled_s, const Corners& load_n) {
  const double passed_s = sampled_s - impulse_.sampled_s;
  const bool goes_on = impulse_.valid && std::abs(passed_s) <= kMostGapS;
  if (goes_on && passed_s <= 0) return;
  if (goes_on) {
    for (std::size_t i = 0; i < kCorners; ++i) {
      impulse_.impulse_ns[i] += 0.5 * passed_s * (load_n[i] + load_n_[i]);
    }
  }
  impulse_.valid = sampled_s > 0;
  impulse_.sampled_s = sampled_s;
  load_n_ = load_n;
}

Corners LoadPlayer::Track::At(double time_s) const {
  std::size_t back = 0;
  while (back + 2 < size() && time_s < Newest(back + 1).sampled_s) ++back;
  const Point& after = Newest(back);
  const Point& before = Newest(back + 1);
  const double share = (time_s - before.sampled_s) / (after.sampled_s - before.sampled_s);
  Corners impulse_ns{};
  for (std::size_t i = 0; i < kCorners; ++i) {
    impulse_ns[i] = before.impulse_ns[i] + share * (after.impulse_ns[i] - before.impulse_ns[i]);
  }
  return impulse_ns;
}

void LoadPlayer::Take(std::size_t board, const BoardImpulse& impulse) {
  Track& track = tracks_[board];
  const double passed_s = track.count > 0 ? impulse.sampled_s - track.Newest(0).sampled_s : 0;
  if (impulse.valid && track.count > 0 && passed_s == 0) return;
  if (!impulse.valid || passed_s < 0 || passed_s > ImpulseMeter::kMostGapS) {
    track.count = 0;
    playing_ = false;
  }
  if (!impulse.valid) return;
  track.points[track.count % Track::kPoints] = {impulse.sampled_s, impulse.impulse_ns};
  ++track.count;
}

std::optional<std::array<Corners, LoadPlayer::kBoards>> LoadPlayer::Advance(double step_s) {
  if (tracks_[0].count < kLeastPoints || tracks_[1].count < kLeastPoints) {
    playing_ = false;
    return std::nullopt;
  }
  const double due_s =
      std::min(tracks_[0].Newest(0).sampled_s, tracks_[1].Newest(0).sampled_s) - kDelayS;
  if (playing_ && std::abs(due_s - time_s_) > kMostAstrayS) playing_ = false;
  if (!playing_) {
    playing_ = true;
    time_s_ = due_s;
    for (Track& track : tracks_) track.played_ns = track.At(time_s_);
    return std::nullopt;
  }
  const double behind = (due_s - time_s_) / kCatchUpS;
  const double passed_s = step_s * (1 + std::clamp(behind, -kMostCatchUp, kMostCatchUp));
  time_s_ += passed_s;
  std::array<Corners, kBoards> loads_n{};
  for (std::size_t f = 0; f < kBoards; ++f) {
    const Corners now_ns = tracks_[f].At(time_s_);
    for (std::size_t i = 0; i < kCorners; ++i) {
      loads_n[f][i] = (now_ns[i] - tracks_[f].played_ns[i]) / passed_s;
    }
    tracks_[f].played_ns = now_ns;
  }
  return loads_n;
}

}  // namespace footing::board

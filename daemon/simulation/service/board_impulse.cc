#include "daemon/simulation/service/board_impulse.h"

#include <algorithm>
#include <cmath>

namespace footing::simulation {
namespace {

constexpr std::size_t kLeastPoints = 3;
constexpr double kCatchUpS = 0.5;      // The delay comes back to what it should be in this time,
constexpr double kMostCatchUp = 0.05;  // by at most such a part of the time that passes.
constexpr double kMostAstrayS = 0.1;   // Further off, it begins anew.

}  // namespace

void ImpulseMeter::Add(double sampled_s, const std::array<double, kBoardCells>& load_n) {
  const double passed_s = sampled_s - impulse_.sampled_s;
  const bool goes_on = impulse_.valid && std::abs(passed_s) <= kMostGapS;
  if (goes_on && passed_s <= 0) return;
  if (goes_on) {
    for (std::size_t i = 0; i < kBoardCells; ++i) {
      impulse_.impulse_ns[i] += 0.5 * passed_s * (load_n[i] + load_n_[i]);
    }
  }
  impulse_.valid = sampled_s > 0;
  impulse_.sampled_s = sampled_s;
  load_n_ = load_n;
}

LoadPlayer::Cells LoadPlayer::Track::At(double time_s) const {
  std::size_t back = 0;
  while (back + 2 < size() && time_s < Newest(back + 1).sampled_s) ++back;
  const Point& after = Newest(back);
  const Point& before = Newest(back + 1);
  const double share = (time_s - before.sampled_s) / (after.sampled_s - before.sampled_s);
  Cells impulse_ns{};
  for (std::size_t i = 0; i < kBoardCells; ++i) {
    impulse_ns[i] = before.impulse_ns[i] + share * (after.impulse_ns[i] - before.impulse_ns[i]);
  }
  return impulse_ns;
}

void LoadPlayer::Take(std::size_t foot, const BoardImpulse& impulse) {
  Track& track = tracks_[foot];
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

bool LoadPlayer::Advance(double step_s, std::array<momentum::FootLoads, momentum::kFeet>& feet) {
  for (std::size_t f = 0; f < tracks_.size(); ++f) {
    if (tracks_[f].count >= kLeastPoints && feet[f].count == kBoardCells) continue;
    playing_ = false;
    return false;
  }
  const double due_s =
      std::min(tracks_[0].Newest(0).sampled_s, tracks_[1].Newest(0).sampled_s) - kDelayS;
  if (playing_ && std::abs(due_s - time_s_) > kMostAstrayS) playing_ = false;
  if (!playing_) {
    playing_ = true;
    time_s_ = due_s;
    for (Track& track : tracks_) track.told_ns = track.At(time_s_);
    return false;
  }
  const double behind = (due_s - time_s_) / kCatchUpS;
  const double passed_s = step_s * (1 + std::clamp(behind, -kMostCatchUp, kMostCatchUp));
  time_s_ += passed_s;
  for (std::size_t f = 0; f < tracks_.size(); ++f) {
    const Cells now_ns = tracks_[f].At(time_s_);
    for (std::size_t i = 0; i < kBoardCells; ++i) {
      feet[f].cells[i].load_n = (now_ns[i] - tracks_[f].told_ns[i]) / passed_s;
    }
    tracks_[f].told_ns = now_ns;
  }
  return true;
}

}  // namespace footing::simulation

#include "clients/ctl/guide/pick.h"

#include <algorithm>
#include <cmath>

namespace footing::guide {
namespace {

constexpr double kMostLead = 99;

std::string Rounded(double value) { return std::to_string(std::lround(value)); }

}  // namespace

Pick WhichBoard(const std::vector<BoardLoad>& boards) {
  Pick pick;
  double most_n = 0;
  double next_n = 0;
  for (const BoardLoad& board : boards) {
    if (board.load.samples == 0) continue;
    const double force_n = board.load.mean_n;
    if (force_n > most_n) {
      next_n = most_n;
      most_n = force_n;
      pick.device = board.device;
    } else {
      next_n = std::max(next_n, force_n);
    }
  }
  if (most_n < kStoodOnN) return {Pick::Kind::kNone, 0, 0, "no board is stood on"};
  if (next_n > kFreeN) {
    return {Pick::Kind::kAmbiguous, 0, most_n / next_n,
            "two boards carry load (" + Rounded(most_n) + " N and " + Rounded(next_n) +
                " N): stand on one alone"};
  }
  pick.kind = Pick::Kind::kOne;
  pick.lead = std::min(kMostLead, most_n / std::max(next_n, 1.0));
  pick.note = "carries " + Rounded(most_n) + " N";
  return pick;
}

Pick WhichShaken(const std::vector<DeviceMotion>& devices) {
  Pick pick;
  double most = 0;
  double next = 0;
  for (const DeviceMotion& device : devices) {
    if (device.motion.samples == 0) continue;
    const double shake = device.motion.shake_mps2;
    if (shake > most) {
      next = most;
      most = shake;
      pick.device = device.device;
    } else {
      next = std::max(next, shake);
    }
  }
  if (most < kShakenMps2) return {Pick::Kind::kNone, 0, 0, "nothing is shaken"};
  if (most < kClearlyMore * next) {
    return {Pick::Kind::kAmbiguous, 0, most / next,
            "two devices move (" + Rounded(most) + " and " + Rounded(next) +
                " m/s2): hold the others still"};
  }
  pick.kind = Pick::Kind::kOne;
  pick.lead = std::min(kMostLead, most / std::max(next, 0.1));
  pick.note = "moves by " + Rounded(most) + " m/s2";
  return pick;
}

}  // namespace footing::guide

#include "common/guide/pick.h"

#include <algorithm>
#include <cmath>

namespace footing::guide {
namespace {

constexpr double kMostLead = 99;

std::string Rounded(double value) { return std::to_string(std::lround(value)); }

/// The strongest of several signals, and the next one.
struct Strongest {
  std::uint32_t device = 0;
  double most = 0;
  double next = 0;

  void Add(std::uint32_t of_device, double signal) {
    if (signal > most) {
      next = most;
      most = signal;
      device = of_device;
    } else {
      next = std::max(next, signal);
    }
  }
  Pick One(double least_next, const std::string& note) const {
    return {Pick::Kind::kOne, device, std::min(kMostLead, most / std::max(next, least_next)), note};
  }
  Pick Ambiguous(const std::string& note) const {
    return {Pick::Kind::kAmbiguous, 0, most / next, note};
  }
};

}  // namespace

Pick WhichBoard(const std::vector<BoardLoad>& boards) {
  Strongest force_n;
  for (const BoardLoad& board : boards) {
    if (board.load.samples > 0) force_n.Add(board.device, board.load.mean_n);
  }
  if (force_n.most < kStoodOnN) return {Pick::Kind::kNone, 0, 0, "nobody stands on a board"};
  if (force_n.next > kFreeN) {
    return force_n.Ambiguous("two boards carry load (" + Rounded(force_n.most) + " N and " +
                             Rounded(force_n.next) + " N): stand on one alone");
  }
  return force_n.One(1.0, "carries " + Rounded(force_n.most) + " N");
}

Pick WhichShaken(const std::vector<DeviceMotion>& devices) {
  Strongest shake_mps2;
  for (const DeviceMotion& device : devices) {
    if (device.motion.samples > 0) shake_mps2.Add(device.device, device.motion.shake_mps2);
  }
  if (shake_mps2.most < kShakenMps2) return {Pick::Kind::kNone, 0, 0, "no device is shaken"};
  if (shake_mps2.most < kClearlyMore * shake_mps2.next) {
    return shake_mps2.Ambiguous("two devices move (" + Rounded(shake_mps2.most) + " and " +
                                Rounded(shake_mps2.next) + " m/s2): hold the others still");
  }
  return shake_mps2.One(0.1, "moves by " + Rounded(shake_mps2.most) + " m/s2");
}

}  // namespace footing::guide

#include "common/guide/recent.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/guide/device_steps.h"

namespace footing::guide {
namespace {

constexpr std::int64_t kKeptNs = 30'000'000'000;
// Taken from the front in one go, so that forgetting costs nothing a sample.
constexpr std::size_t kForgetAtOnce = 1024;

template <typename Sample>
void Keep(std::vector<Sample>& kept, const Sample& sample) {
  kept.push_back(sample);
  if (kept.size() % kForgetAtOnce != 0) return;
  const auto old = std::find_if(kept.begin(), kept.end(), [&](const Sample& one) {
    return sample.received_ns - one.received_ns <= kKeptNs;
  });
  kept.erase(kept.begin(), old);
}

template <typename Sample>
std::vector<Sample> Between(const std::map<std::uint32_t, std::vector<Sample>>& all,
                            std::uint32_t device, std::int64_t from_ns, std::int64_t to_ns) {
  const auto found = all.find(device);
  if (found == all.end()) return {};
  const auto earlier = [](const Sample& sample, std::int64_t time_ns) {
    return sample.received_ns < time_ns;
  };
  const auto& kept = found->second;
  const std::vector<Sample> cut(std::lower_bound(kept.begin(), kept.end(), from_ns, earlier),
                                std::lower_bound(kept.begin(), kept.end(), to_ns, earlier));
  const std::int64_t slack_ns = std::max<std::int64_t>((to_ns - from_ns) / 10, 100'000'000);
  if (cut.empty() || cut.front().received_ns - from_ns > slack_ns ||
      to_ns - cut.back().received_ns > slack_ns) {
    return {};
  }
  return cut;
}

std::vector<stream::DeviceStatus> Attached(const std::vector<stream::DeviceStatus>& devices,
                                           const std::string& rig, bool boards) {
  std::vector<stream::DeviceStatus> list;
  for (const stream::DeviceStatus& device : devices) {
    if (device.state == stream::DeviceState::kLost || device.rig != rig) continue;
    if ((device.kind == stream::DeviceKind::kBalanceBoard) == boards) list.push_back(device);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.role < b.role; });
  return list;
}

}  // namespace

Load LoadOf(const std::vector<stream::BoardSample>& samples) {
  Load load;
  load.samples = static_cast<int>(samples.size());
  if (samples.empty()) return load;
  double sum = 0;
  double sum_x = 0;
  double sum_y = 0;
  int valid = 0;
  for (const auto& sample : samples) {
    sum += sample.total_n;
    if (!sample.cop_valid) continue;
    ++valid;
    sum_x += sample.cop_x_m;
    sum_y += sample.cop_y_m;
  }
  load.mean_n = sum / load.samples;
  load.cop_valid = valid == load.samples;
  if (valid > 0) {
    load.cop_x_m = sum_x / valid;
    load.cop_y_m = sum_y / valid;
  }
  double square = 0;
  double square_m2 = 0;
  for (const auto& sample : samples) {
    square += (sample.total_n - load.mean_n) * (sample.total_n - load.mean_n);
    if (!sample.cop_valid) continue;
    const double dx_m = sample.cop_x_m - load.cop_x_m;
    const double dy_m = sample.cop_y_m - load.cop_y_m;
    square_m2 += dx_m * dx_m + dy_m * dy_m;
  }
  load.sd_n = std::sqrt(square / load.samples);
  if (valid > 0) load.cop_sd_m = std::sqrt(square_m2 / valid);
  return load;
}

Motion MotionOf(const std::vector<stream::MotionSample>& samples) {
  Motion motion;
  motion.samples = static_cast<int>(samples.size());
  if (samples.empty()) return motion;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& sample : samples) {
    mean += sample.specific_force_mps2;
    motion.mean_mps2 += sample.specific_force_mps2.norm();
  }
  mean /= motion.samples;
  motion.mean_mps2 /= motion.samples;
  double square = 0;
  for (const auto& sample : samples) square += (sample.specific_force_mps2 - mean).squaredNorm();
  motion.shake_mps2 = std::sqrt(square / motion.samples);
  return motion;
}

void Recent::Add(const stream::MotionSample& sample) { Keep(motion_[sample.device], sample); }
void Recent::Add(const stream::BoardSample& sample) { Keep(boards_[sample.device], sample); }

void Recent::Add(const stream::HandSample& sample) { Keep(hands_, sample); }

void Recent::Take(const rig::Tick& tick) {
  if (tick.devices) SetDevices(*tick.devices);
  for (const stream::MotionSample& sample : tick.motion) Add(sample);
  for (const stream::BoardSample& sample : tick.boards) Add(sample);
  for (const stream::HandSample& sample : tick.hands) Add(sample);
}

std::vector<stream::DeviceStatus> Recent::Boards(const std::string& rig) const {
  return Attached(devices_, rig, true);
}

std::vector<stream::DeviceStatus> Recent::BodyDevices(const std::string& rig) const {
  return Attached(devices_, rig, false);
}

std::optional<stream::DeviceStatus> Recent::Holding(const std::string& rig,
                                                    stream::DeviceRole role) const {
  for (const stream::DeviceStatus& device : devices_) {
    if (device.state != stream::DeviceState::kLost && device.rig == rig && device.role == role) {
      return device;
    }
  }
  return std::nullopt;
}

Load Recent::BoardLoad(std::uint32_t device, std::int64_t from_ns, std::int64_t to_ns) const {
  return LoadOf(Between(boards_, device, from_ns, to_ns));
}

Motion Recent::DeviceMotion(std::uint32_t device, std::int64_t from_ns, std::int64_t to_ns) const {
  return MotionOf(Between(motion_, device, from_ns, to_ns));
}

std::optional<Eigen::Vector3d> Recent::MeanForce(std::uint32_t device, std::int64_t from_ns,
                                                 std::int64_t to_ns) const {
  const auto samples = Between(motion_, device, from_ns, to_ns);
  if (samples.empty()) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& sample : samples) sum += sample.specific_force_mps2;
  return sum / static_cast<double>(samples.size());
}

std::vector<stream::HandSample> Recent::Hands(const std::string& rig, stream::DeviceRole role,
                                              std::int64_t from_ns, std::int64_t to_ns) const {
  std::vector<stream::HandSample> samples;
  for (const stream::HandSample& sample : hands_) {
    const bool is_within = sample.received_ns >= from_ns && sample.received_ns < to_ns;
    if (is_within && sample.rig == rig && sample.role == role) samples.push_back(sample);
  }
  return samples;
}

namespace {

constexpr const char* kOneFootEach = R"(
          == screen ==
        .------. .------.     long sides along the walk,
        |      | |      |     power buttons [] outwards
       [| left | | right|]
        |      | |      |
        '------' '------'
)";

constexpr const char* kSideBySide = R"(
               == screen ==
        .----------. .----------.     long sides across the walk,
        |   left   | |   right  |     power buttons [] towards you
        '----[]----' '----[]----'
)";

constexpr const char* kSingle = R"(
        == screen ==
        .----------.     both feet on it,
        |          |     power button [] towards you
        '----[]----'
)";

/// Movement of a board's COP in W between two stances; nothing when it was not stood on.
std::optional<Eigen::Vector2d> Moved(const stream::BoardPose& pose, const Load& from,
                                     const Load& to) {
  if (!from.cop_valid || !to.cop_valid) return std::nullopt;
  stream::BoardPose turned;  // A difference: the place drops out.
  turned.yaw_rad = pose.yaw_rad;
  return board::InWorld(turned, to.cop_x_m - from.cop_x_m, to.cop_y_m - from.cop_y_m);
}

/// Stood the wrong way: the other board had the load that this one should have had.
bool Swapped(const LayoutObserved& observed) {
  if (!observed.left_alone || !observed.right_alone) return false;
  return observed.left_alone->right.mean_n > observed.left_alone->left.mean_n &&
         observed.right_alone->left.mean_n > observed.right_alone->right.mean_n;
}

std::string Text(double value) { return std::to_string(std::lround(value)); }

std::string Turn(const Eigen::Vector2d& moved) {
  const bool about = moved.x() < 0 && std::abs(moved.x()) >= std::abs(moved.y());
  return about ? "by half a turn" : "by a quarter turn";
}

LayoutVerdict NoContact(const std::string& note) {
  LayoutVerdict verdict;
  verdict.fault = LayoutFault::kNoContact;
  verdict.note = note;
  return verdict;
}

}  // namespace

std::string LayoutPicture(const std::string& preset) {
  if (preset == "one_foot_each") return kOneFootEach;
  if (preset == "side_by_side") return kSideBySide;
  return preset == "single" ? kSingle : "";
}

LayoutVerdict CheckLayout(const stream::BoardLayout& layout, const LayoutObserved& observed) {
  LayoutVerdict verdict;
  verdict.degraded = observed.forward.left.samples == 0 || observed.forward.right.samples == 0;
  if (observed.left_alone && observed.right_alone) {
    const Stance& left = *observed.left_alone;
    const Stance& right = *observed.right_alone;
    verdict.rest_n = std::max(std::min(left.left.mean_n, left.right.mean_n),
                              std::min(right.left.mean_n, right.right.mean_n));
    if (Swapped(observed)) {
      verdict.fault = LayoutFault::kSwapped;
      verdict.note =
          "the boards are swapped: standing left loads the right one; exchange them, or do the "
          "roles again: footing-ctl setup --only roles";
      return verdict;
    }
    if (left.left.mean_n < kStoodOnN || right.right.mean_n < kStoodOnN) {
      return NoContact("a board had no load on it: stand on it alone, then on the other");
    }
  }
  const auto left = Moved(layout.left, observed.upright.left, observed.forward.left);
  const auto right = Moved(layout.right, observed.upright.right, observed.forward.right);
  if ((!left && !right) || (!verdict.degraded && (!left || !right))) {
    return NoContact("a board had no centre of pressure while leaning: stand on all boards");
  }
  const auto wrong = [](const std::optional<Eigen::Vector2d>& moved) {
    return moved && moved->x() < std::max(kLeastLeanM, std::abs(moved->y()));
  };
  for (const auto& moved : {left, right}) {
    if (moved && std::hypot(moved->x(), moved->y()) < kLeastLeanM) {
      return NoContact("the centre of pressure moved by less than " + Text(kLeastLeanM * 1e3) +
                       " mm: lean further forward, heels down");
    }
    if (moved) verdict.residual_mm = std::max(verdict.residual_mm, std::abs(moved->y()) * 1e3);
  }
  if (wrong(left) && wrong(right)) {
    verdict.fault = LayoutFault::kBothTurned;
    verdict.note = "both boards are turned " + Turn(*left) + ": check the power buttons' side";
  } else if (wrong(left)) {
    verdict.fault = LayoutFault::kLeftTurned;
    verdict.note = "the left board is turned " + Turn(*left) + ": check its power button's side";
  } else if (wrong(right)) {
    verdict.fault = LayoutFault::kRightTurned;
    verdict.note = "the right board is turned " + Turn(*right) + ": check its power button's side";
  } else {
    verdict.note = "sideways while leaning forward " + Text(verdict.residual_mm) +
                   " mm, on the free board " + Text(verdict.rest_n) + " N";
    if (verdict.degraded) verdict.note += "; one board alone: weight beside it is not seen";
  }
  return verdict;
}

}  // namespace footing::guide

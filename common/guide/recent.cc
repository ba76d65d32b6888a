#include "common/guide/recent.h"

#include <algorithm>
#include <cmath>

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

}  // namespace footing::guide

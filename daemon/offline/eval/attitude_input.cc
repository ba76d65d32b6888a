#include "daemon/offline/eval/attitude_input.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/number.h"
#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "daemon/offline/eval/table.h"

namespace footing::eval {
namespace {

constexpr double kWiimoteRateHz = 95;

/// The numbers of one row; nothing where a cell is empty.
std::optional<Eigen::Vector3d> ToVector(const std::vector<std::string>& cells, std::size_t first) {
  Eigen::Vector3d v;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = text::ToNumber(cells[first + i]);
    if (!number) return std::nullopt;
    v[static_cast<Eigen::Index>(i)] = *number;
  }
  return v;
}

Result<ImuSample> ToSample(const std::vector<std::string>& cells, bool has_truth, bool has_moving) {
  ImuSample sample;
  const auto turn = ToVector(cells, 0), force = ToVector(cells, 3);
  if (!turn || !force) return InvalidData("a reading is not a number");
  sample.reading = {.specific_force_S_mps2 = *force, .angular_velocity_S_radps = *turn};
  if (has_truth && !cells[6].empty()) {
    const auto w = text::ToNumber(cells[6]);
    const auto v = ToVector(cells, 7);
    const auto q =
        w && v ? Eigen::Quaterniond(*w, v->x(), v->y(), v->z()) : Eigen::Quaterniond(0, 0, 0, 0);
    if (std::abs(q.norm() - 1) > 0.01) return InvalidData("the quaternion does not have length 1");
    sample.truth = q.normalized();
  }
  if (has_moving) sample.scored = cells.back() == "1";
  return sample;
}

}  // namespace

Result<std::vector<ImuSample>> ReadImu(const std::string& path) {
  std::vector<std::string> columns{"gx", "gy", "gz", "ax", "ay", "az"};
  const auto header = ReadHeader(path);
  const auto has = [&header](const char* name) {
    return std::find(header.begin(), header.end(), name) != header.end();
  };
  const bool has_truth = has("qw"), has_moving = has("moving");
  if (has_truth) columns.insert(columns.end(), {"qw", "qx", "qy", "qz"});
  if (has_moving) columns.emplace_back("moving");
  const auto rows = ReadNamedColumns(path, columns);
  if (!rows) return rows.error();
  std::vector<ImuSample> samples;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const auto sample = ToSample((*rows)[i], has_truth, has_moving);
    if (!sample) {
      return InvalidData(path + ": row " + std::to_string(i + 1) + ": " + sample.error().message);
    }
    samples.push_back(*sample);
  }
  if (samples.size() < 2) return InvalidData(path + ": has fewer than two samples");
  return samples;
}

std::vector<ImuSample> AsWiimote(const std::vector<ImuSample>& samples, std::uint64_t seed,
                                 double& rate_hz) {
  const auto every = std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz / kWiimoteRateHz));
  rate_hz /= static_cast<double>(every);
  const double slow = DegreesToRadians(595.0 / 8192), fast = 4.5 * slow;
  const double slow_range = DegreesToRadians(430);
  const double count_mps2 = kStandardGravityMps2 / 104, range_mps2 = 3.6 * kStandardGravityMps2;
  const Eigen::Vector3d bias = DegreesToRadians(1) * Eigen::Vector3d(0.4, -0.3, 0.25);
  noise::Random random(seed);
  std::vector<ImuSample> degraded;
  for (std::size_t i = 0; i < samples.size(); i += every) {
    ImuSample sample = samples[i];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      double& turn = sample.reading.angular_velocity_S_radps[axis];
      turn += bias[axis] + DegreesToRadians(0.35) * random.Normal();
      const double count = std::abs(turn) > slow_range ? fast : slow;
      turn = count * std::round(turn / count);
      double& force = sample.reading.specific_force_S_mps2[axis];
      force += 0.06 * random.Normal();
      sample.reading.clipped = sample.reading.clipped || std::abs(force) >= range_mps2;
      force = count_mps2 * std::round(std::clamp(force, -range_mps2, range_mps2) / count_mps2);
    }
    degraded.push_back(sample);
  }
  return degraded;
}

}  // namespace footing::eval

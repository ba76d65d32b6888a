#include "daemon/offline/eval/mounting.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/stream/sensor.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/sensor/mounting/mounting.h"

namespace footing::eval {
namespace {

using Eigen::Quaterniond;
using Samples = std::vector<stream::MotionSample>;

constexpr double kSlack = 1.5;
constexpr double kRateHz = 100;

/// Reports of 31 and 35 have 10 bits of x and 9 of y and z: two counts of some 104 to the g.
wrists::SensorModel Sensor() {
  wrists::SensorModel sensor;
  sensor.quantum_mps2 = 2 * kStandardGravityMps2 / 104;
  sensor.jitter_s = 0.002;
  return sensor;
}

/// Residual error of the device's own calibration, which is written in whole counts of 10 bits:
/// zero is off by up to half of one and the scale by up to half of one in some 104.
struct Flaw {
  Eigen::Array3d gain = Eigen::Array3d::Ones();
  Eigen::Array3d offset_mps2 = Eigen::Array3d::Zero();
};

Flaw DrawFlaw(noise::Random& random) {
  constexpr double kHalfCount = 0.5 / 104;  // In g.
  Flaw flaw;
  for (int axis = 0; axis < 3; ++axis) {
    flaw.gain(axis) = 1 + kHalfCount * random.Uniform(-1, 1);
    flaw.offset_mps2(axis) = kStandardGravityMps2 * kHalfCount * random.Uniform(-1, 1);
  }
  return flaw;
}

struct MountingErrors {
  std::map<std::string, std::vector<double>> of;
  std::size_t ticks = 0;
  std::size_t missing = 0;  // Not moving, or a feature that is not valid.

  double Percentile(const std::string& name, double share) {
    return text::Quantile(of[name], share);
  }
  nlohmann::json Summary(const std::string& name) {
    return {{"p50", Percentile(name, 0.5)},
            {"p95", Percentile(name, 0.95)},
            {"p99", Percentile(name, 0.99)},
            {"max", Percentile(name, 1)}};
  }
};

/// And what features --synthetic holds the 95th percentile of a perfect mounting to.
constexpr struct {
  const char* name;
  double declared;
} kFeatures[] = {{"frequency_error_hz", 0.03},
                 {"phase_error_deg", 5},
                 {"amplitude_error_share", 0.05},
                 {"roll_error_deg", 2},
                 {"pitch_error_deg", 2}};

/// Both sensors over the whole walk, each turned by its rotation.
std::vector<Samples> Record(const MountingWalk& walk, const Quaterniond (&rotations_MS)[2],
                            const Flaw (&flaws)[2], std::uint64_t seed) {
  const wrists::SensorModel sensor = Sensor();
  noise::Random random(seed);
  std::vector<Samples> sides(2);
  const auto count = static_cast<int>(walk.end_s * kRateHz);
  for (int i = 1; i < count; ++i) {
    const double t_s = i / kRateHz + sensor.jitter_s * random.Uniform(-1, 1);
    for (int side = 0; side < 2; ++side) {
      const Eigen::Vector3d true_S = rotations_MS[side].conjugate() * walk.force_M_mps2(side, t_s);
      const Flaw& flaw = flaws[side];
      const auto reading = Read(sensor, flaw.gain * true_S.array() + flaw.offset_mps2, random);
      stream::MotionSample sample;
      sample.sampled_ns = sample.received_ns = SecondsToNanoseconds(t_s);
      sample.specific_force_mps2 = reading.specific_force_mps2;
      sample.clipped_axes = reading.clipped_axes;
      sides[static_cast<std::size_t>(side)].push_back(sample);
    }
  }
  return sides;
}

std::span<const stream::MotionSample> Between(const Samples& samples, double from_s, double to_s) {
  const auto at = [&samples](double t_s) {
    return std::lower_bound(samples.begin(), samples.end(), SecondsToNanoseconds(t_s),
                            [](const auto& sample, auto ns) { return sample.sampled_ns < ns; });
  };
  return {at(from_s), at(to_s)};
}

void Compare(const WalkTruth& truth, const stream::RigFeatures& rig, MountingErrors& errors) {
  ++errors.ticks;
  for (std::size_t side = 0; side < 2; ++side) {
    const stream::DeviceFeatures& found = rig.devices[side];
    if (!found.moving || !found.frequency_valid || !found.amplitude_valid ||
        !found.inclination_valid) {
      ++errors.missing;
      continue;
    }
    const auto add = [&errors](const char* name, double error) {
      errors.of[name].push_back(std::abs(error));
    };
    add("frequency_error_hz", found.frequency_hz - truth.frequency_hz);
    add("amplitude_error_share", found.amplitude_mps2 / truth.amplitude_mps2[side] - 1);
    add("roll_error_deg", RadiansToDegrees(found.roll_rad - truth.roll_rad[side]));
    add("pitch_error_deg", RadiansToDegrees(found.pitch_rad - truth.pitch_rad[side]));
  }
  const stream::PairFeatures& pair = rig.pairs.front();
  if (!pair.phase_valid) {
    ++errors.missing;
    return;
  }
  errors.of["phase_error_deg"].push_back(
      RadiansToDegrees(std::abs(WrapAngle(pair.phase_rad - truth.phase_rad))));
}

/// The features of the walking part, samples turned as footingd does.
void Measure(const MountingWalk& walk, const std::vector<Samples>& sides,
             const Quaterniond (&rotations_MS)[2], const features::Config& config,
             MountingErrors& errors) {
  Chain chain(true, config);
  for (std::size_t i = 0; i < sides[0].size(); ++i) {
    const double t_s = NanosecondsToSeconds(sides[0][i].sampled_ns);
    if (t_s < walk.walk_from_s - 0.5) continue;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto sample = mounting::Rotated(rotations_MS[side], sides[side][i]);
      chain.Add(side == 0 ? kLeftDevice : kRightDevice, sample.sampled_ns,
                sample.specific_force_mps2, sample.clipped_axes);
    }
    const auto features = chain.Compute(sides[0][i].sampled_ns);
    if (const auto truth = walk.truth(t_s)) Compare(*truth, features, errors);
  }
}

Quaterniond RandomRotation(noise::Random& random) {
  return Quaterniond(random.Normal(), random.Normal(), random.Normal(), random.Normal())
      .normalized();
}

}  // namespace

nlohmann::json MeasureMounting(const MountingWalk& walk, int trials, std::uint64_t seed,
                               const features::Config& config) {
  noise::Random random(seed);
  MountingErrors perfect, solved, rotation;
  int refused = 0;
  std::string problem;
  const Quaterniond none[2] = {Quaterniond::Identity(), Quaterniond::Identity()};
  for (int trial = 0; trial < trials; ++trial) {
    const std::uint64_t noise = seed + 1000 + 2 * static_cast<std::uint64_t>(trial);
    const Flaw flaws[2] = {DrawFlaw(random), DrawFlaw(random)};
    Measure(walk, Record(walk, none, flaws, noise), none, config, perfect);
    const Quaterniond truth[2] = {RandomRotation(random), RandomRotation(random)};
    const auto turned = Record(walk, truth, flaws, noise + 1);
    Quaterniond found[2];
    bool ok = true;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto mounting = mounting::SolveMounting(
          walk.roles[side], Between(turned[side], walk.still_from_s, walk.still_to_s),
          Between(turned[side], walk.still_to_s, walk.steps_to_s));
      ok = ok && mounting.ok;
      if (!mounting.ok) problem = mounting.problem;
      found[side] = mounting.rotation_MS;
      rotation.of["rotation_error_deg"].push_back(
          RadiansToDegrees(mounting.rotation_MS.angularDistance(truth[side])));
    }
    if (ok) {
      Measure(walk, turned, found, config, solved);
    } else {
      ++refused;
    }
  }
  nlohmann::json features;
  bool met = refused == 0;
  bool declared_met = met;
  for (const auto& [name, declared] : kFeatures) {
    const double reached = solved.Percentile(name, 0.95);
    const double bar = kSlack * perfect.Percentile(name, 0.95);
    met = met && reached <= bar;
    declared_met = declared_met && reached <= kSlack * declared;
    features[name] = {{"perfect", perfect.Summary(name)},
                      {"solved", solved.Summary(name)},
                      {"bar", bar},
                      {"met", reached <= bar},
                      {"declared_bar", kSlack * declared}};
  }
  nlohmann::json out = {
      {"walk", walk.what},
      {"trials", trials},
      {"seed", seed},
      {"refused", refused},
      {"features", features},
      {"missing", {{"perfect", perfect.missing}, {"solved", solved.missing}}},
      {"rotation_error_deg", rotation.Summary("rotation_error_deg")},
      {"bar_is", "1.5 times the 95th percentile of the perfect mounting's errors"},
      {"met", met},
      {"declared_met", declared_met}};
  if (refused > 0) out["refused_because"] = problem;
  return out;
}

namespace {

using Eigen::Vector3d;

constexpr std::size_t kLeastOverlap = 6;  // Frames of the next stride that show the period.

}  // namespace

Track Smoothed(const Track& track) {
  Track smoothed;
  const int size = static_cast<int>(track.size());
  for (int i = 0; i < size; ++i) {
    Vector3d sum = Vector3d::Zero();
    const int from = std::max(0, i - kSmoothFrames);
    const int to = std::min(size - 1, i + kSmoothFrames);
    for (int j = from; j <= to; ++j) sum += track[static_cast<std::size_t>(j)];
    smoothed.push_back(sum / (to - from + 1));
  }
  return smoothed;
}

double Mismatch(const Track& track, std::size_t period) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + period < track.size(); ++i, ++count) {
    sum += (track[i + period] - track[i]).squaredNorm();
  }
  return count < kLeastOverlap ? kWorstMismatch : sum / static_cast<double>(count);
}

Track Loop(const Track& track, std::size_t period) {
  Track loop(track.begin(), track.begin() + static_cast<std::ptrdiff_t>(period));
  const std::size_t overlap = track.size() - period;
  for (std::size_t i = 0; i < overlap; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(overlap);
    loop[i] = share * track[i] + (1 - share) * track[i + period];
  }
  return loop;
}

Vector3d At(const Track& loop, double index) {
  const double size = static_cast<double>(loop.size());
  const double wrapped = index - size * std::floor(index / size);
  const auto low = static_cast<std::size_t>(wrapped) % loop.size();
  const double share = wrapped - std::floor(wrapped);
  return (1 - share) * loop[low] + share * loop[(low + 1) % loop.size()];
}

std::size_t MidStance(const Track& loop, const Vector3d& standing, double rate_hz) {
  const int half = static_cast<int>(0.06 * rate_hz);
  std::size_t best = 0;
  double least = kWorstMismatch;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    double sum = 0;
    for (int off = -half; off <= half; ++off) {
      sum += (At(loop, static_cast<double>(i) + off) - standing).squaredNorm();
    }
    if (sum < least) {
      least = sum;
      best = i;
    }
  }
  return best;
}

}  // namespace footing::eval

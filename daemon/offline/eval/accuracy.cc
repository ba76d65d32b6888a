#include "daemon/offline/eval/accuracy.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/quantile.h"
#include "common/base/units.h"
#include "daemon/offline/analysis/features_chain.h"

namespace footing::eval {
namespace {

/// Errors of one feature.
struct Errors {
  std::vector<double> values;
  nlohmann::json Summary(double bar) const {
    const double p95 = text::Quantile(values, 0.95);
    return {{"p50", text::Median(values)},      {"p95", p95}, {"p99", text::Quantile(values, 0.99)},
            {"max", text::Quantile(values, 1)}, {"bar", bar}, {"met", p95 <= bar}};
  }
};

struct Totals {
  Errors frequency_hz;
  Errors phase_deg;
  Errors amplitude_share;  // Of 5 % or one count, whichever is more.
  Errors inclination_deg;
  std::size_t ticks = 0;
  std::size_t missing = 0;
  std::size_t held = 0;
  std::size_t confused = 0;
};

struct Trial {
  wrists::Segment segment;
  wrists::Shape shape;
  wrists::SensorModel sensor;
  double start_angle_rad = 0;
};

Trial Draw(noise::Random& random, bool clip) {
  Trial trial;
  trial.segment.frequency_hz = random.Uniform(0.5, 4.5);
  trial.segment.phase_rad = random.Uniform(-kPi, kPi);
  trial.segment.amplitude_mps2 = clip ? random.Uniform(24, 40) : random.Uniform(4, 18);
  trial.segment.roll_rad = DegreesToRadians(random.Uniform(-25, 25));
  trial.segment.pitch_rad = DegreesToRadians(random.Uniform(-25, 25));
  trial.segment.duration_s = 3 + 5 / trial.segment.frequency_hz;
  if (random.Uniform() < 0.5) trial.shape = wrists::WristShape();
  const double tilt = random.Uniform(0, 2 * kPi);
  if (clip) trial.shape.direction_S = {0, std::cos(tilt), std::sin(tilt)};
  trial.start_angle_rad = random.Uniform(0, 2 * kPi);
  return trial;
}

void Count(const Trial& trial, const stream::RigFeatures& rig, Totals& totals) {
  const auto& truth = trial.segment;
  ++totals.ticks;
  for (const auto& device : rig.devices) {
    totals.held += device.held ? 1 : 0;
    if (!device.moving || !device.frequency_valid || !device.amplitude_valid ||
        !device.inclination_valid) {
      ++totals.missing;
      continue;
    }
    totals.frequency_hz.values.push_back(std::abs(device.frequency_hz - truth.frequency_hz));
    const double allowed = std::max(0.05 * truth.amplitude_mps2, trial.sensor.quantum_mps2);
    totals.amplitude_share.values.push_back(std::abs(device.amplitude_mps2 - truth.amplitude_mps2) /
                                            allowed);
    totals.inclination_deg.values.push_back(RadiansToDegrees(std::max(
        std::abs(device.roll_rad - truth.roll_rad), std::abs(device.pitch_rad - truth.pitch_rad))));
  }
  const auto& pair = rig.pairs.front();
  if (!pair.phase_valid) {
    ++totals.missing;
    return;
  }
  const double error_rad = std::abs(WrapAngle(pair.phase_rad - truth.phase_rad));
  totals.phase_deg.values.push_back(RadiansToDegrees(error_rad));
  totals.confused += error_rad > kPi / 2 ? 1 : 0;
}

nlohmann::json MeasureVariant(int trials, std::uint64_t seed, bool clip) {
  noise::Random random(seed);
  Totals totals;
  for (int i = 0; i < trials; ++i) {
    const Trial trial = Draw(random, clip);
    const wrists::HandMotion motion({trial.segment}, trial.shape, 0, trial.start_angle_rad);
    const auto ticks = Run(Record(motion, trial.sensor, seed + static_cast<std::uint64_t>(i)));
    const double settled_s = 0.5 + 3 / trial.segment.frequency_hz;
    for (const Tick& tick : ticks) {
      if (tick.t_s >= settled_s) Count(trial, tick.features, totals);
    }
  }
  const double slack = clip ? 2 : 1;
  return {{"frequency_error_hz", totals.frequency_hz.Summary(0.03 * slack)},
          {"phase_error_deg", totals.phase_deg.Summary(5 * slack)},
          {"amplitude_error_of_allowed", totals.amplitude_share.Summary(slack)},
          {"inclination_error_deg", totals.inclination_deg.Summary(2 * slack)},
          {"in_and_out_of_phase_confused", totals.confused},
          {"ticks", totals.ticks},
          {"features_missing", totals.missing},
          {"features_held", totals.held}};
}

}  // namespace

nlohmann::json MeasureAccuracy(int trials, std::uint64_t seed) {
  return {{"trials", trials},
          {"seed", seed},
          {"conditions",
           "0.5 to 4.5 Hz, half sines and half wrist-like, any phase, roll and pitch within 25 "
           "degrees, 100 Hz, 38 mg counts, 3.1 mg noise; amplitude 4 to 18 m/s2, clipped 24 to 40 "
           "m/s2 in any direction of the y-z plane at +-3 g; every tick after 3 cycles and 0.5 s"},
          {"amplitude_allowed", "5 % or one count, whichever is more"},
          {"free", MeasureVariant(trials, seed, false)},
          {"clipped", MeasureVariant(trials, seed, true)}};
}

}  // namespace footing::eval

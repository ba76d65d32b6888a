#include "daemon/offline/eval/delays.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "common/base/units.h"
#include "daemon/offline/analysis/features_chain.h"

namespace footing::eval {
namespace {

/// What counts as right: a frequency within 5 %, a phase within 20 degrees.
constexpr double kFrequencyShare = 0.05;
constexpr double kPhaseRad = 20 * kPi / 180;

using Right = std::function<bool(const stream::RigFeatures&)>;

/// Time from `change_s` until the features are right and stay so; infinite if they never do.
double Delay(const std::vector<Tick>& ticks, double change_s, const Right& right) {
  double since_s = INFINITY;
  for (const Tick& tick : ticks) {
    if (tick.t_s < change_s) continue;
    if (!right(tick.features)) {
      since_s = INFINITY;
    } else if (std::isinf(since_s)) {
      since_s = tick.t_s;
    }
  }
  return since_s - change_s;
}

Right MovingIs(bool moving) {
  return [moving](const stream::RigFeatures& rig) {
    return std::all_of(rig.devices.begin(), rig.devices.end(),
                       [moving](const auto& device) { return device.moving == moving; });
  };
}

Right FrequencyIs(double frequency_hz) {
  return [frequency_hz](const stream::RigFeatures& rig) {
    return std::all_of(rig.devices.begin(), rig.devices.end(), [&](const auto& device) {
      return device.frequency_valid &&
             std::abs(device.frequency_hz - frequency_hz) <= kFrequencyShare * frequency_hz;
    });
  };
}

Right PhaseIs(double phase_rad) {
  return [phase_rad](const stream::RigFeatures& rig) {
    const auto& pair = rig.pairs.front();
    return pair.phase_valid && std::abs(WrapAngle(pair.phase_rad - phase_rad)) <= kPhaseRad;
  };
}

wrists::Segment Still() { return {}; }

wrists::Segment Swing(double frequency_hz, double phase_rad, double amplitude_mps2,
                      double duration_s) {
  return {duration_s, frequency_hz, phase_rad, amplitude_mps2, 0.1, -0.1};
}

/// A change from one stretch to another, and what must become right after it.
struct Change {
  wrists::Segment before;
  wrists::Segment after;
  double slower_hz = 1;
  Right right;
};
using DrawChange = std::function<Change(noise::Random&)>;

/// The delay of every trial with the frequency of its slower motion.
struct Sample {
  double delay_s = 0;
  double slower_hz = 1;
};

std::vector<Sample> RunTrials(int trials, std::uint64_t seed, const DrawChange& draw) {
  noise::Random random(seed);
  std::vector<Sample> samples;
  for (int i = 0; i < trials; ++i) {
    const Change change = draw(random);
    const auto shape = random.Uniform() < 0.5 ? wrists::Shape() : wrists::WristShape();
    const wrists::HandMotion motion({change.before, change.after}, shape, 0,
                                    random.Uniform(0, 2 * kPi));
    const auto ticks = Run(Record(motion, {}, seed + static_cast<std::uint64_t>(i)));
    samples.push_back({Delay(ticks, change.before.duration_s, change.right), change.slower_hz});
  }
  return samples;
}

/// Median and maximum of a quantity of the samples.
std::pair<double, double> MedianAndMaximum(const std::vector<Sample>& samples,
                                           const std::function<double(const Sample&)>& quantity) {
  std::vector<double> values;
  for (const Sample& sample : samples) values.push_back(quantity(sample));
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.back()};
}

nlohmann::json Finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json("never");
}

/// A row whose every delay is bounded by `allowed_s` of its trial.
nlohmann::json SecondsRow(const std::vector<Sample>& samples, const char* bar,
                          const std::function<double(const Sample&)>& allowed_s) {
  const auto seconds = MedianAndMaximum(samples, [](const Sample& s) { return s.delay_s; });
  const auto share =
      MedianAndMaximum(samples, [&](const Sample& s) { return s.delay_s / allowed_s(s); });
  return {{"median_s", Finite(seconds.first)},
          {"max_s", Finite(seconds.second)},
          {"max_of_allowed", Finite(share.second)},
          {"worst_at_hz", std::max_element(samples.begin(), samples.end(),
                                           [&](const Sample& a, const Sample& b) {
                                             return a.delay_s / allowed_s(a) <
                                                    b.delay_s / allowed_s(b);
                                           })
                              ->slower_hz},
          {"bar", bar},
          {"met", share.second <= 1}};
}

/// A row in cycles of the slower motion.
nlohmann::json CyclesRow(const std::vector<Sample>& samples) {
  const auto cycles =
      MedianAndMaximum(samples, [](const Sample& s) { return s.delay_s * s.slower_hz; });
  const auto less =
      MedianAndMaximum(samples, [](const Sample& s) { return (s.delay_s - 0.1) * s.slower_hz; });
  return {{"median_cycles", Finite(cycles.first)},
          {"median_cycles_less_0.1_s", Finite(less.first)},
          {"max_cycles", Finite(cycles.second)},
          {"bar", "median 1.25 cycles + 0.1 s, max 2 cycles"},
          {"met", less.first <= 1.25 && cycles.second <= 2}};
}

double DrawFrequency(noise::Random& random) { return random.Uniform(0.5, 4.5); }
double DrawAmplitude(noise::Random& random) { return random.Uniform(4, 18); }

DrawChange FromStill(const std::function<Right(double frequency_hz)>& right) {
  return [right](noise::Random& random) {
    const double f = DrawFrequency(random);
    return Change{Still(), Swing(f, kPi, DrawAmplitude(random), 4 / f), f, right(f)};
  };
}

DrawChange ToStill() {
  return [](noise::Random& random) {
    const double f = DrawFrequency(random);
    const double swung_s = random.Uniform(4, 5) / f;
    wrists::Segment still = Still();
    still.duration_s = 1.5;
    still.roll_rad = 0.1;
    still.pitch_rad = -0.1;
    return Change{Swing(f, kPi, DrawAmplitude(random), swung_s), still, f, MovingIs(false)};
  };
}

DrawChange FrequencyJump(double from_hz, double to_hz) {
  return [from_hz, to_hz](noise::Random& random) {
    const double amplitude = DrawAmplitude(random);
    const double slower_hz = std::min(from_hz, to_hz);
    return Change{Swing(from_hz, kPi, amplitude, random.Uniform(4, 5) / from_hz),
                  Swing(to_hz, kPi, amplitude, 4 / slower_hz), slower_hz, FrequencyIs(to_hz)};
  };
}

DrawChange PhaseJump(double from_rad, double to_rad) {
  return [from_rad, to_rad](noise::Random& random) {
    const double f = DrawFrequency(random);
    const double amplitude = DrawAmplitude(random);
    return Change{Swing(f, from_rad, amplitude, random.Uniform(4, 5) / f),
                  Swing(f, to_rad, amplitude, 4 / f), f, PhaseIs(to_rad)};
  };
}

}  // namespace

nlohmann::json MeasureDelays(int trials, std::uint64_t seed) {
  const auto start_s = [](const Sample&) { return 0.3; };
  const auto stop_s = [](const Sample& s) { return s.slower_hz >= 1.5 ? 0.3 : 0.45 / s.slower_hz; };
  const auto run = [&](const DrawChange& draw) { return RunTrials(trials, seed, draw); };
  const auto moving = FromStill([](double) { return MovingIs(true); });
  const auto frequency = FromStill([](double f) { return FrequencyIs(f); });
  const auto phase = FromStill([](double) { return PhaseIs(kPi); });
  return {
      {"trials", trials},
      {"seed", seed},
      {"right", "and stays so: frequency of both hands within 5 %, phase within 20 degrees"},
      {"start_moving", SecondsRow(run(moving), "0.3 s", start_s)},
      {"stop_moving", SecondsRow(run(ToStill()), "0.3 s from 1.5 Hz up, else 0.45 / f", stop_s)},
      {"start_frequency", CyclesRow(run(frequency))},
      {"start_phase", CyclesRow(run(phase))},
      {"frequency_1_to_3_hz", CyclesRow(run(FrequencyJump(1, 3)))},
      {"frequency_3_to_1_hz", CyclesRow(run(FrequencyJump(3, 1)))},
      {"phase_out_to_in", CyclesRow(run(PhaseJump(kPi, 0)))},
      {"phase_in_to_out", CyclesRow(run(PhaseJump(0, kPi)))}};
}

}  // namespace footing::eval

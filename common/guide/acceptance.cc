#include "common/guide/acceptance.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/guide/device_steps.h"
#include "common/guide/recent.h"

namespace footing::guide {
namespace {

constexpr double kReactionMostS = 3;  // A person hears a prompt and gets going.
constexpr double kReactionShare = 0.4;

struct Row {
  Phase phase;
  const char* name;
  double share;  // Share of the whole time; scaled to the phases that there are.
  bool body_devices;
  bool boards;
  const char* prompt;
};

constexpr Row kRows[] = {
    {Phase::kStill, "still", 1, true, false, "Stand still, arms down."},
    {Phase::kWalk, "walk", 2, true, false, "Walk in place, swinging left and right alternately."},
    {Phase::kRun, "run", 1.5, true, false, "Run in place: faster, more than two steps a second."},
    {Phase::kJump, "jump", 1, true, false, "Swing left and right together, as for jumps."},
    {Phase::kQuiet, "quiet", 1.5, false, true, "Stand upright on the boards and keep still."},
    {Phase::kLean, "lean", 1, false, true,
     "Lean forward from the ankles, heels down, and hold it."},
    {Phase::kStepping, "stepping", 1.5, false, true,
     "Step off the boards, wait, and step on again; again and again."},
    {Phase::kRumble, "rumble", 0.5, true, false, "Feel every remote rumble."},
    {Phase::kLed, "led", 0.5, true, true, "Look at the LEDs: they count."},
    {Phase::kReplug, "replug", 1, true, true,
     "Switch one device off (hold its power button, or take a battery out), and on again."},
};

/// The lamps change every 0.8 s, and a status reports it up to a second later: two patterns are
/// seen within this duration on a busy computer, too.
constexpr double kLedLeastS = 4;

const Row& RowOf(Phase phase) {
  return *std::find_if(std::begin(kRows), std::end(kRows),
                       [phase](const Row& row) { return row.phase == phase; });
}

}  // namespace

const char* Name(Phase phase) { return RowOf(phase).name; }
std::string Prompt(Phase phase) { return RowOf(phase).prompt; }

std::optional<Phase> PhaseNamed(const std::string& name) {
  for (const Row& row : kRows) {
    if (name == row.name) return row.phase;
  }
  return std::nullopt;
}

std::vector<Planned> PlanOf(double minutes, bool body_devices, bool boards) {
  std::vector<Planned> plan;
  double shares = 0;
  for (const Row& row : kRows) {
    if (!(body_devices && row.body_devices) && !(boards && row.boards)) continue;
    plan.push_back({row.phase, row.share});
    shares += row.share;
  }
  for (Planned& planned : plan) {
    planned.duration_s *= minutes * 60 / shares;
    if (planned.phase == Phase::kLed) planned.duration_s = std::max(planned.duration_s, kLedLeastS);
  }
  return plan;
}

bool Passed(const std::vector<Check>& checks) {
  return !checks.empty() &&
         std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.passed; });
}

void Acceptance::Begin(Phase phase, std::int64_t now_ns) {
  End(now_ns);
  spans_.push_back({phase, now_ns, 0});
  running_ = true;
}

void Acceptance::End(std::int64_t now_ns) {
  if (running_) spans_.back().to_ns = now_ns;
  running_ = false;
}

std::optional<Phase> Acceptance::Settled(std::int64_t now_ns) const {
  if (!running_) return std::nullopt;
  // The length of a phase is not known while it runs; the one before is alike enough to go by.
  const double before_s = spans_.size() < 2
                              ? kReactionMostS
                              : NanosecondsToSeconds(spans_[spans_.size() - 2].to_ns -
                                                     spans_[spans_.size() - 2].from_ns);
  const double reaction_s = std::min(kReactionMostS, kReactionShare * before_s);
  if (now_ns - spans_.back().from_ns < SecondsToNanoseconds(reaction_s)) return std::nullopt;
  return spans_.back().phase;
}

double Acceptance::Steady_s() const {
  double steady_s = 0;
  for (const Span& span : spans_) {
    if (span.phase != Phase::kReplug) steady_s += NanosecondsToSeconds(span.to_ns - span.from_ns);
  }
  return steady_s;
}

void Acceptance::Take(const rig::Tick& tick) {
  if (tick.devices) Take(*tick.devices);
  for (const stream::MotionSample& sample : tick.motion) Take(sample);
  for (const stream::BoardSample& sample : tick.boards) Take(sample, tick.host_ns);
  for (const stream::RigFeatures& features : tick.features) Take(features, tick.host_ns);
}

void Acceptance::Take(const std::vector<stream::DeviceStatus>& devices) {
  if (!running_) return;
  const Phase phase = spans_.back().phase;
  for (const stream::DeviceStatus& device : devices) {
    if (device.rig != rig_) continue;
    const bool fresh = devices_.count(device.serial) == 0;
    // One that was lost before the start does not count.
    if (fresh && device.state == stream::DeviceState::kLost) continue;
    DeviceRecord& record = devices_[device.serial];
    if (fresh) record.gaps_first = device.gaps;
    const bool live = device.state == stream::DeviceState::kLive;
    if (phase == Phase::kReplug) {
      record.lost = record.lost || !live;
      record.back = record.lost && live;
    } else {
      record.gaps_last = device.gaps;
    }
    if (device.state == stream::DeviceState::kLost) continue;
    serial_of_[device.device] = device.serial;
    // The report of a device on its link just after a replug says nothing about the run.
    if (fresh || phase != Phase::kReplug) record.last = device;
    record.battery_low = record.battery_low || device.battery_low;
    record.slipped = record.slipped || device.slipped;
    record.moved = record.moved || device.moved;
    if (phase == Phase::kRumble) record.rumbled = record.rumbled || device.rumble;
    if (phase == Phase::kLed) record.leds.insert(device.leds);
  }
}

void Acceptance::Take(const stream::MotionSample& sample) {
  const auto serial = serial_of_.find(sample.device);
  if (!running_ || serial == serial_of_.end() || spans_.back().phase == Phase::kReplug) return;
  DeviceRecord& record = devices_[serial->second];
  ++record.samples;
  record.repeats += sample.repeated;
}

void Acceptance::Take(const stream::BoardSample& sample, std::int64_t now_ns) {
  const auto serial = serial_of_.find(sample.device);
  if (!running_ || serial == serial_of_.end() || spans_.back().phase == Phase::kReplug) return;
  DeviceRecord& record = devices_[serial->second];
  ++record.samples;
  record.repeats += sample.repeated;
  const auto phase = Settled(now_ns);
  if (phase == Phase::kQuiet || phase == Phase::kLean || phase == Phase::kStepping) {
    boards_[*phase][serial->second].push_back(sample);
  }
}

void Acceptance::Take(const stream::RigFeatures& features, std::int64_t now_ns) {
  const auto phase = Settled(now_ns);
  if (!phase || features.rig != rig_) return;
  FeatureRecord& record = features_[*phase];
  for (const stream::DeviceFeatures& device : features.devices) {
    ++record.frames;
    record.moving += device.moving;
    if (device.frequency_valid) record.frequencies_hz.push_back(device.frequency_hz);
  }
  for (const stream::PairFeatures& pair : features.pairs) {
    if (pair.phase_valid) record.phases_rad.push_back(pair.phase_rad);
  }
}

namespace {

// Bars; where they come from: docs/setup.md.
constexpr double kBoardRateHz = 30;
constexpr double kControllerRateHz = 60;
constexpr double kGapsPerMinute = 6;
constexpr double kJitterMs = 40;
constexpr double kRepeatShare = 0.6;
constexpr double kClockSdMs = 6;
constexpr double kStillShare = 0.2;  // Largest share of frames that call standing still a motion.
constexpr double kMovingShare = 0.7;
constexpr double kWalkLeastHz = 0.5;
constexpr double kRunLeastHz = 2;  // The gait paper's border between walking and running.
constexpr double kInTurnsRad = 2;  // Half a cycle is pi.
constexpr double kTogetherRad = 1;
constexpr double kMassChangeKg = 1;
constexpr double kEmptyN = 10;
constexpr double kLedPatterns = 2;

Check AtLeast(std::string name, double value, double bar, std::string unit, std::string note) {
  return {std::move(name), value >= bar, value, bar, std::move(unit), std::move(note)};
}

Check AtMost(std::string name, double value, double bar, std::string unit, std::string note) {
  return {std::move(name), value <= bar, value, bar, std::move(unit), std::move(note)};
}

bool IsBoard(const stream::DeviceStatus& device) {
  return device.kind == stream::DeviceKind::kBalanceBoard;
}

}  // namespace

void Acceptance::CheckDevice(const DeviceRecord& device, std::vector<Check>& checks) const {
  const stream::DeviceStatus& last = device.last;
  const std::string& serial = last.serial;
  const double steady_s = std::max(Steady_s(), 1e-3);
  const auto samples = static_cast<double>(device.samples);
  checks.push_back(AtLeast("rate " + serial, samples / steady_s,
                           IsBoard(last) ? kBoardRateHz : kControllerRateHz, "Hz",
                           "reports a second"));
  const double gaps =
      static_cast<double>(std::max(device.gaps_last, device.gaps_first) - device.gaps_first);
  checks.push_back(AtMost("gaps " + serial, gaps * 60 / std::max(steady_s, 60.0), kGapsPerMinute,
                          "1/min",
                          "gaps in the stream: move closer, or use fewer devices per adapter"));
  checks.push_back(AtMost("jitter " + serial, last.jitter_ms, kJitterMs, "ms",
                          "standard deviation of the intervals"));
  checks.push_back(AtMost("repeats " + serial,
                          static_cast<double>(device.repeats) / std::max(samples, 1.0),
                          kRepeatShare, "", "share of samples equal to the one before"));
  const bool calibrated = last.calibration != stream::CalibrationOrigin::kDefaults &&
                          last.calibration != stream::CalibrationOrigin::kUnspecified;
  checks.push_back(
      AtLeast("calibration " + serial, calibrated ? 1 : 0, 1, "", stream::Name(last.calibration)));
  checks.push_back({"battery " + serial, !device.battery_low, last.battery_fraction, 0, "",
                    device.battery_low          ? "battery low: change the batteries now"
                    : last.battery_fraction < 0 ? "the device reports no level"
                                                : "share of the charge"});
  const bool clock_known = last.clock_offset_sd_ms >= 0;
  checks.push_back(AtMost("clock " + serial, last.clock_offset_sd_ms, kClockSdMs, "ms",
                          clock_known ? "standard deviation of the sampling times"
                                      : "not measured: too few reports; repeat with more minutes"));
  if (!clock_known) checks.back().passed = false;
  if (IsBoard(last)) {
    checks.push_back(AtMost("moved " + serial, device.moved ? 1 : 0, 0, "",
                            device.moved ? "the board was moved: footing-ctl setup --only layout"
                                         : "where its layout was checked"));
  } else {
    checks.push_back(AtMost("mounting " + serial, device.slipped ? 1 : 0, 0, "",
                            device.slipped
                                ? "its mounting slipped: footing-ctl setup --only mounting"
                                : "has not slipped"));
  }
}

void Acceptance::CheckFeatures(std::vector<Check>& checks) const {
  const auto moving = [](const FeatureRecord& record) {
    return record.frames == 0 ? 0 : static_cast<double>(record.moving) / record.frames;
  };
  for (const auto& [phase, record] : features_) {
    const double frequency_hz = text::Median(record.frequencies_hz);
    std::vector<double> sizes;
    for (const double angle : record.phases_rad) sizes.push_back(std::abs(angle));
    const double phase_rad = text::Median(sizes);
    if (phase == Phase::kStill) {
      checks.push_back(
          AtMost("still", moving(record), kStillShare, "", "share of frames with motion"));
    } else if (phase == Phase::kWalk) {
      checks.push_back(
          AtLeast("walk", moving(record), kMovingShare, "", "share of frames with motion"));
      checks.push_back(AtLeast("walk cadence", frequency_hz, kWalkLeastHz, "Hz", "median"));
      if (!sizes.empty()) {
        checks.push_back(AtLeast("walk phase", phase_rad, kInTurnsRad, "rad",
                                 "left and right alternately: near pi"));
      }
    } else if (phase == Phase::kRun) {
      checks.push_back(AtLeast("run cadence", frequency_hz, kRunLeastHz, "Hz", "median"));
    } else if (phase == Phase::kJump) {
      checks.push_back(
          AtLeast("jump", moving(record), kMovingShare, "", "share of frames with motion"));
      if (!sizes.empty()) {
        checks.push_back(AtMost("jump phase", phase_rad, kTogetherRad, "rad",
                                "left and right together: near 0"));
      }
    }
  }
}

Load Acceptance::LoadIn(Phase phase, stream::DeviceRole role) const {
  const auto found = boards_.find(phase);
  if (found == boards_.end()) return {};
  for (const auto& [serial, samples] : found->second) {
    if (devices_.at(serial).last.role == role) return LoadOf(samples);
  }
  return {};
}

void Acceptance::CheckBoards(std::vector<Check>& checks) const {
  const auto quiet = boards_.find(Phase::kQuiet);
  if (quiet == boards_.end()) return;
  double first_n = 0;
  double second_n = 0;
  for (const auto& [serial, samples] : quiet->second) {
    const auto half = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
    first_n += LoadOf({samples.begin(), half}).mean_n;
    second_n += LoadOf({half, samples.end()}).mean_n;
  }
  const double mass_kg = NewtonsToKilograms((first_n + second_n) / 2);
  checks.push_back(
      AtLeast("stood on", mass_kg, NewtonsToKilograms(kStoodOnN), "kg", "on all boards together"));
  checks.push_back(AtMost("mass constancy", NewtonsToKilograms(std::abs(second_n - first_n)),
                          kMassChangeKg, "kg", "between the halves of quiet standing"));

  const auto stepping = boards_.find(Phase::kStepping);
  if (stepping != boards_.end()) {
    for (const auto& [serial, samples] : stepping->second) {
      std::vector<double> empty_n;
      for (const auto& sample : samples) {
        if (!sample.contact) empty_n.push_back(sample.total_n);
      }
      checks.push_back(AtMost("tare " + serial, std::abs(text::Median(empty_n)), kEmptyN, "N",
                              empty_n.empty() ? "was never empty" : "on the empty board"));
      if (empty_n.empty()) checks.back().passed = false;
    }
  }

  LayoutObserved observed;
  observed.upright = {LoadIn(Phase::kQuiet, stream::DeviceRole::kLeftBoard),
                      LoadIn(Phase::kQuiet, stream::DeviceRole::kRightBoard)};
  observed.forward = {LoadIn(Phase::kLean, stream::DeviceRole::kLeftBoard),
                      LoadIn(Phase::kLean, stream::DeviceRole::kRightBoard)};
  const LayoutVerdict verdict = CheckLayout(layout_, observed);
  checks.push_back({"layout", verdict.passed(), verdict.residual_mm, 0, "mm", verdict.note});
}

void Acceptance::CheckActuators(std::vector<Check>& checks) const {
  const auto held = [this](Phase phase) {
    return std::any_of(spans_.begin(), spans_.end(),
                       [phase](const Span& span) { return span.phase == phase; });
  };
  double returned = 0;
  bool away = false;
  for (const auto& [serial, device] : devices_) {
    if (held(Phase::kRumble) && !IsBoard(device.last)) {
      checks.push_back(
          AtLeast("rumble " + serial, device.rumbled ? 1 : 0, 1, "", "was switched on"));
    }
    if (held(Phase::kLed)) {
      checks.push_back(AtLeast("led " + serial, static_cast<double>(device.leds.size()),
                               kLedPatterns, "", "patterns shown"));
    }
    returned += device.lost && device.back ? 1 : 0;
    away = away || (device.lost && !device.back);
  }
  if (!held(Phase::kReplug)) return;
  checks.push_back(AtLeast("replug", returned, 1, "", "devices that disconnected and came back"));
  if (away) {
    checks.back().passed = false;
    checks.back().note = "a device disconnected and did not come back";
  }
}

std::vector<Check> Acceptance::Checks() const {
  std::vector<Check> checks;
  if (devices_.empty()) {
    checks.push_back(AtLeast("devices", 0, 1, "", "no device of rig " + rig_ + " was seen"));
    return checks;
  }
  for (const auto& [serial, device] : devices_) CheckDevice(device, checks);
  CheckFeatures(checks);
  CheckBoards(checks);
  CheckActuators(checks);
  return checks;
}

}  // namespace footing::guide

#include "common/guide/acceptance.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::guide {
namespace {

constexpr double kReactionMostS = 3;  // A person hears a prompt and gets going.
constexpr double kReactionShare = 0.4;

struct Row {
  Phase phase;
  const char* name;
  double share;  // Of the whole time; scaled to the phases that there are.
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

void Acceptance::Take(const std::vector<stream::DeviceStatus>& devices, std::int64_t) {
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
    // What a device reports of its link just after a replug says nothing about the run.
    if (fresh || phase != Phase::kReplug) record.last = device;
    record.battery_low = record.battery_low || device.battery_low;
    record.slipped = record.slipped || device.slipped;
    record.moved = record.moved || device.moved;
    if (phase == Phase::kRumble) record.rumbled = record.rumbled || device.rumble;
    if (phase == Phase::kLed) record.leds.insert(device.leds);
  }
}

void Acceptance::Take(const stream::MotionSample& sample, std::int64_t) {
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

}  // namespace footing::guide

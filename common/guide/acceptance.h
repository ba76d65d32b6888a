#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/guide/recent.h"
#include "common/rig/follower.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"

/// Guided minutes with real devices that end in a verdict. Fed by the ticks of footingd, live or
/// out of a recording: the same ticks and phases give the same checks.
namespace footing::guide {

enum class Phase { kStill, kWalk, kRun, kJump, kQuiet, kLean, kStepping, kRumble, kLed, kReplug };

/// Name of a phase in reports, and the phase of a name; nothing where no phase has it.
const char* Name(Phase phase);
std::optional<Phase> PhaseNamed(const std::string& name);
/// Instruction for the person.
std::string Prompt(Phase phase);

/// One phase of a run, with its duration.
struct Planned {
  Phase phase = Phase::kStill;
  double duration_s = 0;
};

/// Phases for the devices that there are; `minutes` is their total, but for the lamps, which take
/// at least 4 s.
std::vector<Planned> PlanOf(double minutes, bool body_devices, bool boards);

/// Result of one check: its value against the bar that it must meet.
struct Check {
  std::string name;  ///< With the serial behind it, where it is about one device.
  bool passed = false;
  double value = 0;
  double bar = 0;
  std::string unit;
  std::string note;
};

/// Stretch of time of one phase, on footingd's clock.
struct Span {
  Phase phase = Phase::kStill;
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;  ///< Exclusive.
};

/// A plain value that gathers what the checks need.
class Acceptance {
 public:
  Acceptance(std::string rig, stream::BoardLayout layout)
      : rig_(std::move(rig)), layout_(std::move(layout)) {}

  /// Phases follow each other; the last one ends with End(). Times are footingd's.
  void Begin(Phase phase, std::int64_t now_ns);
  void End(std::int64_t now_ns);

  void Take(const rig::Tick& tick);

  std::vector<Check> Checks() const;
  const std::vector<Span>& spans() const { return spans_; }

 private:
  struct DeviceRecord {
    stream::DeviceStatus last;  ///< Newest status while it was attached, before the replug phase.
    std::uint64_t gaps_first = 0;
    std::uint64_t gaps_last = 0;  ///< Before the replug phase.
    std::uint64_t samples = 0;    ///< Outside the replug phase.
    std::uint64_t repeats = 0;
    bool battery_low = false;  ///< Ever.
    bool slipped = false;
    bool moved = false;
    bool rumbled = false;
    bool lost = false;  ///< In the replug phase.
    bool back = false;
    std::set<std::uint32_t> leds;  ///< Shown in the LED phase.
  };
  struct FeatureRecord {
    int frames = 0;
    int moving = 0;
    std::vector<double> frequencies_hz;
    std::vector<double> phases_rad;
  };

  void Take(const std::vector<stream::DeviceStatus>& devices);
  void Take(const stream::MotionSample& sample);
  void Take(const stream::BoardSample& sample, std::int64_t now_ns);
  void Take(const stream::RigFeatures& features, std::int64_t now_ns);
  /// The phase under way, once the person has had time to follow the prompt.
  std::optional<Phase> Settled(std::int64_t now_ns) const;
  double Steady_s() const;  ///< Length of all phases but the replug.
  void CheckDevice(const DeviceRecord& device, std::vector<Check>& checks) const;
  void CheckFeatures(std::vector<Check>& checks) const;
  void CheckBoards(std::vector<Check>& checks) const;
  void CheckActuators(std::vector<Check>& checks) const;
  Load LoadIn(Phase phase, stream::DeviceRole role) const;

  std::string rig_;
  stream::BoardLayout layout_;
  std::vector<Span> spans_;
  bool running_ = false;
  std::map<std::uint32_t, std::string> serial_of_;  ///< Device number to serial, of this rig.
  std::map<std::string, DeviceRecord> devices_;     ///< By serial.
  std::map<Phase, FeatureRecord> features_;
  std::map<Phase, std::map<std::string, std::vector<stream::BoardSample>>> boards_;
};

/// Whether every check passed.
bool Passed(const std::vector<Check>& checks);

}  // namespace footing::guide

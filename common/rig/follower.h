#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/stream/contacts.h"
#include "common/stream/device.h"
#include "common/stream/hand_frames.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"

/// The subscriber's side of footingd: its devices, its set-up, and which of them are those of the
/// rig that a program follows.
namespace footing::rig {

/// One tick of footingd, as far as programs read it that follow a rig. wire::SensorTick makes it.
/// All its numbers are finite: samples with others are left out.
struct Tick {
  std::uint64_t epoch = 0;  ///< Another one with each start of footingd.
  std::uint64_t sequence = 0;
  std::int64_t host_ns = 0;  ///< On footingd's clock, as all times of the samples.
  bool snapshot = false;     ///< It repeats what was before the program subscribed.
  bool refilled = false;     ///< It is late: it was missing before.
  std::optional<std::vector<stream::DeviceStatus>> devices;  ///< The whole list, after any change.
  std::optional<std::vector<stream::RigSetup>> setup;  ///< That of all rigs, after any change.
  std::vector<stream::MotionSample> motion;
  std::vector<stream::NunchukSample> nunchuks;
  std::vector<stream::RigFeatures> features;
  std::vector<stream::BoardSample> boards;
  std::vector<stream::HandSample> hands;
  std::vector<stream::ContactSample> contacts;
};

/// When a source was last heard, on the clock of the program.
struct LastHeard {
  bool ever = false;
  std::int64_t at_ns = 0;
  bool simulated = false;

  /// Whether it has been silent for no longer than `timeout_s`.
  bool IsLive(std::int64_t now_ns, double timeout_s) const;
};

/// New contents of a tick.
struct Changes {
  bool restarted = false;  ///< It is the first tick of a server's start.
  bool devices = false;
  bool setup = false;
};

/// Keeps what footingd published last of its devices and its set-up, and which rig is followed. A
/// plain value.
class Follower {
 public:
  /// `rig` empty: the first rig with an attached device in one of `roles` (bits by
  /// stream::RoleBit), until the server restarts.
  explicit Follower(std::string rig = "", std::uint32_t roles = 0)
      : wanted_rig_(std::move(rig)), roles_(roles), rig_(wanted_rig_) {}

  Changes Take(const Tick& tick);

  /// Whether `rig` is followed. Where none is yet, it is from now on if a device in one of the
  /// roles speaks for it.
  bool Follows(const std::string& rig, stream::DeviceRole role);
  /// Features of the followed rig in this tick; they speak for their devices as Follows() has it.
  /// Null: none.
  const stream::RigFeatures* FeaturesIn(const Tick& tick);
  /// Goes over to this rig; the next one is chosen by other roles.
  void GoTo(const std::string& rig, std::uint32_t roles);

  /// The followed rig; empty: none yet.
  const std::string& rig() const { return rig_; }
  /// The rig that was named; empty: none.
  const std::string& wanted_rig() const { return wanted_rig_; }

  /// Devices and set-up of all rigs.
  const std::vector<stream::DeviceStatus>& devices() const { return devices_; }
  const std::vector<stream::RigSetup>& setup() const { return setup_; }
  /// A device of any rig; null: there is none of that number.
  const stream::DeviceStatus* Find(std::uint32_t device) const;

  /// Role of a device of the followed rig, where it is one of the roles by which a rig is chosen;
  /// else kUnspecified.
  stream::DeviceRole RoleOf(std::uint32_t device) const;
  /// Device of the followed rig in that role; a lost one only where no attached one has it. Null:
  /// none.
  const stream::DeviceStatus* With(stream::DeviceRole role) const;
  /// Roles of the followed rig's devices whose mounting is known, bits by stream::RoleBit.
  std::uint32_t MountedRoles() const;
  /// Where the followed rig's boards lie: board::LayoutOr of what is published.
  stream::BoardLayout Layout() const;

 private:
  bool IsOwn(const stream::DeviceStatus& device) const {
    return !rig_.empty() && device.rig == rig_;
  }

  std::string wanted_rig_;
  std::uint32_t roles_ = 0;
  std::string rig_;
  std::uint64_t epoch_ = 0;
  std::vector<stream::DeviceStatus> devices_;
  std::vector<stream::RigSetup> setup_;
};

}  // namespace footing::rig

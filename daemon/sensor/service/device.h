#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/contacts.h"
#include "common/stream/device.h"
#include "common/stream/hands.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/device_clock.h"
#include "daemon/sensor/reports/outbox.h"
#include "daemon/sensor/service/chains.h"

namespace footing::sensor {

/// Role of a device on a rig (the devices that one person wears or stands on).
struct Binding {
  std::string rig;
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;

  bool operator==(const Binding&) const = default;
};

/// Usage error for a rig's name that is not 1 to 64 bytes of printable text: it goes to screens and
/// files.
Result<void> CheckRig(const std::string& rig);

/// From "rig/role", e.g. "main/left_hand".
Result<Binding> ParseBinding(const std::string& text);

/// And back.
std::string ToText(const Binding& binding);

/// The first role for a device of this placement that is free on the rig: hands, legs and head on
/// the body, left then right for boards; kUnspecified when all are taken.
stream::DeviceRole FirstFreeRole(decode::Placement placement, const std::string& rig,
                                 const std::vector<Binding>& taken);

/// Hands, legs, head and trunk, whose devices have a mounting.
bool IsOnBody(stream::DeviceRole role);

/// A board cannot be a hand, nor a remote a board, nor a gamepad without sensors either.
bool RoleFits(decode::Placement placement, stream::DeviceRole role);

/// Where a device is attached: on one link, on two at once (a PS Move: Bluetooth carries the
/// samples, USB the calibration), or on none since it was lost.
class Links {
 public:
  void Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// True when the second link is the one that carries the samples from now on.
  bool AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// One link is gone; the device is lost when that was the only one.
  void Detach(devices::DeviceHandle handle, const std::string& reason);

  bool attached() const { return attached_; }
  bool Owns(devices::DeviceHandle handle) const {
    return attached_ && (handle == handle_ || (second_ && handle == *second_));
  }
  /// The link that carries the samples.
  devices::DeviceHandle handle() const { return handle_; }
  /// The link that may answer feature reports.
  devices::DeviceHandle feature_handle() const { return second_.value_or(handle_); }
  const devices::DeviceIdentity& identity() const { return identity_; }
  /// Why it was lost.
  const std::string& reason() const { return reason_; }

 private:
  bool attached_ = false;
  std::string reason_;
  devices::DeviceHandle handle_ = 0;
  devices::DeviceIdentity identity_;
  std::optional<devices::DeviceHandle> second_;
  devices::DeviceIdentity second_identity_;
};

/// When a device's samples were taken, and how its link fares.
class SampleTiming {
 public:
  /// A new uninterrupted stream begins.
  void Restart(const decode::Timing& timing);

  /// The samples of a report, new or repeated.
  void Take(std::int64_t received_ns, const decode::Decoded& decoded);
  /// Time of the newest sample; never goes back.
  std::int64_t sampled_ns() const { return sampled_ns_; }
  /// Time of motion sample `i` of the report that was taken last; `before_ns` is the newest sample
  /// of the report before.
  std::int64_t TimeOf(const decode::Decoded& decoded, std::size_t i, std::int64_t before_ns) const;

  /// How well sample times are known (link::DeviceClock::sampled_sd_s), s; negative: not yet.
  double sampled_sd_s() const {
    return own_times_ ? own_clock_.sampled_sd_s() : clock_.sampled_sd_s();
  }
  const link::LinkStatistics& statistics() const { return statistics_; }

 private:
  decode::Timing timing_;
  link::DeviceClock clock_;
  link::OwnClock own_clock_;
  bool own_times_ = false;  ///< Those of the newest report.
  link::LinkStatistics statistics_{0.01};
  std::int64_t sampled_ns_ = 0;
};

/// Everything that one tick publishes.
struct TickContent {
  std::vector<stream::MotionSample> motion;
  std::vector<stream::BoardSample> boards;
  std::vector<stream::NunchukSample> nunchuks;
  std::vector<stream::GamepadSample> gamepads;
  std::vector<stream::CameraSample> cameras;
  std::vector<stream::HandSample> hands;
  std::vector<stream::ReferencePose> reference;
  std::vector<stream::ContactSample> contacts;
  std::vector<stream::RawReport> raw;
  std::vector<stream::RigFeatures> features;
  bool has_status = false;
  std::vector<stream::DeviceStatus> status;
  bool has_setup = false;
  std::vector<stream::RigSetup> setup;
  std::string config;  ///< EffectiveConfig; empty: the one before holds.
};

/// Bounds a tick against a device that floods; a tick of eight devices has some ten of each.
inline constexpr std::size_t kMaxSamplesPerTick = 1024;
/// The same of raw reports, together: most are some 20 bytes, those of an inertial sensor that
/// sends many samples at once 575.
inline constexpr std::size_t kMaxRawBytesPerTick = 64 << 10;
/// The same of poses, which are some 2 KiB each.
inline constexpr std::size_t kMaxReferencesPerTick = 64;
/// And of contact samples, which are some 0.7 KiB.
inline constexpr std::size_t kMaxContactsPerTick = 128;

/// Settings of a device's decoding and its board.
struct DeviceOptions {
  board::PlateConfig plate;
  decode::KindOptions kind;
};

/// One device of the session epoch, known by its serial: reports in, samples out, and what is to be
/// sent to it. It stays when the device is lost and starts again when it comes back.
class Device {
 public:
  using Stored = kinds::Stored;

  Device(std::uint32_t number, const DeviceOptions& options)
      : number_(number), options_(options), chain_(options.plate) {}

  void Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity,
              const Stored& stored = {});
  /// The same device on a second link, when it has_second_link().
  void AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// One of its links is gone; it is lost when that was the only one.
  void Detach(devices::DeviceHandle handle, const std::string& reason) {
    links_.Detach(handle, reason);
  }

  /// Result of one report, besides what it added to the tick.
  struct Taken {
    std::span<const stream::MotionSample> motion;  ///< Its samples, in the tick.
    bool other_kind = false;                       ///< The device proved to be of another kind.
    Stored calibration;                            ///< To be stored.
  };
  /// Decodes one report; samples go to `content`.
  Taken Take(devices::DeviceHandle handle, const devices::IncomingReport& report,
             TickContent& content);
  /// Time passes: handshake and motor.
  void Advance(std::int64_t now_ns);
  /// The next report to write to handle(), if one is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns);
  /// The report that switches the motor off at once.
  reports::OutputReport MotorOff() const { return kind_->MotorOff(); }
  /// The feature report to ask feature_handle() for now, if any.
  std::optional<decode::FeatureRequest> NextFeature(std::int64_t now_ns);
  devices::DeviceHandle feature_handle() const { return links_.feature_handle(); }

  /// The published status; without samples for `stale_after_s` the device is stale.
  stream::DeviceStatus Status(std::int64_t now_ns, double stale_after_s) const;

  std::uint32_t number() const { return number_; }
  bool attached() const { return links_.attached(); }
  devices::DeviceHandle handle() const { return links_.handle(); }
  bool Owns(devices::DeviceHandle handle) const { return links_.Owns(handle); }
  const devices::DeviceIdentity& identity() const { return links_.identity(); }
  bool simulated() const { return identity().simulated; }
  stream::DeviceKind kind() const { return kind_->kind(); }
  decode::Placement placement() const { return kind_->placement(); }
  stream::DeviceRole own_role() const { return kind_->own_role(); }
  bool has_second_link() const { return kind_->has_second_link(); }
  link::Outbox& outbox() { return outbox_; }
  void SetLeds(std::uint8_t leds);
  /// False for devices without a sphere.
  bool SetSphere(std::uint32_t rgb) { return kind_->SetSphere(rgb); }
  /// False for devices without a camera.
  bool SetCamera(bool on) { return kind_->SetCamera(on); }
  /// Asks for the status report; false when that is too soon or it has none.
  bool RequestStatus(std::int64_t now_ns) { return kind_->RequestStatus(now_ns); }

  const Binding& binding() const { return binding_; }
  /// The lamps show the role from now on; without one, the device's number.
  void set_binding(Binding binding);

  /// Chain of a device on the body.
  MountedSensor& mounted_sensor() { return mounted_sensor_; }
  /// Chain of a board.
  BoardChain& chain() { return chain_; }
  const BoardChain& chain() const { return chain_; }

 private:
  struct Counters {
    std::uint64_t repeats = 0;
    std::uint64_t clipped = 0;
    std::uint64_t undecodable = 0;
    std::uint64_t flooded = 0;
    std::uint64_t queue_drops = 0;
    std::uint64_t writes_failed = 0;
  };

  void ShowBinding();
  void Restart();
  void TakeMotion(const devices::IncomingReport& report, decode::Decoded& decoded,
                  std::int64_t before_ns, TickContent& content);
  void TakeBoard(const devices::IncomingReport& report, const decode::BoardReading& reading,
                 TickContent& content);
  void TakeDecoded(const devices::IncomingReport& report, decode::Decoded& decoded,
                   TickContent& content);
  template <typename Sample>
  void Stamp(const devices::IncomingReport& report, Sample& sample) const;
  bool HasSpace(const TickContent& content);
  void PushOutputs();
  void AddState(std::int64_t now_ns, double stale_after_s, stream::DeviceStatus& status) const;

  std::uint32_t number_;
  DeviceOptions options_;
  Links links_;
  Binding binding_;
  std::unique_ptr<kinds::Kind> kind_ = kinds::MakeKind({}, {}, {});
  kinds::Outputs outputs_;
  std::vector<std::uint8_t> stored_calibration_;  ///< As it was when the device attached.
  link::Outbox outbox_;
  SampleTiming timing_;
  MotionChain motion_;
  BoardChain chain_;
  MountedSensor mounted_sensor_;
  bool leds_set_ = false;
  std::uint8_t leds_ = 0;
  Counters counters_;
};

}  // namespace footing::sensor

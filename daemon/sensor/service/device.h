#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/outbox.h"
#include "daemon/sensor/service/binding.h"
#include "daemon/sensor/service/board_chain.h"
#include "daemon/sensor/service/links.h"
#include "daemon/sensor/service/motion_chain.h"
#include "daemon/sensor/service/mounted_sensor.h"
#include "daemon/sensor/service/sample_timing.h"
#include "daemon/sensor/service/tick_content.h"

namespace footing::sensor {

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

  /// Decodes one report; samples go to `content`.
  void Take(devices::DeviceHandle handle, const devices::IncomingReport& report,
            TickContent& content);
  /// Time passes: handshake and motor.
  void Advance(std::int64_t now_ns);
  /// The next report to write to handle(), if one is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns);
  /// The report that switches the motor off at once.
  reports::OutputReport MotorOff() const { return kind_.MotorOff(); }
  /// The feature report to ask feature_handle() for now, if any.
  std::optional<decode::FeatureRequest> NextFeature(std::int64_t now_ns);
  devices::DeviceHandle feature_handle() const { return links_.feature_handle(); }
  /// A calibration blob that was just read from the device, to be stored by its serial; once.
  Stored TakeFreshCalibration();

  stream::DeviceStatus Status(std::int64_t now_ns, double stale_after_s) const;

  std::uint32_t number() const { return number_; }
  bool attached() const { return links_.attached(); }
  devices::DeviceHandle handle() const { return links_.handle(); }
  bool Owns(devices::DeviceHandle handle) const { return links_.Owns(handle); }
  const devices::DeviceIdentity& identity() const { return links_.identity(); }
  bool simulated() const { return identity().simulated; }
  stream::DeviceKind kind() const { return kind_.kind(); }
  decode::Placement placement() const { return kind_.placement(); }
  bool has_second_link() const { return kind_.has_second_link(); }
  link::Outbox& outbox() { return outbox_; }
  void SetLeds(std::uint8_t leds);
  /// False for devices without a sphere.
  bool SetSphere(std::uint32_t rgb) { return kind_.SetSphere(rgb); }
  /// False for devices without a camera.
  bool SetCamera(bool on) { return kind_.SetCamera(on); }
  /// Asks for the status report; false when that is too soon or it has none.
  bool RequestStatus(std::int64_t now_ns) { return kind_.RequestStatus(now_ns); }

  const Binding& binding() const { return binding_; }
  /// The lamps show the role from now on; without one, the device's number.
  void set_binding(Binding binding);

  /// Of a device on the body.
  MountedSensor& mounted_sensor() { return mounted_sensor_; }
  /// Of a board.
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
  kinds::Kind kind_{{}, {}, {}};
  kinds::Outputs outputs_;
  Stored fresh_calibration_;
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

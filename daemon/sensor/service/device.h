#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/board/plate.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/handshake/handshake.h"
#include "daemon/sensor/link/device_clock.h"
#include "daemon/sensor/link/link_statistics.h"
#include "daemon/sensor/link/outbox.h"
#include "daemon/sensor/service/binding.h"
#include "daemon/sensor/service/tick_content.h"
#include "daemon/sensor/signal/kalman_filter.h"

namespace footing::sensor {

/// One device of the session epoch, known by its serial: reports in, samples out, and what is to be
/// sent to it. It stays when the device is lost and starts anew when it comes back.
class Device {
 public:
  Device(std::uint32_t number, const board::PlateConfig& plate)
      : number_(number), plate_config_(plate) {}

  void Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  void Detach(const std::string& reason);

  /// Decodes one report; samples go to `content`.
  void Take(const devices::IncomingReport& report, TickContent& content);
  /// Time passes: handshake and motor.
  void Advance(std::int64_t now_ns);

  stream::DeviceStatus Status(std::int64_t now_ns, double stale_after_s) const;

  std::uint32_t number() const { return number_; }
  bool attached() const { return attached_; }
  devices::DeviceHandle handle() const { return handle_; }
  const devices::DeviceIdentity& identity() const { return identity_; }
  bool simulated() const { return identity_.simulated; }
  stream::DeviceKind kind() const { return handshake_.kind(); }
  link::Outbox& outbox() { return outbox_; }
  void SetLeds(std::uint8_t leds);

  const Binding& binding() const { return binding_; }
  void set_binding(Binding binding) { binding_ = std::move(binding); }

 private:
  void TakeData(const devices::IncomingReport& report, const reports::InputReport& decoded,
                const reports::Data& data, TickContent& content);
  void TakeMotion(const reports::InputReport& decoded, const reports::Data& data,
                  stream::MotionSample& sample);
  void TakeBoard(const reports::BoardCounts& counts, stream::BoardSample& sample);
  void PushOutputs();

  std::uint32_t number_;
  board::PlateConfig plate_config_;
  bool attached_ = false;
  std::string detach_reason_;
  devices::DeviceHandle handle_ = 0;
  devices::DeviceIdentity identity_;
  Binding binding_;

  handshake::Handshake handshake_{{}, ""};
  handshake::Handshake::Outputs outputs_;
  link::Outbox outbox_;
  link::DeviceClock clock_;
  link::LinkStatistics statistics_{0.01};
  signal::KalmanFilter filter_;
  board::Plate plate_;
  bool has_last_counts_ = false;
  std::array<std::uint16_t, 3> last_counts_{};
  std::uint16_t last_buttons_ = 0;
  bool leds_set_ = false;
  std::uint8_t leds_ = 0;
  double board_battery_fraction_ = -1;
  std::uint64_t repeats_ = 0;
  std::uint64_t clipped_ = 0;
  std::uint64_t undecodable_ = 0;
  std::uint64_t flooded_ = 0;
};

}  // namespace footing::sensor

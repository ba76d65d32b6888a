#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "daemon/sensor/calibration/gyroscope_bias.h"
#include "daemon/sensor/decode/balance_board.h"
#include "daemon/sensor/decode/ps_move.h"
#include "daemon/sensor/decode/wiimote.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/handshake/handshake.h"
#include "daemon/sensor/handshake/move_handshake.h"
#include "daemon/sensor/link/device_clock.h"
#include "daemon/sensor/link/link_statistics.h"
#include "daemon/sensor/link/outbox.h"
#include "daemon/sensor/service/binding.h"
#include "daemon/sensor/service/board_chain.h"
#include "daemon/sensor/service/tick_content.h"
#include "daemon/sensor/service/worn.h"
#include "daemon/sensor/signal/kalman_filter.h"

namespace footing::sensor {

struct DeviceOptions {
  board::PlateConfig plate;
  double local_gravity_mps2 = kStandardGravityMps2;
  handshake::HandshakeConfig handshake;
};

/// One device of the session epoch, known by its serial: reports in, samples out, and what is to be
/// sent to it. It stays when the device is lost and starts anew when it comes back.
class Device {
 public:
  /// A calibration read at an earlier time.
  using Stored = std::optional<std::vector<std::uint8_t>>;

  Device(std::uint32_t number, const DeviceOptions& options)
      : number_(number), options_(options), chain_(options.plate) {}

  void Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity,
              const Stored& stored = {});
  /// The same PS Move on a second link. Bluetooth carries the samples, USB the calibration.
  void AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// One of its links is gone; it is lost when that was the only one.
  void Detach(devices::DeviceHandle handle, const std::string& reason);

  /// Decodes one report; samples go to `content`.
  void Take(devices::DeviceHandle handle, const devices::IncomingReport& report,
            TickContent& content);
  /// Time passes: handshake and motor.
  void Advance(std::int64_t now_ns);
  /// The next report to write to handle(), if one is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns);
  struct FeatureRequest {
    devices::DeviceHandle handle = 0;
    std::uint8_t id = 0;
    std::size_t size = 0;
  };
  /// The feature report to ask for now, if any.
  std::optional<FeatureRequest> NextFeature(std::int64_t now_ns);
  /// A calibration blob that was just read from the device, to be stored by its serial; once.
  Stored TakeFreshCalibration();

  stream::DeviceStatus Status(std::int64_t now_ns, double stale_after_s) const;

  std::uint32_t number() const { return number_; }
  bool attached() const { return attached_; }
  devices::DeviceHandle handle() const { return handle_; }
  bool Owns(devices::DeviceHandle handle) const {
    return attached_ && (handle == handle_ || (second_ && handle == *second_));
  }
  const devices::DeviceIdentity& identity() const { return identity_; }
  bool simulated() const { return identity_.simulated; }
  stream::DeviceKind kind() const;
  bool live() const { return move_ ? move_->handshake.live() : handshake_.live(); }
  link::Outbox& outbox() { return outbox_; }
  void SetLeds(std::uint8_t leds);
  /// False for devices without a sphere.
  bool SetSphere(std::uint32_t rgb);
  /// False for devices without a camera.
  bool SetCamera(bool on);
  /// Asks for the status report; false when that is too soon or it has none.
  bool RequestStatus(std::int64_t now_ns);

  const Binding& binding() const { return binding_; }
  /// The lamps show the role from now on; without one, the device's number.
  void set_binding(Binding binding);

  /// Of a worn device.
  Worn& worn() { return worn_; }
  /// Of a board.
  BoardChain& chain() { return chain_; }
  const BoardChain& chain() const { return chain_; }

 private:
  struct Move {
    handshake::MoveHandshake handshake;
    decode::PsMove decoder;
  };

  void ShowBinding();
  void Restart();
  void RestartClock();
  void TakeMove(const devices::IncomingReport& report, TickContent& content);
  void TakeBoard(const devices::IncomingReport& report, const decode::BoardReading& reading,
                 TickContent& content);
  void TakeDecoded(const devices::IncomingReport& report, decode::Decoded& decoded,
                   TickContent& content);
  void TakeMotion(stream::MotionSample& sample, bool measured, TickContent& content);
  bool HasRoom(const TickContent& content);
  void PushOutputs();
  std::string Note(std::int64_t now_ns) const;

  std::uint32_t number_;
  DeviceOptions options_;
  bool attached_ = false;
  std::string detach_reason_;
  devices::DeviceHandle handle_ = 0;
  devices::DeviceIdentity identity_;
  std::optional<devices::DeviceHandle> second_;
  devices::DeviceIdentity second_identity_;
  Binding binding_;

  handshake::Handshake handshake_{{}, ""};
  handshake::Handshake::Outputs outputs_;
  std::optional<Move> move_;
  Stored fresh_calibration_;
  link::Outbox outbox_;

  decode::Wiimote wiimote_;
  decode::BalanceBoard board_;
  link::DeviceClock clock_;
  link::LinkStatistics statistics_{0.01};
  double period_s_ = 0.01;
  signal::KalmanFilter filter_;
  calibration::GyroscopeBias gyroscope_bias_;
  Eigen::Vector3d filtered_mps2_ = Eigen::Vector3d::Zero();
  std::int64_t sampled_ns_ = 0;  ///< Of the newest sample; never goes back.
  BoardChain chain_;
  Worn worn_;

  bool leds_set_ = false;
  std::uint8_t leds_ = 0;
  std::uint64_t repeats_ = 0;
  std::uint64_t clipped_ = 0;
  std::uint64_t undecodable_ = 0;
  std::uint64_t flooded_ = 0;
  std::uint64_t queue_drops_ = 0;
  std::uint64_t writes_failed_ = 0;
};

}  // namespace footing::sensor

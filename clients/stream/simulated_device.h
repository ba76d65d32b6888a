#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/stream/device.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/wiimote.h"

namespace footing::stream_client {

/// One report between a recorded device and its host, seconds since the replay's start.
struct RecordedReport {
  double time_s = 0;
  virtual_devices::Report bytes;
  bool to_device = false;
  bool feature = false;
};

/// A device of a recording, from its attachment to its loss: its data come at their recorded times;
/// what the host asks of it is answered as the recorded device answered the same request.
///
/// A request that came several times has its answers in their order, the last one again and again.
/// A read that was never recorded is refused as a device refuses what it does not have; other
/// requests without a recorded answer have none.
class RecordedDevice {
 public:
  /// `reports` in the order of their times. `stored_calibration` is what the recorded host knew of
  /// a PS Move without asking it; empty: nothing.
  RecordedDevice(virtual_devices::Identity identity, double attaches_s, double detaches_s,
                 const std::vector<RecordedReport>& reports,
                 const std::vector<std::uint8_t>& stored_calibration);

  const virtual_devices::Identity& identity() const { return identity_; }
  double attaches_s() const { return attaches_s_; }
  double detaches_s() const { return detaches_s_; }
  /// The host's questions were recorded: it can be set up again as it was.
  bool has_handshake() const { return !answers_.empty() || !features_.empty(); }

  std::vector<virtual_devices::Report> HandleOutput(std::int64_t now_ns,
                                                    std::span<const std::uint8_t> output);
  /// A feature report cut to `size`; empty when the recorded device refused or was not asked.
  virtual_devices::Report Feature(std::uint8_t id, std::size_t size);

  /// The time of the next data; nothing after the last.
  std::optional<double> NextTime() const;
  /// The data that comes next; NextTime() has a value.
  virtual_devices::Report Take();

 private:
  using Answer = std::vector<virtual_devices::Report>;

  void Learn(const std::vector<RecordedReport>& reports);

  virtual_devices::Identity identity_;
  double attaches_s_;
  double detaches_s_;
  std::vector<RecordedReport> data_;
  std::size_t next_ = 0;
  std::map<virtual_devices::Report, std::deque<Answer>> answers_;  ///< By request.
  std::map<std::uint8_t, std::deque<virtual_devices::Report>> features_;
};

/// One simulated device: a device model, what its sensor feels, and the link it is heard over. It
/// has no clock; times are seconds since its motion began.
class SimulatedDevice {
 public:
  using WiimoteMotion = std::function<virtual_devices::WiimoteSensors(double t_s)>;
  using CornerForces = std::function<virtual_devices::CornerForces(double t_s)>;
  using MoveMotion = std::function<virtual_devices::MoveSensors(double t_s)>;
  /// Each report asks for three times, 5 ms apart.
  using JoyconMotion = std::function<virtual_devices::JoyconSensors(double t_s)>;

  SimulatedDevice(virtual_devices::Wiimote wiimote, WiimoteMotion motion, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  SimulatedDevice(virtual_devices::BalanceBoard board, CornerForces forces, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  SimulatedDevice(virtual_devices::PsMove move, MoveMotion motion, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  SimulatedDevice(virtual_devices::Joycon joycon, JoyconMotion motion, stream::DeviceRole role,
                  const virtual_devices::LinkConfig& link);
  /// Its reports, and when they come, are those of the recording.
  SimulatedDevice(RecordedDevice recorded, stream::DeviceRole role);

  const virtual_devices::Identity& identity() const;
  stream::DeviceRole role() const { return role_; }

  /// Answers of the device to an output report.
  std::vector<virtual_devices::Report> HandleOutput(double now_s,
                                                    std::span<const std::uint8_t> output);
  /// A feature report of `size` bytes; empty when the device refuses.
  virtual_devices::Report Feature(std::uint8_t id, std::size_t size);

  struct Arrival {
    double arrives_s = 0;
    double sampled_s = 0;  ///< When the sensor took the value that arrives.
  };
  /// The next delivery; later than the one before. Infinitely late when a recording has no more.
  Arrival Next();
  /// When the device appears and when it is gone: 0 and never, but for those of a recording.
  double attaches_s() const;
  double detaches_s() const;
  /// The reports with the value of `sampled_s`; none while a mode is wanted and the host has set
  /// none.
  std::vector<virtual_devices::Report> Deliver(double sampled_s);
  /// The motion restarts at time 0 with the device in its initial state, as after a new connection.
  void Restart();

  /// Colour that its sphere shows, 0xRRGGBB; nothing of a device without one.
  std::optional<std::uint32_t> SphereLight(double now_s) const;

  /// A line for the log when lights or rumble changed since the last call; empty otherwise.
  std::string Changes(double now_s);

  /// Lights and rumble as a person would notice them.
  struct Shown {
    std::string lights;
    bool rumble = false;
  };

 private:
  /// The device itself and what it feels.
  template <typename Device, typename Sensors>
  struct Felt {
    Device device;
    std::function<Sensors(double)> motion;
    Sensors held{};  ///< The sensor holds one value until it takes the next.
  };
  using Wiimote = Felt<virtual_devices::Wiimote, virtual_devices::WiimoteSensors>;
  using Board = Felt<virtual_devices::BalanceBoard, virtual_devices::CornerForces>;
  using Move = Felt<virtual_devices::PsMove, virtual_devices::MoveSensors>;
  using Joycon = Felt<virtual_devices::Joycon, virtual_devices::JoyconBurst>;
  struct Recorded {
    RecordedDevice device;
  };
  using Device = std::variant<Wiimote, Board, Move, Joycon, Recorded>;

  SimulatedDevice(Device device, stream::DeviceRole role, const virtual_devices::LinkConfig& link);

  Shown Show(double now_s) const;

  Device fresh_;
  Device device_;
  stream::DeviceRole role_;
  virtual_devices::LinkConfig link_config_;
  virtual_devices::LinkModel link_;
  double held_s_ = -1;
  Shown shown_;  ///< As reported last.
};

}  // namespace footing::stream_client

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/osc.h"

namespace footing::stream_client {

/// One report of a sensor of the network, as footingd takes it (docs/devices.md, "Any inertial
/// sensor").
struct SensorReport {
  std::string sensor;  ///< Its name among all: the sender's address, and a number where it has two.
  std::vector<std::uint8_t> report;
};

/// Result of one packet.
struct SensorPacket {
  std::vector<SensorReport> reports;
  std::vector<std::string> replies;  ///< Packets to the sender.
  bool is_known = false;             ///< It was of one of the protocols below, whole.
};

/// Packets of inertial sensors over UDP, without I/O. What a packet is shows in its first bytes:
///
/// - the report itself, of a board of one's own;
/// - the protocol of SlimeVR's trackers: rotation, and acceleration without gravity. The specific
///   force is R^T g + a, the angular velocity that of the rotations of the last kRateWindowNs.
///   Source: SlimeVR-Server, UDPPacket.kt and TrackersUDPServer.kt;
/// - OSC of Sensors2OSC (Android: /accelerometer, m/s^2, /gyroscope, rad/s) and ZIG SIM (iOS:
///   /NAME/accel and /NAME/gravity in g, downwards, /NAME/gyro in rad/s).
///
/// Times are those of arrival, since SlimeVR and OSC send none.
class SensorPackets {
 public:
  static constexpr std::size_t kMostSensors = 16;
  static constexpr std::size_t kMostPacketBytes = 1500;
  static constexpr std::int64_t kRateWindowNs = 50'000'000;

  SensorPacket Take(const std::string& from, std::int64_t now_ns, osc::Bytes bytes);
  /// Forgets a sensor that is gone.
  void Forget(const std::string& sensor) { sensors_.erase(sensor); }

 private:
  struct Sensor {
    std::uint16_t number = 0;  ///< Number of its last report.
    std::uint8_t battery_percent = 255;
    std::map<std::int64_t, Eigen::Quaterniond> rotations;         ///< Those of the window, by time.
    Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();  ///< Without gravity.
    std::optional<Eigen::Vector3d> gravity_g;                     ///< Downwards.
    Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
    std::int64_t rate_ns = 0;  ///< When the rate came; 0: never.
    std::int64_t heartbeat_ns = 0;
  };

  Sensor* Known(const std::string& sensor);
  /// Known, or a new one where there is a place. For packets that carry a measurement: others
  /// would take a place that nobody gives back.
  Sensor* Of(const std::string& sensor);
  void TakeSlimeVr(const std::string& from, std::int64_t now_ns, osc::Bytes bytes,
                   SensorPacket& packet);
  void TakeSlimeVrPart(const std::string& from, std::int64_t now_ns, std::uint32_t type,
                       osc::Bytes bytes, SensorPacket& packet);
  void Turn(const std::string& sensor, std::int64_t now_ns, const Eigen::Quaterniond& R_WS,
            const std::optional<Eigen::Vector3d>& acceleration_mps2, SensorPacket& packet);
  void TakeOsc(const std::string& from, std::int64_t now_ns, osc::Bytes bytes,
               SensorPacket& packet);
  void Add(const std::string& name, Sensor& sensor, std::int64_t now_ns,
           const Eigen::Vector3d& specific_force_mps2, bool has_rate, SensorPacket& packet) const;

  std::map<std::string, Sensor> sensors_;
  osc::Packet osc_;
};

}  // namespace footing::stream_client

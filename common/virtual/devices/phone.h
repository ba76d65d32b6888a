#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/link_model.h"
#include "common/virtual/devices/noise.h"

namespace footing::virtual_devices {

/// True inputs of a phone held like a remote, screen up: S is x left, y front (its top edge), z
/// down.
struct PhoneSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
};

/// A phone as a controller, through the page of footing-web: its sensor samples at a rate of its
/// own, and each motion event of the browser has the value held then, in steps of 0.1 m/s² and 0.1
/// degrees/s. Rate (50 to 100 Hz), range (4, 8 or 16 g), the sign of the platform and the clock are
/// drawn from the seed.
class Phone {
 public:
  explicit Phone(std::uint64_t seed);

  const Identity& identity() const { return identity_; }
  /// From now until the next call; times rise, and lie closer than the sensor's samples.
  void Feel(std::int64_t now_ns, const PhoneSensors& sensors);
  /// The report of one event (docs/devices.md, "Any inertial sensor").
  Report Event(std::int64_t now_ns);

  double range_mps2() const { return range_mps2_; }

 private:
  void Hold(const PhoneSensors& sensors);

  Identity identity_;
  noise::Random random_;
  double period_ns_ = 0;
  double range_mps2_ = 0;
  bool inverted_ = false;
  double clock_rate_ = 1;
  std::int64_t clock_ahead_ns_ = 0;
  std::int64_t felt_ns_ = 0;
  PhoneSensors felt_;
  double next_ns_ = 0;  ///< When the sensor samples next.
  PhoneSensors held_;
  std::uint16_t number_ = 0;
};

/// 60 events a second over Wi-Fi, a report each, sent in bunches 50 to 300 ms apart.
LinkConfig PhoneLink(LinkQuality quality, std::uint64_t seed);

}  // namespace footing::virtual_devices

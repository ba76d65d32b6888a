#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/identity.h"

namespace footing::virtual_devices {

enum class MoveModel {
  kZcm1,  ///< 054c:03d5: two samples a report, magnetometer.
  kZcm2,  ///< 054c:0c5e: one sample a report, sent twice; no magnetometer.
};

/// What a Move feels. S: x left, y front (to the sphere), z down (away from the buttons).
struct MoveSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();  ///< Right-handed.
  Eigen::Vector3d magnetic_field_S_counts = Eigen::Vector3d::Zero();   ///< +-2047.
  double trigger = 0;                                                  ///< 0 to 1.
  /// psmoveapi's bits: triangle 4, circle, cross, square, select 8, start 11, PS 16, Move 19,
  /// trigger 20.
  std::uint32_t buttons = 0;
  std::uint16_t temperature_raw = 1664;  ///< 12 bits of a thermistor; this is 20 degrees Celsius.
};

/// A PS Move over Bluetooth. It sends as soon as it is there. Axes and layout are those of the
/// moveonpc wiki: raw x to the right, y to the sphere, z out of the buttons.
class PsMove {
 public:
  /// The sphere and the motor go out unless their report comes again (psmoveapi: about 5 s).
  static constexpr std::int64_t kKeepAliveNs = 5'000'000'000;

  /// Its calibration is drawn from the seed.
  PsMove(std::uint64_t seed, MoveModel model);
  /// With the calibration of a unit that is known: 143 bytes of a ZCM1, 96 of a ZCM2.
  PsMove(std::uint64_t seed, MoveModel model, std::vector<std::uint8_t> blob);

  const Identity& identity() const { return identity_; }

  /// Takes the lights' report (id 0x06, or 0x02 of newer firmware): red, green, blue at 2, motor at
  /// 6. There are no answers.
  std::vector<Report> HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report);
  /// Feature 0x10: the calibration's next piece of 49 bytes, in turn. 0x04: Bluetooth addresses, 16
  /// bytes, least significant first. Cut to `size`; none of other ids.
  std::optional<Report> Feature(std::uint8_t id, std::size_t size);

  /// The report of what is felt now. A ZCM1's older sample is half way from the last call's.
  std::vector<Report> Sample(std::int64_t now_ns, const MoveSensors& sensors);

  std::uint32_t sphere_rgb(std::int64_t now_ns) const { return Kept(now_ns) ? sphere_rgb_ : 0; }
  std::uint8_t rumble(std::int64_t now_ns) const { return Kept(now_ns) ? rumble_ : 0; }
  /// 0 to 5, 0xee while charging, 0xef when charged.
  void set_battery(std::uint8_t raw) { battery_ = raw; }
  MoveModel model() const { return model_; }
  /// What the feature reports bring; to be damaged by tests of damage.
  std::vector<std::uint8_t>& blob() { return blob_; }

 private:
  bool Kept(std::int64_t now_ns) const { return lights_ && now_ns - lights_ns_ < kKeepAliveNs; }
  void PutSample(const MoveSensors& sensors, std::size_t half, Report& report) const;

  MoveModel model_;
  std::vector<std::uint8_t> blob_;
  /// Raw axes: counts = zero + value * gain.
  std::array<double, 3> force_zero_{}, force_gain_{}, turn_zero_{}, turn_gain_{};
  Identity identity_;
  std::size_t next_piece_ = 0;
  std::uint8_t sequence_ = 0;
  std::uint8_t battery_ = 5;
  std::optional<MoveSensors> last_;
  bool lights_ = false;
  std::int64_t lights_ns_ = 0;
  std::uint32_t sphere_rgb_ = 0;
  std::uint8_t rumble_ = 0;
};

/// A blob as a factory would write it.
std::vector<std::uint8_t> DrawMoveBlob(std::uint64_t seed, MoveModel model);

}  // namespace footing::virtual_devices

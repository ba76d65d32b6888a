#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/device_models/controller.h"
#include "common/device_models/identity.h"
#include "common/units/units.h"

namespace footing::device_models {

enum class MoveModel { kZcm1, kZcm2 };

/// What a PS Move feels. Sensor frame S: held like a remote, buttons up; x left, y to the sphere,
/// z down.
struct MoveSensors {
  Eigen::Vector3d specific_force_S_mps2{0, 0, -kStandardGravityMps2};
  Eigen::Vector3d angular_velocity_S_radps{0, 0, 0};
  Eigen::Vector3d magnetic_field_S_counts{0, 0, 0};  ///< A ZCM2 has no magnetometer.
  std::uint32_t buttons = 0;  ///< Triangle 10, circle 20, cross 40, square 80, select 100,
                              ///< start 800, PS 10000, Move 80000, trigger 100000 (hex).
  double trigger = 0;         ///< 0 to 1.
};

/// A PS Move over Bluetooth or on its cable, after the moveonpc wiki and psmoveapi. It sends as
/// soon as it is there; its calibration is drawn from the seed. Time must not run backwards.
class PsMove {
 public:
  PsMove(std::uint64_t seed, MoveModel model);

  /// Unless the lights' report comes again, the sphere is dark and the motor off after this.
  static constexpr std::int64_t kLightsLastNs = 5'000'000'000;

  const Identity& identity() const { return identity_; }
  Identity& identity() { return identity_; }

  /// Takes 0x06 (lights and rumble); a Move answers nothing.
  std::vector<Report> HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report);
  /// The answer to a feature request: the calibration (0x10) in pieces, the next one each time.
  /// None for what it does not have.
  std::optional<Report> Feature(std::uint8_t id, std::size_t size);
  /// The report of two moments, the older one first; a ZCM2 sends the newer alone.
  std::vector<Report> Sample(std::int64_t now_ns, const MoveSensors& older,
                             const MoveSensors& newer);
  std::vector<Report> Sample(std::int64_t now_ns, const MoveSensors& sensors) {
    return Sample(now_ns, sensors, sensors);
  }

  std::uint32_t sphere_rgb(std::int64_t now_ns) const;             ///< 0xRRGGBB.
  std::uint8_t rumble(std::int64_t now_ns) const;                  ///< 0 to 255.
  void set_battery(std::uint8_t raw) { battery_ = raw; }           ///< 0 to 5, EE, EF.
  void set_temperature(std::uint16_t raw) { temperature_ = raw; }  ///< 12 bits.
  /// What the feature reports bring, all pieces joined: 143 bytes of a ZCM1, 96 of a ZCM2.
  std::vector<std::uint8_t>& blob() { return blob_; }

 private:
  struct Axis {
    double zero = 0;  ///< Counts, less 0x8000 of a ZCM1.
    double counts_per_g = 4300;
    double bias = 0;  ///< A ZCM1 takes it off by itself.
    double counts_per_radps = 640;
  };
  void PutSample(Report& report, std::size_t at, const MoveSensors& sensors) const;
  void PutCount(std::span<std::uint8_t> out, double counts) const;
  std::vector<std::uint8_t> MakeBlob(std::uint64_t seed) const;

  MoveModel model_;
  std::array<Axis, 3> axes_;  ///< Raw axes: x right, y to the sphere, z out of the buttons.
  Identity identity_;
  std::vector<std::uint8_t> blob_;
  std::size_t piece_ = 0;
  std::uint8_t sequence_ = 0;
  std::uint8_t battery_ = 5;
  std::uint16_t temperature_ = 1664;  ///< 20 degrees Celsius.
  bool lit_ = false;
  std::int64_t lit_ns_ = 0;
  std::uint32_t rgb_ = 0;
  std::uint8_t rumble_ = 0;
};

}  // namespace footing::device_models

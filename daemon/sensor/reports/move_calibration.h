#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/stream/device.h"
#include "daemon/sensor/reports/move_report.h"

/// The PS Move's accelerometer, gyroscope and magnetometer, to SI in its sensor frame S.
///
///        front (sphere)              raw +x: right (start)   S: x = - raw x   (left)
///            ^ y_S                   raw +y: the sphere          y = + raw y   (front)
///           ( )                      raw +z: out of the          z = - raw z   (down)
///          +---+                             buttons
///  x_S     |[=]| seen from above,                            The magnetometer's y is the other way
///  <---    |   | buttons up, held    z_S into the table.     round: S: (- x, - y, - z).
///          +---+ like a remote
///
/// Held still with the buttons up raw z reads +1 g, and in S it is (0, 0, -9.81). The gyroscope
/// follows the right-hand rule about the same raw axes. Sources: the moveonpc wiki ("Input report":
/// buttons up and ball away from you, x right, y up, z away, sent in the order x z y), Monado
/// (ball on Y+, buttons on Z+, start on X+) and psmoveapi (gravity is +y when it stands upright;
/// the magnetometer's y is flipped) agree. No unit was at hand to check it.
namespace footing::calibration {

/// Puts a calibration together from the feature reports that bring it in pieces.
class MoveBlob {
 public:
  explicit MoveBlob(reports::MoveModel model) : model_(model) {}

  /// One feature report (id 0x10, piece number, 47 bytes). The device hands them out in turn, not
  /// always from the first. Anything else is left aside; false then.
  bool Take(reports::Bytes feature);
  bool complete() const;
  /// 143 bytes of a ZCM1, 96 of a ZCM2; pieces that have not come are zero.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  reports::MoveModel model_;
  std::array<bool, 3> taken_{};
  std::vector<std::uint8_t> bytes_;
};

/// How many times the feature report has to be read: 3 of a ZCM1, 2 of a ZCM2.
constexpr std::size_t MoveBlobPieces(reports::MoveModel model) {
  return model == reports::MoveModel::kZcm1 ? 3 : 2;
}
/// The first piece counts in full, the later ones without their two bytes of head.
constexpr std::size_t MoveBlobBytes(reports::MoveModel model) {
  return MoveBlobPieces(model) * (reports::kMoveCalibrationFeatureBytes - 2) + 2;
}

/// Zeros and gains of a PS Move's sensors.
struct MoveCalibration {
  /// Per raw axis: value = (raw - zero) * gain.
  std::array<double, 3> acceleration_zero_counts{};
  std::array<double, 3> acceleration_gain_mps2{};  ///< A count.
  std::array<double, 3> gyroscope_zero_counts{};
  std::array<double, 3> gyroscope_gain_radps{};  ///< A count.
  stream::CalibrationOrigin origin = stream::CalibrationOrigin::kDefaults;
  std::string problem;  ///< Why the device's own blob is not used; empty when it is.
};

/// Typical values of the model.
MoveCalibration DefaultMove(reports::MoveModel model);

/// From a whole blob. Accelerometer: -1 g and +1 g of each axis. Gyroscope: a ZCM1 has +80
/// revolutions a minute and its bias, which is only for these values (its reports come without it),
/// times a factor near 1 when that is a possible number; a ZCM2 has -90 and +90 and a bias to take
/// off. A blob that is short, empty, of the other model (its id and pieces) or has spans that no
/// working sensor has gives DefaultMove and the problem by name. A blob read from a file is
/// kStored: the caller says so.
MoveCalibration ParseMove(reports::MoveModel model, reports::Bytes blob);

/// One PS Move sample in SI units, frame S.
struct MoveReading {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Accelerometer's axes; bits 0, 1, 2: x, y, z.
  bool angular_velocity_clipped = false;
  double trigger = 0;  ///< 0 to 1.
};

/// `half`: 0 the older sample, 1 the newer; below report.sample_count.
MoveReading Calibrate(const MoveCalibration& calibration, const reports::MoveReport& report,
                      std::size_t half);

/// Counts in S, neither scaled nor rid of the magnet's own offset; zero when there is none.
Eigen::Vector3d MagneticField(const reports::MoveReport& report);

}  // namespace footing::calibration

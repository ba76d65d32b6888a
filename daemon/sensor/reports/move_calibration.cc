#include "daemon/sensor/reports/move_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/base/units.h"
#include "daemon/sensor/reports/wiimote_calibration.h"

namespace footing::calibration {
namespace {

using reports::MoveModel;

constexpr std::array<double, 3> kMoveSigns = {-1, +1, -1};
constexpr std::array<double, 3> kMagneticSigns = {-1, -1, -1};

constexpr double kRpmToRadps = 2 * kPi / 60;
constexpr std::size_t kHeadBytes = 2;
constexpr int kMoveTopCount = 32767;

/// Offsets of 16-bit vectors in the blob (psmoveapi and Monado agree).
struct MoveLayout {
  std::array<std::size_t, 3> low;   ///< -1 g of x, y, z.
  std::array<std::size_t, 3> high;  ///< +1 g of x, y, z.
  std::array<std::size_t, 3> turn;  ///< Turning about x, y, z.
  std::size_t bias;
  double turn_radps;
};

constexpr MoveLayout kZcm1 = {
    {0x0a, 0x22, 0x10}, {0x16, 0x1c, 0x04}, {0x46, 0x4e, 0x56}, 0x2a, 80 * kRpmToRadps};
constexpr std::size_t kZcm1BiasFactorAt = 0x6a;
constexpr MoveLayout kZcm2 = {
    {0x08, 0x14, 0x20}, {0x02, 0x0e, 0x1a}, {0x30, 0x36, 0x3c}, 0x26, 90 * kRpmToRadps};
constexpr std::array<std::size_t, 3> kZcm2BackTurn = {0x42, 0x48, 0x4e};

/// Real units: 4050 to 4480 counts a g, 5170 to 6830 counts at the turn.
constexpr double kMoveMinOneG = 2000;
constexpr double kMoveMaxOneG = 9000;
constexpr double kMinTurn = 2000;
constexpr double kMaxTurn = 16000;
constexpr double kMoveMaxZero = 4000;

int Count(MoveModel model, reports::Bytes blob, std::size_t at) {
  const int raw = blob[at] | blob[at + 1] << 8;
  return model == MoveModel::kZcm1 ? raw - 0x8000 : static_cast<std::int16_t>(raw);
}

/// 1 when the stored one is impossible (NaN, for one).
double BiasFactor(reports::Bytes blob, std::size_t axis) {
  const std::size_t at = kZcm1BiasFactorAt + 4 * axis;
  const std::uint32_t bits = blob[at] | blob[at + 1] << 8 | blob[at + 2] << 16 |
                             static_cast<std::uint32_t>(blob[at + 3]) << 24;
  float factor = 0;
  std::memcpy(&factor, &bits, sizeof factor);
  return factor >= 0.5f && factor <= 2 ? factor : 1;
}

std::string ReadAcceleration(MoveModel model, const MoveLayout& layout, reports::Bytes blob,
                             MoveCalibration& calibration) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int low = Count(model, blob, layout.low[i] + 2 * i);
    const int high = Count(model, blob, layout.high[i] + 2 * i);
    const double one_g = (high - low) / 2.0;
    const double zero = (high + low) / 2.0;
    if (!(one_g > kMoveMinOneG && one_g < kMoveMaxOneG)) return "1 g is impossible";
    if (std::abs(zero) > kMoveMaxZero) return "zero point is impossible";
    calibration.acceleration_zero_counts[i] = zero;
    calibration.acceleration_gain_mps2[i] = kStandardGravityMps2 / one_g;
  }
  return "";
}

std::string ReadGyroscope(MoveModel model, const MoveLayout& layout, reports::Bytes blob,
                          MoveCalibration& calibration) {
  for (std::size_t i = 0; i < 3; ++i) {
    const int forth = Count(model, blob, layout.turn[i] + 2 * i);
    const int bias = Count(model, blob, layout.bias + 2 * i);
    double turn = 0;
    if (model == MoveModel::kZcm1) {
      turn = forth - bias * BiasFactor(blob, i);
      calibration.gyroscope_zero_counts[i] = 0;
    } else {
      turn = (forth - Count(model, blob, kZcm2BackTurn[i] + 2 * i)) / 2.0;
      calibration.gyroscope_zero_counts[i] = bias;
    }
    if (!(turn > kMinTurn && turn < kMaxTurn)) return "gyroscope's scale is impossible";
    if (std::abs(bias) > kMoveMaxZero) return "gyroscope's bias is impossible";
    calibration.gyroscope_gain_radps[i] = layout.turn_radps / turn;
  }
  return "";
}

std::string ReadBlob(MoveModel model, reports::Bytes blob, MoveCalibration& calibration) {
  if (blob.empty()) return "not read";
  if (blob.size() < MoveBlobBytes(model)) return "cut short";
  if (blob.size() > MoveBlobBytes(model)) return "of another model";
  if (AllEqual(blob.subspan(kHeadBytes), 0xff)) return "all FF";
  if (AllEqual(blob.subspan(kHeadBytes), 0x00)) return "all 00";
  if (blob[0] != reports::kMoveCalibrationFeature || blob[1] != 0) return "does not begin rightly";
  const MoveLayout& layout = model == MoveModel::kZcm1 ? kZcm1 : kZcm2;
  const std::string problem = ReadAcceleration(model, layout, blob, calibration);
  return problem.empty() ? ReadGyroscope(model, layout, blob, calibration) : problem;
}

}  // namespace

bool MoveBlob::Take(reports::Bytes feature) {
  constexpr std::size_t kPiece = reports::kMoveCalibrationFeatureBytes;
  if (feature.size() < kPiece || feature[0] != reports::kMoveCalibrationFeature) return false;
  const std::size_t pieces = MoveBlobPieces(model_);
  const std::size_t piece = feature[1] & 0x0f;
  // The last piece has its upper bit set.
  if (piece >= pieces || (feature[1] >> 7 == 1) != (piece + 1 == pieces)) return false;
  bytes_.resize(MoveBlobBytes(model_));
  const std::size_t head = piece == 0 ? 0 : kHeadBytes;
  std::copy(feature.begin() + static_cast<std::ptrdiff_t>(head),
            feature.begin() + static_cast<std::ptrdiff_t>(kPiece),
            bytes_.begin() + static_cast<std::ptrdiff_t>(piece * (kPiece - kHeadBytes) + head));
  taken_[piece] = true;
  return true;
}

bool MoveBlob::complete() const {
  return static_cast<std::size_t>(std::count(taken_.begin(), taken_.end(), true)) ==
         MoveBlobPieces(model_);
}

MoveCalibration DefaultMove(MoveModel model) {
  const bool first = model == MoveModel::kZcm1;
  MoveCalibration calibration;
  // Between the real units that are known.
  calibration.acceleration_gain_mps2.fill(kStandardGravityMps2 / (first ? 4350 : 4096));
  calibration.gyroscope_gain_radps.fill(first ? kZcm1.turn_radps / 5360 : kZcm2.turn_radps / 6780);
  return calibration;
}

MoveCalibration ParseMove(MoveModel model, reports::Bytes blob) {
  MoveCalibration calibration;
  const std::string problem = ReadBlob(model, blob, calibration);
  if (!problem.empty()) {
    calibration = DefaultMove(model);
    calibration.problem = "PS Move calibration: " + problem + "; typical values are used";
    return calibration;
  }
  calibration.origin = stream::CalibrationOrigin::kDevice;
  return calibration;
}

MoveReading Calibrate(const MoveCalibration& calibration, const reports::MoveReport& report,
                      std::size_t half) {
  const reports::MoveSample& sample = report.samples.at(half);
  MoveReading reading;
  reading.trigger = sample.trigger / 255.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    reading.specific_force_S_mps2[axis] =
        kMoveSigns[i] * (sample.acceleration[i] - calibration.acceleration_zero_counts[i]) *
        calibration.acceleration_gain_mps2[i];
    reading.angular_velocity_S_radps[axis] =
        kMoveSigns[i] * (sample.angular_velocity[i] - calibration.gyroscope_zero_counts[i]) *
        calibration.gyroscope_gain_radps[i];
    if (std::abs(int{sample.acceleration[i]}) >= kMoveTopCount) reading.clipped_axes |= 1u << i;
    if (std::abs(int{sample.angular_velocity[i]}) >= kMoveTopCount) {
      reading.angular_velocity_clipped = true;
    }
  }
  return reading;
}

Eigen::Vector3d MagneticField(const reports::MoveReport& report) {
  Eigen::Vector3d field = Eigen::Vector3d::Zero();
  if (!report.has_magnetic_field) return field;
  for (std::size_t i = 0; i < 3; ++i) {
    field[static_cast<Eigen::Index>(i)] = kMagneticSigns[i] * report.magnetic_field[i];
  }
  return field;
}

}  // namespace footing::calibration

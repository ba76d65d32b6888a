#include "common/virtual/devices/accelerometer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"

namespace footing::wrists {
namespace {

double Smooth(double u) { return u * u * (3 - 2 * u); }
double SmoothIntegral(double u) { return u * u * u * (1 - 0.5 * u); }
double Mix(double from, double to, double share) { return from + (to - from) * share; }

double ShapeAt(const Shape& shape, double angle_rad) {
  return std::sin(angle_rad) + shape.second * std::sin(2 * angle_rad + shape.second_phase_rad);
}

}  // namespace

Shape WristShape() {
  Shape shape;
  shape.second = 0.3;
  shape.second_phase_rad = 0.6;
  return shape;
}

Eigen::Vector3d InclinedGravity(double roll_rad, double pitch_rad) {
  const double x = std::sin(roll_rad);
  const double y = std::sin(pitch_rad);
  return kStandardGravityMps2 * Eigen::Vector3d(x, y, -std::sqrt(std::max(0.0, 1 - x * x - y * y)));
}

HandMotion::HandMotion(std::vector<Segment> segments, const Shape& shape, double blend_s,
                       double start_angle_rad)
    : shape_(shape) {
  shape_.direction_S.normalize();
  double low = 0;
  double high = 0;
  for (int i = 0; i < 3600; ++i) {
    const double value = ShapeAt(shape_, 2 * kPi * i / 3600);
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // Both sines have mean zero, so the swing adds nothing to the inclination.
  shape_half_range_ = 0.5 * (high - low);

  double angle_rad = start_angle_rad;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    Piece piece;
    piece.to = segments[i];
    piece.from = i == 0 ? segments[i] : segments[i - 1];
    // A hand that stands still has no frequency to blend from or to.
    if (piece.from.amplitude_mps2 == 0) piece.from.frequency_hz = piece.to.frequency_hz;
    if (piece.from.amplitude_mps2 == 0) piece.from.phase_rad = piece.to.phase_rad;
    if (piece.to.amplitude_mps2 == 0) piece.to.frequency_hz = piece.from.frequency_hz;
    if (piece.to.amplitude_mps2 == 0) piece.to.phase_rad = piece.from.phase_rad;
    piece.from.phase_rad =
        piece.to.phase_rad + WrapAngle(piece.from.phase_rad - piece.to.phase_rad);
    piece.start_s = duration_s_;
    piece.start_angle_rad = angle_rad;
    piece.blend_s = i == 0 ? 0.0 : std::min(blend_s, piece.to.duration_s);
    angle_rad += AngleIn(piece, piece.to.duration_s);
    duration_s_ += piece.to.duration_s;
    pieces_.push_back(piece);
  }
}

double HandMotion::AngleIn(const Piece& piece, double into_s) const {
  const double blended_s = std::min(into_s, piece.blend_s);
  double cycles = piece.to.frequency_hz * (into_s - blended_s);
  if (piece.blend_s > 0) {
    cycles += piece.from.frequency_hz * blended_s +
              (piece.to.frequency_hz - piece.from.frequency_hz) * piece.blend_s *
                  SmoothIntegral(blended_s / piece.blend_s);
  }
  return 2 * kPi * cycles;
}

Eigen::Vector3d HandMotion::Swing(double angle_rad, double amplitude_mps2) const {
  const double value = ShapeAt(shape_, angle_rad);
  return amplitude_mps2 * value / shape_half_range_ * shape_.direction_S;
}

Hands HandMotion::At(double t_s) const {
  const double t = std::max(0.0, t_s);
  std::size_t i = 0;
  while (i + 1 < pieces_.size() && t >= pieces_[i + 1].start_s) ++i;
  const Piece& piece = pieces_[i];
  const double into_s = t - piece.start_s;
  const double share = into_s < piece.blend_s ? Smooth(into_s / piece.blend_s) : 1.0;
  const Segment& from = piece.from;
  const Segment& to = piece.to;
  const double angle = piece.start_angle_rad + AngleIn(piece, into_s);
  const double amplitude = Mix(from.amplitude_mps2, to.amplitude_mps2, share);
  const Eigen::Vector3d gravity = InclinedGravity(Mix(from.roll_rad, to.roll_rad, share),
                                                  Mix(from.pitch_rad, to.pitch_rad, share));
  return {gravity + Swing(angle, amplitude),
          gravity + Swing(angle + Mix(from.phase_rad, to.phase_rad, share), amplitude)};
}

SensorReading Read(const SensorModel& model, const Eigen::Vector3d& true_mps2,
                   noise::Random& random) {
  SensorReading reading;
  // The last whole count inside the range, so that a clipped value is one the device can send.
  const double end = model.quantum_mps2 > 0
                         ? std::floor(model.range_mps2 / model.quantum_mps2) * model.quantum_mps2
                         : model.range_mps2;
  for (int axis = 0; axis < 3; ++axis) {
    double value = true_mps2(axis) + model.noise_mps2 * random.Normal();
    if (model.quantum_mps2 > 0) {
      value = std::floor(value / model.quantum_mps2 + 0.5) * model.quantum_mps2;
    }
    if (std::abs(value) >= end) {
      value = std::clamp(value, -end, end);
      reading.clipped_axes |= 1u << axis;
    }
    reading.specific_force_mps2(axis) = value;
  }
  return reading;
}

std::vector<TimedReading> Record(const HandMotion& motion, const SensorModel& model,
                                 std::uint64_t seed, std::int64_t start_ns) {
  noise::Random random(seed);
  const auto count = static_cast<std::size_t>(motion.DurationSeconds() * model.rate_hz);
  std::vector<TimedReading> readings;
  readings.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double off_s = model.jitter_s * random.Uniform(-1, 1);
    const double t_s = std::max(0.0, static_cast<double>(i) / model.rate_hz + off_s);
    const Hands hands = motion.At(t_s);
    TimedReading reading;
    reading.sampled_ns = start_ns + SecondsToNanoseconds(t_s);
    reading.left = Read(model, hands.left_mps2, random);
    reading.right = Read(model, hands.right_mps2, random);
    readings.push_back(reading);
  }
  return readings;
}

}  // namespace footing::wrists

#include "common/device_models/ps_move.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/synthetic/random.h"

namespace footing::device_models {
namespace {

/// Raw axes point right, to the sphere and up; the magnetometer's y away from the sphere.
constexpr std::array<double, 3> kRawSigns = {-1, +1, -1};
constexpr std::array<double, 3> kMagneticSigns = {-1, -1, -1};
constexpr std::size_t kPieceBytes = 49;  // With id and number.
constexpr std::size_t kHeadBytes = 2;
constexpr std::uint32_t kVendorSony = 0x054c;
constexpr double kRpm = 2 * kPi / 60;  // rad/s.

double Finite(double value) { return std::isfinite(value) ? value : 0; }

std::size_t Bytes(MoveModel model) { return model == MoveModel::kZcm1 ? 49 : 44; }
std::size_t Pieces(MoveModel model) { return model == MoveModel::kZcm1 ? 3 : 2; }

/// Offset in the blob of what is measured with +1 g and -1 g in x, y, z.
constexpr std::size_t kZcm1Upright[] = {0x16, 0x1c, 0x04};
constexpr std::size_t kZcm1UpsideDown[] = {0x0a, 0x22, 0x10};
constexpr std::size_t kZcm2Upright[] = {0x02, 0x0e, 0x1a};
constexpr std::size_t kZcm2UpsideDown[] = {0x08, 0x14, 0x20};

}  // namespace

PsMove::PsMove(std::uint64_t seed, MoveModel model) : model_(model) {
  // Real units: 4070 to 4480 counts a g, 5350 to 6830 at 80 and 90 turns a minute.
  synthetic::Random random(seed);
  const bool first = model == MoveModel::kZcm1;
  for (Axis& axis : axes_) {
    axis.zero = std::round(random.Uniform(-200, 200));
    axis.counts_per_g = std::round(first ? random.Uniform(4250, 4400) : random.Uniform(4050, 4150));
    axis.bias = std::round(random.Uniform(-120, 120));
    axis.counts_per_radps =
        std::round(first ? random.Uniform(5250, 5450) : random.Uniform(6700, 6850)) /
        ((first ? 80 : 90) * kRpm);
  }
  identity_.vendor = kVendorSony;
  identity_.product = first ? 0x03d5 : 0x0c5e;
  identity_.name = "Motion Controller";
  identity_.serial = MakeSerial(seed);
  blob_ = MakeBlob(seed);
}

void PsMove::PutCount(std::span<std::uint8_t> out, double counts) const {
  const int raw = static_cast<int>(std::clamp(std::round(counts), -32768.0, 32767.0)) +
                  (model_ == MoveModel::kZcm1 ? 0x8000 : 0);
  out[0] = static_cast<std::uint8_t>(raw);
  out[1] = static_cast<std::uint8_t>(raw >> 8);
}

std::vector<std::uint8_t> PsMove::MakeBlob(std::uint64_t seed) const {
  const bool first = model_ == MoveModel::kZcm1;
  synthetic::Random random(seed + 1);
  std::vector<std::uint8_t> blob(Pieces(model_) * (kPieceBytes - kHeadBytes) + kHeadBytes, 0);
  blob[0] = 0x10;
  const auto put = [&](std::size_t at, double counts) {
    PutCount(std::span(blob).subspan(at, 2), counts);
  };
  for (std::size_t turned = 0; turned < 3; ++turned) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Axis& axis = axes_[i];
      const double g = i == turned ? axis.counts_per_g : random.Uniform(-60, 60);
      put((first ? kZcm1Upright : kZcm2Upright)[turned] + 2 * i, axis.zero + g);
      put((first ? kZcm1UpsideDown : kZcm2UpsideDown)[turned] + 2 * i, axis.zero - g);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    if (first) {
      const float factor = 1;
      put(0x2a + 2 * i, axis.bias);
      put(0x32 + 2 * i, axis.bias);
      put(0x46 + 8 * i + 2 * i, axis.counts_per_radps * 80 * kRpm + axis.bias);
      std::memcpy(&blob[0x6a + 4 * i], &factor, sizeof factor);
    } else {
      put(0x26 + 2 * i, axis.bias);
      put(0x30 + 6 * i + 2 * i, axis.bias + axis.counts_per_radps * 90 * kRpm);
      put(0x42 + 6 * i + 2 * i, axis.bias - axis.counts_per_radps * 90 * kRpm);
    }
  }
  return blob;
}

std::vector<Report> PsMove::HandleOutput(std::int64_t now_ns,
                                         std::span<const std::uint8_t> report) {
  if (report.size() < 7 || report[0] != 0x06) return {};
  lit_ = true;
  lit_ns_ = now_ns;
  rgb_ = std::uint32_t{report[2]} << 16 | std::uint32_t{report[3]} << 8 | report[4];
  rumble_ = report[6];
  return {};
}

std::optional<Report> PsMove::Feature(std::uint8_t id, std::size_t size) {
  if (id != 0x10 || size < kPieceBytes) return std::nullopt;
  const std::size_t pieces = Pieces(model_);
  const std::size_t piece = piece_++ % pieces;
  Report report(kPieceBytes, 0);
  report[0] = id;
  report[1] = static_cast<std::uint8_t>(piece | (piece + 1 == pieces ? 0x80 : 0));
  const auto begin =
      blob_.begin() + static_cast<std::ptrdiff_t>(kHeadBytes + piece * (kPieceBytes - kHeadBytes));
  std::copy_n(begin, kPieceBytes - kHeadBytes, report.begin() + kHeadBytes);
  return report;
}

void PsMove::PutSample(Report& report, std::size_t half, const MoveSensors& sensors) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double g =
        kRawSigns[i] * Finite(sensors.specific_force_S_mps2[at]) / kStandardGravityMps2;
    const double turn_radps = kRawSigns[i] * Finite(sensors.angular_velocity_S_radps[at]);
    const double bias = model_ == MoveModel::kZcm1 ? 0 : axis.bias;
    const auto bytes = std::span(report);
    PutCount(bytes.subspan(0x0d + 6 * half + 2 * i, 2), axis.zero + g * axis.counts_per_g);
    PutCount(bytes.subspan(0x19 + 6 * half + 2 * i, 2), bias + turn_radps * axis.counts_per_radps);
  }
  report[5 + half] =
      static_cast<std::uint8_t>(std::lround(std::clamp(Finite(sensors.trigger), 0.0, 1.0) * 255));
}

std::vector<Report> PsMove::Sample(std::int64_t now_ns, const MoveSensors& older,
                                   const MoveSensors& newer) {
  const bool first = model_ == MoveModel::kZcm1;
  Report report(Bytes(model_), 0);
  report[0] = 0x01;
  const std::uint32_t b = newer.buttons;
  report[1] = static_cast<std::uint8_t>(b >> 8);
  report[2] = static_cast<std::uint8_t>(b);
  report[3] = static_cast<std::uint8_t>(b >> 16 & 0x01);
  report[4] = static_cast<std::uint8_t>((b >> 13 & 0xc0) | sequence_);
  sequence_ = (sequence_ + 1) & 0x0f;
  // Its unit is not published; ten microseconds here.
  const auto time = static_cast<std::uint16_t>(now_ns / 10'000);
  report[0x0b] = static_cast<std::uint8_t>(time >> 8);
  report[first ? 0x2b : 0x28] = static_cast<std::uint8_t>(time);
  report[0x0c] = battery_;
  PutSample(report, 0, first ? older : newer);
  PutSample(report, 1, newer);
  report[0x25] = static_cast<std::uint8_t>(temperature_ >> 4);
  report[0x26] = static_cast<std::uint8_t>(temperature_ << 4);
  if (first) {
    int field[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const double counts =
          kMagneticSigns[i] * Finite(newer.magnetic_field_S_counts[static_cast<Eigen::Index>(i)]);
      field[i] = static_cast<int>(std::clamp(std::round(counts), -2048.0, 2047.0)) & 0xfff;
    }
    report[0x26] = static_cast<std::uint8_t>(report[0x26] | field[0] >> 8);
    report[0x27] = static_cast<std::uint8_t>(field[0]);
    report[0x28] = static_cast<std::uint8_t>(field[1] >> 4);
    report[0x29] = static_cast<std::uint8_t>((field[1] & 0x0f) << 4 | field[2] >> 8);
    report[0x2a] = static_cast<std::uint8_t>(field[2]);
  }
  return {report};
}

std::uint32_t PsMove::sphere_rgb(std::int64_t now_ns) const {
  return lit_ && now_ns - lit_ns_ < kLightsLastNs ? rgb_ : 0;
}

std::uint8_t PsMove::rumble(std::int64_t now_ns) const {
  return lit_ && now_ns - lit_ns_ < kLightsLastNs ? rumble_ : 0;
}

}  // namespace footing::device_models

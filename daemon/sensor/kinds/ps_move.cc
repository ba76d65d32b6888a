#include "daemon/sensor/kinds/ps_move.h"

#include "common/stream/product_ids.h"

namespace footing::ps_move {
namespace {

constexpr std::uint8_t kRumble = 0xc0;
/// Pieces come in turn, not always from the first: twice round must bring them all.
constexpr int kRounds = 2;

}  // namespace

CalibrationHandshake::CalibrationHandshake(reports::MoveModel model,
                                           const std::optional<std::vector<std::uint8_t>>& stored)
    : model_(model), calibration_(calibration::DefaultMove(model)), blob_(model) {
  if (!stored) return;
  calibration_ = calibration::ParseMove(model, *stored);
  if (calibration_.origin != stream::CalibrationOrigin::kDevice) return;
  calibration_.origin = stream::CalibrationOrigin::kStored;
  settled_ = true;
  asking_ = false;
}

void CalibrationHandshake::AskAgain() {
  if (calibration_.origin == stream::CalibrationOrigin::kDevice) return;
  blob_ = calibration::MoveBlob(model_);
  asking_ = true;
  asked_ = false;
  refusals_ = answers_ = 0;
}

bool CalibrationHandshake::WantsFeature(std::int64_t now_ns) {
  if (!asking_) return false;
  if (asked_) {
    if (now_ns - asked_ns_ < kTimeoutNs) return false;
    Refuse();
    if (!asking_) return false;
  }
  asked_ = true;
  asked_ns_ = now_ns;
  return true;
}

void CalibrationHandshake::Refuse() {
  asked_ = false;
  if (++refusals_ < kMaxRefusals) return;
  asking_ = false;
  settled_ = true;
  if (calibration_.origin == stream::CalibrationOrigin::kDefaults) {
    calibration_.problem = "calibration not read; plug it in by USB once";
  }
}

bool CalibrationHandshake::TakeFeature(reports::Bytes feature) {
  if (!asking_ || !asked_) return false;
  if (feature.empty() || !blob_.Take(feature)) {
    Refuse();
    return false;
  }
  asked_ = false;
  const int most = kRounds * static_cast<int>(calibration::MoveBlobPieces(model_));
  if (!blob_.complete()) {
    if (++answers_ < most) return false;
    refusals_ = kMaxRefusals;
    Refuse();
    return false;
  }
  asking_ = false;
  settled_ = true;
  const auto read = calibration::ParseMove(model_, blob_.bytes());
  const bool good = read.origin == stream::CalibrationOrigin::kDevice;
  // A stored calibration is better than a blob that makes no sense.
  if (good || calibration_.origin == stream::CalibrationOrigin::kDefaults) calibration_ = read;
  return good;
}

std::optional<reports::OutputReport> CalibrationHandshake::NextOutput(std::int64_t now_ns,
                                                                      bool rumble) {
  const bool other = !sent_ || sphere_rgb_ != sent_rgb_ || rumble != sent_rumble_;
  const bool lit = sphere_rgb_ != 0 || rumble;
  const std::int64_t since_ns = now_ns - sent_ns_;
  if (sent_ && since_ns < kSpacingNs) return std::nullopt;
  if (!other && !(lit && since_ns >= kRepeatNs)) return std::nullopt;
  sent_ = true;
  sent_ns_ = now_ns;
  sent_rgb_ = sphere_rgb_;
  sent_rumble_ = rumble;
  return reports::MoveLights(sphere_rgb_, rumble ? kRumble : 0);
}

namespace {

bool SameReading(const reports::MoveSample& a, const reports::MoveSample& b) {
  return a.acceleration == b.acceleration && a.angular_velocity == b.angular_velocity &&
         a.trigger == b.trigger;
}

}  // namespace

std::optional<decode::Decoded> Decoder::Take(const calibration::MoveCalibration& calibration,
                                             reports::Bytes bytes) {
  const auto report = reports::DecodeMove(model_, bytes);
  if (!report) return std::nullopt;
  decode::Decoded decoded;
  for (std::size_t half = 0; half < report->sample_count; ++half) {
    const calibration::MoveReading reading = calibration::Calibrate(calibration, *report, half);
    stream::MotionSample& sample = decoded.motion.emplace_back();
    sample.specific_force_mps2 = reading.specific_force_S_mps2;
    sample.clipped_axes = reading.clipped_axes;
    sample.has_angular_velocity = true;
    sample.angular_velocity_radps = reading.angular_velocity_S_radps;
    sample.angular_velocity_clipped = reading.angular_velocity_clipped;
    sample.trigger = reading.trigger;
    sample.buttons = report->buttons;
    sample.uncalibrated = calibration.origin == stream::CalibrationOrigin::kDefaults;
    sample.gyroscope_uncalibrated = sample.uncalibrated;
    sample.has_magnetic_field = report->has_magnetic_field;
    sample.magnetic_field = calibration::MagneticField(*report);
    sample.temperature_c = reports::MoveTemperature(report->temperature);
    const bool same = last_ && SameReading(*last_, report->samples[half]);
    sample.repeated = same && report->buttons == last_buttons_;
    decoded.changed = decoded.changed || !same;
    last_ = report->samples[half];
    last_buttons_ = report->buttons;
  }
  battery_fraction_ = reports::MoveBatteryFraction(report->battery);
  return decoded;
}

namespace {

constexpr double kLowBattery = 0.21;  // One bar of five.

reports::MoveModel ModelOf(const decode::Product& product) {
  return product.product == stream::kProductZcm2 ? reports::MoveModel::kZcm2
                                                 : reports::MoveModel::kZcm1;
}

}  // namespace

bool PsMove::Matches(const decode::Product& product) {
  return product.vendor == stream::kVendorSony;
}

PsMove::PsMove(const decode::Product& product,
               const std::optional<std::vector<std::uint8_t>>& stored)
    : handshake_(ModelOf(product), stored), decoder_(ModelOf(product)) {}

std::optional<decode::Decoded> PsMove::Take(std::int64_t, reports::Bytes report, kinds::Outputs&) {
  if (!live()) return decode::Decoded();
  return decoder_.Take(handshake_.calibration(), report);
}

std::optional<decode::FeatureRequest> PsMove::NextFeature(std::int64_t now_ns) {
  if (!handshake_.WantsFeature(now_ns)) return std::nullopt;
  return decode::FeatureRequest{reports::kMoveCalibrationFeature,
                                reports::kMoveCalibrationFeatureBytes};
}

kinds::Stored PsMove::TakeFeature(reports::Bytes feature) {
  if (!handshake_.TakeFeature(feature)) return std::nullopt;
  return handshake_.blob();
}

bool PsMove::SetSphere(std::uint32_t rgb) {
  handshake_.set_sphere(rgb);
  return true;
}

void PsMove::AddTo(stream::DeviceStatus& status) const {
  Kind::AddTo(status);
  status.calibration = status.gyroscope_calibration = handshake_.calibration().origin;
  status.battery_fraction = decoder_.battery_fraction();
  status.battery_low = status.battery_fraction >= 0 && status.battery_fraction < kLowBattery;
  status.sphere_rgb = handshake_.sphere_rgb();
  status.extension = stream::Extension::kNone;
}

}  // namespace footing::ps_move

#include "daemon/sensor/kinds/calibration_handshake.h"

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
  // What is stored is better than a blob that makes no sense.
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

}  // namespace footing::ps_move

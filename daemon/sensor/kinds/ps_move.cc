#include "daemon/sensor/kinds/ps_move.h"

#include "common/stream/product_ids.h"

namespace footing::ps_move {
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

std::optional<decode::Decoded> PsMove::Take(reports::Bytes report) {
  if (!live()) return decode::Decoded();
  return decoder_.Take(handshake_.calibration(), report);
}

std::optional<decode::FeatureRequest> PsMove::NextFeature(std::int64_t now_ns) {
  if (!handshake_.WantsFeature(now_ns)) return std::nullopt;
  return decode::FeatureRequest{reports::kMoveCalibrationFeature,
                                reports::kMoveCalibrationFeatureBytes};
}

std::optional<std::vector<std::uint8_t>> PsMove::TakeFeature(reports::Bytes feature) {
  if (!handshake_.TakeFeature(feature)) return std::nullopt;
  return handshake_.blob();
}

void PsMove::AddTo(stream::DeviceStatus& status) const {
  status.calibration = status.gyroscope_calibration = handshake_.calibration().origin;
  status.battery_fraction = decoder_.battery_fraction();
  status.battery_low = status.battery_fraction >= 0 && status.battery_fraction < kLowBattery;
  status.sphere_rgb = handshake_.sphere_rgb();
  status.extension = stream::Extension::kNone;
}

}  // namespace footing::ps_move

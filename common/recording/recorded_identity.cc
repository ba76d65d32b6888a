#include "common/recording/recorded_identity.h"

#include "common/stream/product_ids.h"

namespace footing::recording {
namespace {

constexpr char kMoveData = 0x01;

}  // namespace

RecordedIdentity IdentityOf(const v1::DeviceStatus& status) {
  RecordedIdentity identity{status.bus(), status.vendor(), status.product(), status.name(),
                            status.serial()};
  if (identity.vendor != 0) return identity;
  const bool move = status.kind() == v1::DEVICE_KIND_PS_MOVE;
  const bool inside = status.name().ends_with("-TR");
  identity.bus = static_cast<std::uint32_t>(stream::Bus::kBluetooth);
  identity.vendor = move ? stream::kVendorSony : stream::kVendorNintendo;
  // A PS Move of the second type was never recorded without its product.
  identity.product = move     ? stream::kProductZcm1
                     : inside ? stream::kProductTr
                              : stream::kProductFirst;
  return identity;
}

bool IsFeature(const v1::RawReport& report, const v1::DeviceStatus& status) {
  if (report.feature()) return true;
  const bool move = status.kind() == v1::DEVICE_KIND_PS_MOVE;
  return move && !report.to_device() &&
         (report.report().empty() || report.report()[0] != kMoveData);
}

}  // namespace footing::recording

#include "common/recording/recorded_identity.h"

namespace footing::recording {
namespace {

constexpr std::uint32_t kBluetooth = 5;
constexpr std::uint32_t kNintendo = 0x057e;
constexpr std::uint32_t kWiimote = 0x0306;        // And every Balance Board.
constexpr std::uint32_t kWiimoteInside = 0x0330;  // With MotionPlus inside: "...-TR".
constexpr std::uint32_t kSony = 0x054c;
constexpr std::uint32_t kMoveFirst = 0x03d5;  // The second type was never recorded without it.
constexpr char kMoveData = 0x01;

}  // namespace

RecordedIdentity IdentityOf(const v1::DeviceStatus& status) {
  RecordedIdentity identity{status.bus(), status.vendor(), status.product(), status.name(),
                            status.serial()};
  if (identity.vendor != 0) return identity;
  const bool move = status.kind() == v1::DEVICE_KIND_PS_MOVE;
  const bool inside = status.name().ends_with("-TR");
  identity.bus = kBluetooth;
  identity.vendor = move ? kSony : kNintendo;
  identity.product = move ? kMoveFirst : inside ? kWiimoteInside : kWiimote;
  return identity;
}

bool IsFeature(const v1::RawReport& report, const v1::DeviceStatus& status) {
  if (report.feature()) return true;
  const bool move = status.kind() == v1::DEVICE_KIND_PS_MOVE;
  return move && !report.to_device() &&
         (report.report().empty() || report.report()[0] != kMoveData);
}

}  // namespace footing::recording

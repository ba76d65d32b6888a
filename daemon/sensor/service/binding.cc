#include "daemon/sensor/service/binding.h"

#include <algorithm>
#include <span>

#include "common/base/lines.h"
#include "common/base/utf8.h"

namespace footing::sensor {
namespace {

using decode::Placement;
using stream::DeviceRole;

constexpr std::size_t kMaxRigBytes = 64;

constexpr DeviceRole kBodyRoles[] = {DeviceRole::kLeftHand, DeviceRole::kRightHand,
                                     DeviceRole::kLeftLeg,  DeviceRole::kRightLeg,
                                     DeviceRole::kHead,     DeviceRole::kTrunk};
constexpr DeviceRole kBoardRoles[] = {DeviceRole::kLeftBoard, DeviceRole::kRightBoard};

std::span<const DeviceRole> RolesOf(Placement placement) {
  switch (placement) {
    case Placement::kOnBody:
      return kBodyRoles;
    case Placement::kUnderFeet:
      return kBoardRoles;
    case Placement::kInBothHands:
      break;
  }
  return {};
}

}  // namespace

Result<void> CheckRig(const std::string& rig) {
  if (!rig.empty() && rig.size() <= kMaxRigBytes && text::IsPrintable(rig)) return {};
  return UsageError("the rig's name " + text::Quoted(rig) + " must be 1 to " +
                    std::to_string(kMaxRigBytes) + " bytes without control characters");
}

Result<Binding> ParseBinding(const std::string& text) {
  const std::size_t slash = text.rfind('/');  // A rig's name may have one, a role's has none.
  if (slash == std::string::npos || slash == 0) {
    return UsageError("role " + text::Quoted(text) +
                      " is not of the form rig/role, e.g. main/left_hand");
  }
  const std::string rig = text.substr(0, slash), name = text.substr(slash + 1);
  if (const auto checked = CheckRig(rig); !checked) return checked.error();
  const DeviceRole role = stream::RoleNamed(name);
  if (role == DeviceRole::kUnspecified) {
    return UsageError("role " + text::Quoted(name) + " does not exist; there are " +
                      stream::RoleNames());
  }
  return Binding{rig, role};
}

std::string ToText(const Binding& binding) {
  return binding.rig + "/" + stream::Name(binding.role);
}

DeviceRole FirstFreeRole(Placement placement, const std::string& rig,
                         const std::vector<Binding>& taken) {
  for (const DeviceRole role : RolesOf(placement)) {
    if (std::find(taken.begin(), taken.end(), Binding{rig, role}) == taken.end()) return role;
  }
  return DeviceRole::kUnspecified;
}

bool RoleFits(Placement placement, DeviceRole role) {
  if (role == DeviceRole::kUnspecified) return true;
  if (placement == Placement::kInBothHands) return role == DeviceRole::kEditor;
  const bool of_board = role == DeviceRole::kLeftBoard || role == DeviceRole::kRightBoard;
  return of_board == (placement == Placement::kUnderFeet);
}

}  // namespace footing::sensor

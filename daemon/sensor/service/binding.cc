#include "daemon/sensor/service/binding.h"

#include <algorithm>
#include <span>

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

Result<Binding> ParseBinding(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || slash == 0 || slash > kMaxRigBytes) {
    return UsageError("role \"" + text + "\" is not of the form rig/role, e.g. main/left_hand");
  }
  const DeviceRole role = stream::RoleNamed(text.substr(slash + 1));
  if (role == DeviceRole::kUnspecified) {
    return UsageError("role \"" + text.substr(slash + 1) + "\" does not exist; there are " +
                      stream::RoleNames());
  }
  return Binding{text.substr(0, slash), role};
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

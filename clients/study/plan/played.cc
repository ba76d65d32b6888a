#include "clients/study/plan/played.h"

#include "common/stream/interface_roles.h"
#include "common/stream/leg_turn.h"

namespace footing::study::plan {

std::vector<stream::DeviceRole> RolesOf(const Played& played) {
  return stream::RolesOf(stream::UserInterfaceNamed(played.interface),
                         stream::LegTurnSourceNamed(played.turn_by));
}

}  // namespace footing::study::plan

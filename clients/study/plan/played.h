#pragma once

#include <string>
#include <vector>

#include "common/stream/device.h"

namespace footing::study::plan {

/// What a participant commands the character with.
struct Played {
  std::string interface;         ///< Name of a stream::UserInterface.
  std::string turn_by = "head";  ///< Of the interface leg: head, trunk or feet.
};

/// The roles of its devices, as stream::RolesOf.
std::vector<stream::DeviceRole> RolesOf(const Played& played);

}  // namespace footing::study::plan

#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"

namespace footing::motion {

/// A motion of the standard person's layout (body::StandardPerson), which is what the engine runs.
struct StandardMotion {
  Motion motion;
  double height_m = 0;  ///< Estimated from the lengths.
  double rms_m = 0;     ///< Of the markers below.
};

/// True when the motion's degrees of freedom are the standard person's, by number and name.
bool HasStandardLayout(const Motion& motion);
bool IsStandardLayout(const std::vector<std::string>& dofs);

/// Another skeleton's motion as the standard person's: markers are put about its joints and fitted
/// (FitMarkers), so that lengths and joint centres stay. An error says which landmark is
/// missing.
Result<StandardMotion> ToStandardLayout(const Motion& motion);

}  // namespace footing::motion

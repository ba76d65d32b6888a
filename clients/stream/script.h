#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/devices/hand_motion.h"

namespace footing::stream_client {

/// Names of the built-in scripts.
std::vector<std::string> ScriptNames();

/// The built-in script of that name; a usage error that lists the names when there is none.
Result<std::vector<wrists::Segment>> ScriptNamed(const std::string& name);

/// A script from JSON: a list of objects {duration_s, frequency_hz, phase_deg, amplitude_mps2,
/// roll_deg, pitch_deg}, all but duration_s optional. `origin` names it in errors, which say which
/// stretch and what its values may be.
Result<std::vector<wrists::Segment>> ParseScript(const std::string& text,
                                                 const std::string& origin);

}  // namespace footing::stream_client

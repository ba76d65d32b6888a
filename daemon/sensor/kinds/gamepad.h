#pragma once

#include <cstdint>

#include "common/stream/sensor.h"
#include "daemon/sensor/reports/extension.h"

namespace footing::decode {

/// Bits of stream::GamepadButton from those of reports::ClassicButton.
std::uint32_t GamepadButtons(std::uint16_t classic_buttons);

/// By the nominal ranges of the sticks (6 bits left, 5 bits right, 0 in the middle) and triggers.
stream::GamepadSample ToGamepad(const reports::ClassicCounts& counts);

/// Other than repeated and the stamps.
bool SameReading(const stream::GamepadSample& a, const stream::GamepadSample& b);

}  // namespace footing::decode

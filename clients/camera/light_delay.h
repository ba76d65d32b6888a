#pragma once

#include <cstdint>

namespace footing::camera {

/// How long after footingd's answer a frame may still show the light before: footingd sends a
/// Move's light ten times a second at most; then come the radio and an exposure.
inline constexpr std::int64_t kLightDelayNs = 400'000'000;

}  // namespace footing::camera

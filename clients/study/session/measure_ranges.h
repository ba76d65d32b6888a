#pragma once

#include <string>

#include "clients/study/session/range_feed.h"
#include "clients/study/session/console.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::study {

/// Prompts a person through the motions of an interface, in about 20 s (boards: 33 s), and measures
/// them live: NoDevice before the first prompt when footingd or a device is not there, a failure
/// with the motion to repeat when one was too small or too short.
Result<RecordedRanges> MeasureRanges(Console& console, const transport::Address& sensor,
                                     const std::string& rig, const ranges::Played& played);

}  // namespace footing::study

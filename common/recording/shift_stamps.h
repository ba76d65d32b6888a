#pragma once

#include <google/protobuf/message.h>

#include <cstdint>

namespace footing::playback {

/// Moves every instant of a server's clock in the message by `shift_ns`: the int64 fields, at any
/// depth, whose names end in _ns, except those of other clocks (age_ns, true_ns, wall_time_ns).
/// Zero means unknown and stays, and so does what no clock comes to. `shift_ns` is the difference
/// of two instants.
void ShiftStamps(google::protobuf::Message& message, std::int64_t shift_ns);

}  // namespace footing::playback

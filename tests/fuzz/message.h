#pragma once

#include <google/protobuf/message.h>

#include "tests/fuzz/input.h"

namespace footing::fuzz {

/// Sets fields of the message, of any type, as the input says: among them numbers that are not
/// finite, enum values that do not exist, and many of what is repeated. All text is ASCII.
void Fill(Input& input, google::protobuf::Message& message, int depth = 0);

/// Whether every number in the message is finite.
bool IsFinite(const google::protobuf::Message& message);

}  // namespace footing::fuzz

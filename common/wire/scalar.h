#pragma once

#include <string>

/// The two rules that every field follows on its way out.
namespace footing::wire {

/// The value itself, or 0 when it is not finite.
double Finite(double value);

/// The text with every byte that is not part of valid UTF-8 replaced by '?': device names and
/// serials are whatever the device says, and a message with an invalid string cannot be read.
std::string Utf8(const std::string& text);

}  // namespace footing::wire

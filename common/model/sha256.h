#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace footing::model {

using Digest = std::array<std::uint8_t, 32>;

/// SHA-256 of the bytes (FIPS 180-4, section 6.2): distinguishes a damaged file from a whole one,
/// and one data file from another.
Digest Sha256(std::string_view bytes);

/// In lower-case hexadecimal, as sha256sum prints it.
std::string Hex(const Digest& digest);

}  // namespace footing::model

#pragma once

#include <cstdint>
#include <string_view>

namespace footing::mcap {

/// CRC-32 (IEEE 802.3, as zlib's) of the bytes so far and `bytes` behind them; start with 0.
std::uint32_t Crc32(std::uint32_t so_far, std::string_view bytes);

}  // namespace footing::mcap

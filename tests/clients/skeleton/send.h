#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "clients/skeleton/tracking/decoder.h"

namespace footing::skeleton {

/// Gives a decoder packets that arrive at once.
inline void Send(Decoder& decoder, const std::vector<std::string>& packets, std::int64_t now_ns,
                 std::vector<Decoded>& complete) {
  osc::Packet packet;
  for (const std::string& bytes : packets) {
    ASSERT_TRUE(osc::Read(osc::AsBytes(bytes), packet));
    decoder.Take(packet, now_ns, complete);
  }
}

}  // namespace footing::skeleton

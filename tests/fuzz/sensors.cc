#include "clients/stream/sensor_packets.h"

#include <cmath>
#include <cstring>

#include "tests/fuzz/input.h"

// Packets of sensors of the network, from one of two senders: a byte of time (milliseconds) and
// sender, then the packet. What is made of them are reports as footingd takes them, and finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  stream_client::SensorPackets packets;
  std::int64_t now_ns = 1'000'000'000;
  while (!input.empty()) {
    const std::uint8_t how = input.Byte();
    now_ns += (how & 0x7f) * 1'000'000;
    const fuzz::Bytes bytes = input.String();
    const auto packet = packets.Take((how & 0x80) != 0 ? "a" : "b", now_ns, bytes);
    fuzz::Expect(packet.replies.size() <= 2 + bytes.size() / 3);
    for (const std::string& reply : packet.replies) fuzz::Expect(reply.size() <= 64);
    const bool is_own = !bytes.empty() && bytes[0] == 1;  // Passed on as it is.
    for (const auto& one : packet.reports) {
      fuzz::Expect(one.report.size() >= 43 && one.report[0] == 1);
      if (is_own) continue;
      float numbers[6];
      std::memcpy(numbers, one.report.data() + 19, sizeof(numbers));
      for (const float number : numbers) fuzz::Expect(std::isfinite(number));
    }
  }
  return 0;
}

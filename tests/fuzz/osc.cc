#include "clients/skeleton/osc/osc.h"

#include <string>
#include <vector>

#include "clients/skeleton/dialects/decoder.h"
#include "clients/skeleton/gates/person_gate.h"
#include "tests/fuzz/input.h"

// Any bytes as packets of a sender of skeletons: each is read or rejected; what is read is written
// and read again as the same; what comes out of decoder and gate is finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  skeleton::Decoder decoder({});
  skeleton::PersonGate gate;
  osc::Packet packet, again;
  std::int64_t now_ns = 0;
  while (!input.empty()) {
    // A byte of length and of how many more such lengths of bytes follow.
    const std::uint8_t blocks = input.Byte() % 16;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i <= blocks; ++i) {
      const fuzz::Bytes block = input.String();
      bytes.insert(bytes.end(), block.begin(), block.end());
    }
    now_ns += 7'000'000;
    if (!osc::Read(bytes, packet)) continue;
    for (const osc::Message& message : packet.messages) {
      const auto arguments = packet.Of(message);
      const std::string written = osc::WriteMessage(message.address, arguments);
      fuzz::Expect(osc::Read(osc::AsBytes(written), again).ok());
      fuzz::Expect(again.messages.size() == 1 && again.messages[0].address == message.address);
      fuzz::Expect(osc::WriteMessage(message.address, again.Of(again.messages[0])) == written);
    }
    std::vector<skeleton::Decoded> complete;
    decoder.Take(packet, now_ns, complete);
    decoder.Flush(now_ns, complete);
    for (const skeleton::Decoded& one : complete)
      for (const auto& joint : gate.Advance(one.skeleton, now_ns).skeleton.joints)
        fuzz::Expect(joint.p_K_m.allFinite() && joint.confidence >= 0 && joint.confidence <= 1);
  }
  return 0;
}

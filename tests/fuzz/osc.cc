#include "common/base/osc.h"

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "clients/skeleton/tracking/decoder.h"
#include "clients/skeleton/tracking/person_gate.h"
#include "tests/fuzz/input.h"

namespace {

using namespace footing;  // NOLINT: a fuzz target is one file

skeleton::DialectOptions OptionsOf(std::uint8_t byte) {
  skeleton::DialectOptions options;
  options.flip_y = (byte & 1) != 0;
  options.mirrored = (byte & 2) != 0;
  if ((byte & 4) != 0) options.factor = {0.5, -2, 1};
  if ((byte & 8) != 0) options.offset = {0, 0.25, -1};
  options.units = static_cast<skeleton::Units>((byte >> 4) % 5);
  return options;
}

/// Checks that a place, as a sender of the dialect would send it, comes back as that place.
void CheckRoundTrip(skeleton::Dialect dialect, const skeleton::DialectOptions& options,
                    const Eigen::Vector3d& p_K_m) {
  if (!(p_K_m.norm() < 1e6)) return;
  const Eigen::Vector3d numbers = skeleton::FromCamera(dialect, options, p_K_m);
  const Eigen::Vector3d again = skeleton::ToCamera(dialect, options, numbers);
  fuzz::Expect((again - p_K_m).norm() <= 1e-6 * (1 + p_K_m.norm()));
}

/// A time comes back within the nanosecond to which it is rounded.
void CheckTime(osc::TimeTag tag) {
  const std::int64_t unix_ns = osc::ToUnixNs(tag);
  fuzz::Expect(std::abs(osc::ToUnixNs(osc::ToTimeTag(unix_ns)) - unix_ns) <= 1);
}

/// The names of an option: as many bytes as there are of one, or any.
void CheckNames(fuzz::Bytes bytes) {
  const std::string_view name(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (const auto dialect = skeleton::DialectOf(name)) {
    fuzz::Expect(skeleton::NameOf(*dialect) == name);
  }
  if (const auto units = skeleton::UnitsOf(name)) fuzz::Expect(skeleton::NameOf(*units) == name);
}

}  // namespace

// The first byte chooses options; then any bytes as packets of a sender of skeletons: each is read
// or rejected; what is read is written and read again as the same; what comes out of decoder and
// gate is finite.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const skeleton::DialectOptions options = OptionsOf(input.Byte());
  skeleton::Decoder decoder(options);
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
    CheckNames(bytes);
    if (!osc::Read(bytes, packet)) continue;
    for (const osc::Message& message : packet.messages) {
      CheckTime(message.time);
      const auto arguments = packet.Of(message);
      const std::string written = osc::WriteMessage(message.address, arguments);
      fuzz::Expect(osc::Read(osc::AsBytes(written), again).ok());
      fuzz::Expect(again.messages.size() == 1 && again.messages[0].address == message.address);
      fuzz::Expect(osc::WriteMessage(message.address, again.Of(again.messages[0])) == written);
    }
    std::vector<skeleton::Decoded> complete;
    decoder.Take(packet, now_ns, complete);
    decoder.Flush(now_ns, complete);
    for (const skeleton::Decoded& one : complete) {
      for (const auto& joint : one.skeleton.joints) {
        CheckRoundTrip(one.dialect, options, joint.p_K_m);
      }
      for (const auto& joint : gate.Advance(one.skeleton, now_ns).skeleton.joints)
        fuzz::Expect(joint.p_K_m.allFinite() && joint.confidence >= 0 && joint.confidence <= 1);
    }
  }
  return 0;
}

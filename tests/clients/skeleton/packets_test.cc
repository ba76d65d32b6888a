#include <gtest/gtest.h>

#include <cstdlib>

#include "clients/skeleton/tracking/decoder.h"
#include "clients/skeleton/tracking/dialects.h"
#include "clients/skeleton/tracking/person_gate.h"
#include "common/virtual/devices/noise.h"
#include "tests/clients/skeleton/clips.h"

namespace footing::skeleton {
namespace {

/// Packets of senders of every dialect, of which the packets below are damaged copies.
std::vector<std::string> Sound() {
  std::vector<std::string> packets;
  Skeleton person = Standing();
  person.sent_ns = 5'000'000;
  person.sequence = 7;
  for (const Dialect dialect : {Dialect::kSensebloom, Dialect::kQuartz, Dialect::kZillode,
                                Dialect::kKinectSdk2, Dialect::kFooting})
    for (std::string& packet : Encode(dialect, {}, person)) packets.push_back(std::move(packet));
  const osc::Argument bone[] = {std::string_view("LeftHand"), 0.f, 0.1f, 0.f, 0.f, 0.f, 0.f, 1.f};
  packets.push_back(osc::WriteMessage("/VMC/Ext/Bone/Pos", bone));
  const osc::Argument body[] = {0.1f, 0.2f, 2.f, std::string_view("Inferred")};
  packets.push_back(osc::WriteMessage("/bodies/72057594037928017/joints/HandLeft", body));
  return packets;
}

/// One to four changes: a byte, a bit, the end cut off, a piece of another packet, or bytes added.
std::string Damaged(const std::vector<std::string>& sound, noise::Random& random) {
  const auto any = [&](std::size_t count) {
    return static_cast<std::size_t>(random.Integer(0, static_cast<int>(count) - 1));
  };
  std::string packet = sound[any(sound.size())];
  for (int changes = random.Integer(1, 4); changes > 0 && !packet.empty(); --changes) {
    const std::size_t at = any(packet.size());
    switch (random.Integer(0, 4)) {
      case 0:
        packet[at] = static_cast<char>(random.Integer(0, 255));
        break;
      case 1:
        packet[at] = static_cast<char>(packet[at] ^ (1 << random.Integer(0, 7)));
        break;
      case 2:
        packet.resize(at);
        break;
      case 3: {
        const std::string& other = sound[any(sound.size())];
        packet = packet.substr(0, at) + other.substr(any(other.size()));
        break;
      }
      default:
        packet.insert(at, static_cast<std::size_t>(random.Integer(1, 8)), '\0');
    }
  }
  return packet;
}

TEST(Packets, DamagedOnesAreReadOrRejectedAndGiveNothingThatIsNotFinite) {
  const int count = std::getenv("FOOTING_LONG") != nullptr ? 10'000'000 : 50'000;
  const auto sound = Sound();
  noise::Random random(1);
  Decoder decoder({});
  PersonGate gate;
  osc::Packet packet;
  std::vector<Decoded> complete;
  std::int64_t now_ns = 0;
  int read = 0, people = 0;
  for (int i = 0; i < count; ++i) {
    now_ns += 1'000'000;
    const std::string bytes = Damaged(sound, random);
    if (!osc::Read(osc::AsBytes(bytes), packet)) continue;
    ++read;
    complete.clear();
    decoder.Take(packet, now_ns, complete);
    decoder.Flush(now_ns, complete);
    for (const Decoded& one : complete) {
      ++people;
      for (const JointReading& joint : gate.Advance(one.skeleton, now_ns).skeleton.joints)
        ASSERT_TRUE(joint.p_K_m.allFinite() && joint.confidence >= 0 && joint.confidence <= 1) << i;
    }
  }
  // Some of each, or the damage would test one path only.
  EXPECT_GT(read, count / 20);
  EXPECT_LT(read, count * 19 / 20);
  EXPECT_GT(people, count / 200);
}

}  // namespace
}  // namespace footing::skeleton

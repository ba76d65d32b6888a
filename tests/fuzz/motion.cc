#include <string>
#include <string_view>

#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "tests/fuzz/input.h"

// Any bytes as each kind of motion file: read or refused, and what is read can be written.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::Input input(data, size);
  const std::uint8_t kind = input.Byte();
  const fuzz::Bytes bytes = input.Rest();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  switch (kind % 6) {
    case 0: {
      const auto motion = motion::ParseBvh(text, "f");
      if (!motion) break;
      const std::string once = motion::WriteBvh(*motion);
      fuzz::Expect(!once.empty());
      break;
    }
    case 1: {
      const auto asf = motion::ParseAsf(text, "f");
      if (asf) fuzz::Expect(asf->skeleton.size() > 0);
      break;
    }
    case 2: {
      static const auto asf = motion::ParseAsf(
          ":bonedata\nbegin\nname a\nlength 1\ndirection 0 1 0\ndof rx ry\nend\n:hierarchy\nroot "
          "a\n",
          "s");
      const auto motion = motion::ParseAmc(text, "f", *asf);
      if (motion) fuzz::Expect(motion->q.allFinite());
      break;
    }
    case 3: {
      const auto tracks = motion::ParseTrc(text, "f");
      if (tracks) fuzz::Expect(!motion::WriteTrc(*tracks, "f").empty());
      break;
    }
    case 4: {
      const auto table = motion::ParseTable(text, "f");
      if (!table) break;
      fuzz::Expect(table->values.allFinite());
      fuzz::Expect(!motion::WriteTable(*table).empty());
      static_cast<void>(motion::ToGroundForces(*table, "f"));
      break;
    }
    default: {
      const auto c3d = motion::ParseC3d(bytes, "f");
      if (c3d) static_cast<void>(motion::ToGroundForces(*c3d, "f"));
      break;
    }
  }
  return 0;
}

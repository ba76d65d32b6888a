#include "tests/simulation/engine/extension_walk.h"

namespace footing::engine {
namespace {

/// [0, 1), the same for the same two numbers.
double Drawn(std::uint64_t i, std::uint64_t what) {
  std::uint64_t x = 1000 * i + what + 0x9e3779b97f4a7c15u;  // splitmix64
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((x ^ (x >> 31)) >> 11) / 9007199254740992.0;
}

/// Random ground up to the limits of what may be added, but for curves, which would soon run into
/// older ground: they swing from side to side.
terrain::NewSegment RoughCourse(int i) {
  const auto drawn = [i](std::uint64_t what) {
    return 2 * Drawn(static_cast<std::uint64_t>(i), what) - 1;
  };
  return {.length_m = 2.5 + 0.5 * drawn(0),
          .slope_rad = DegreesToRadians(5 * drawn(1)),
          .curve_rad = DegreesToRadians(12 * std::sin(0.35 * i) + 3 * drawn(2)),
          .step_m = 0.1 * drawn(3)};
}

TEST(LongExtension, TwoHundredGentleSegments) { ExpectAWalkWithoutAFall({}); }

TEST(LongExtension, TwoHundredRoughSegments) {
  for (const double speed_mps : {0.8, 1.4, 1.75}) {
    SCOPED_TRACE(speed_mps);
    ExpectAWalkWithoutAFall({.course = RoughCourse, .speed_mps = speed_mps});
  }
}

}  // namespace
}  // namespace footing::engine

#include "common/stream/setup.h"

namespace footing::stream {
namespace {

constexpr double kGapM = 0.02;
constexpr double kQuarterTurnRad = 1.57079632679489661923;

}  // namespace

BoardLayout DefaultLayout() {
  BoardLayout layout;
  layout.preset = "one_foot_each";
  layout.gap_mm = kGapM * 1e3;
  layout.left = {0, (kPlateShortM + kGapM) / 2, -kQuarterTurnRad};
  layout.right = {0, -(kPlateShortM + kGapM) / 2, kQuarterTurnRad};
  return layout;
}

}  // namespace footing::stream

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/options/load.h"
#include "daemon/offline/learning/time_alignment.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::learning {
namespace {

constexpr double kMassKg = 60;
constexpr double kPlatesAlignmentWeightN = kMassKg * kStandardGravityMps2;

struct Traces {
  ForceTrace plates, moved;
};

ForceTrace Empty(const std::string& name) {
  ForceTrace trace;
  trace.name = name;
  trace.weight_n = kPlatesAlignmentWeightN;
  trace.load_n.resize(2, 0);
  return trace;
}

void Append(const Eigen::Vector2d& load_n, bool valid, ForceTrace& trace) {
  trace.load_n.conservativeResize(2, trace.load_n.cols() + 1);
  trace.load_n.rightCols<1>() = load_n;
  trace.valid.push_back(valid);
}

/// One trial of the subject behind what is there: what the plates felt (nothing is known while the
/// subject stands on a box beside them) and what the markers' motion makes of it.
void AddTrial(const std::string& trial, Traces& traces) {
  const std::string folder = motion::test::SharedData() + "/forces/opencap_s4/";
  const auto loaded = motion_files::LoadMotion(folder + "MarkerData/" + trial + ".trc",
                                               {.still = folder + "MarkerData/static1.trc"});
  const auto forces = motion_files::LoadForces(folder + "ID/" + trial + "_grf.mot");
  ASSERT_TRUE(loaded && forces);
  body::PersonParameters person;
  person.mass_kg = kMassKg;
  person.height_m = loaded->height_m;
  const auto body = body::MakeBody(loaded->motion.skeleton, person).value();
  const auto course = virtual_sensors::Follow(body, motion::Continuous(loaded->motion));
  const auto reaction = virtual_sensors::React(course);
  bool landed = false;
  for (Eigen::Index i = 0; i < course.frames(); ++i) {
    const auto feet = virtual_sensors::ShareBetweenFeet(course, reaction, i);
    Append({feet[0].load_n, feet[1].load_n}, true, traces.moved);
    const double at_s = loaded->motion.start_s + static_cast<double>(i) / course.rate_hz;
    const auto k = std::clamp<Eigen::Index>(std::lround((at_s - forces->start_s) * forces->rate_hz),
                                            0, forces->plates[0].force_W.cols() - 1);
    Eigen::Vector2d load_n = Eigen::Vector2d::Zero();
    for (std::size_t plate = 0; plate < forces->plates.size(); ++plate)
      load_n(plate == 0 ? 0 : 1) += forces->plates[plate].force_W(2, k);
    if (!landed && load_n.sum() > 0.1 * kPlatesAlignmentWeightN) {
      landed = true;
      const auto before = std::min<std::ptrdiff_t>(45, std::ssize(traces.plates.valid));
      if (i >= before)
        std::fill(traces.plates.valid.end() - before, traces.plates.valid.end(), true);
    }
    Append(load_n, landed, traces.plates);
  }
}

/// Nothing was chosen on these trials. Measured when it was written: 8 ms off, residual 6 ms,
/// correlation 0.94, four landings in both.
TEST(AlignInTime, PutsRealPlatesAndMarkersOnOneClock) {
  SKIP_WITHOUT_SHARED_DATA();
  Traces traces{Empty("plates"), Empty("markers")};
  for (const char* trial : {"squats1", "DJ1", "DJ2"}) AddTrial(trial, traces);
  // GIVEN plates that were switched on two seconds later.
  constexpr Eigen::Index kLate = 200;
  traces.plates.load_n =
      Eigen::Matrix2Xd(traces.plates.load_n.rightCols(traces.plates.load_n.cols() - kLate));
  traces.plates.valid.erase(traces.plates.valid.begin(), traces.plates.valid.begin() + kLate);
  const auto at = AlignInTime(traces.plates, traces.moved);
  ASSERT_TRUE(at) << at.error().message;
  EXPECT_NEAR(at->ToRecording(10), 8, 0.010);  // A frame of the markers.
  EXPECT_GT(at->correlation, 0.9);
  EXPECT_GE(at->stomps_both, 3);
}

}  // namespace
}  // namespace footing::learning

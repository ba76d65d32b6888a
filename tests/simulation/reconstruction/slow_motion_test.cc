#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "common/body/kinematics.h"
#include "common/runtime/files.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/standard_layout.h"
#include "common/virtual/options/load.h"
#include "common/wire/model_file.h"
#include "tests/simulation/reconstruction/made_person.h"

// A recorded person in slow motion: the loads change by a few per cent, and the hands hardly show
// how low the body is.
namespace footing::reconstruction {
namespace {

struct SlowClip {
  const char* trial;
  double times;  // As long as it was recorded.
};

std::ostream& operator<<(std::ostream& out, const SlowClip& clip) {
  return out << clip.trial << " times " << clip.times;
}

class SlowMotion : public testing::TestWithParam<SlowClip> {};

virtual_sensors::Scene SceneOf(const std::string& folder, const SlowClip& slow) {
  const std::string markers = folder + "/forces/opencap_s4/MarkerData/";
  motion_files::LoadOptions load;
  load.still = markers + "static1.trc";
  auto loaded = motion_files::LoadMotion(markers + slow.trial + ".trc", load).value();
  motion::Motion clip = motion::WithLandmarksOnly(loaded.motion).value();
  body::PersonParameters person;
  person.mass_kg = 60;
  person.height_m = loaded.height_m;
  if (!motion::HasStandardLayout(clip)) {
    auto standard = motion::ToStandardLayout(clip).value();
    clip = std::move(standard.motion);
    person.height_m = standard.height_m;
  }
  clip.rate_hz /= slow.times;
  return virtual_sensors::MakeScene(std::move(clip), person, {}, slow.trial).value();
}

Models BundledModels() {
  const std::string bytes = config::ReadDataFile("pose.fmodel").value();
  return MakeModels({{"pose.fmodel", wire::FromModelFile(bytes, "pose.fmodel").value()}}).value();
}

TEST_P(SlowMotion, HasTheHeightOfTheLoadsOrIsNotValid) {
  const char* folder = std::getenv("FOOTING_TEST_DATA");
  if (folder == nullptr || *folder == '\0') GTEST_SKIP() << "needs FOOTING_TEST_DATA";
  const virtual_sensors::Scene scene = SceneOf(folder, GetParam());
  Options options;
  options.rate_hz = scene.motion.rate_hz;
  auto reconstruction = Reconstruction::Create(scene.body, BundledModels(), options).value();
  const std::vector<Inputs> inputs = Measured(scene.body, scene.motion, 0.01);
  body::Kinematics at(scene.body.skeleton);
  double square_m2 = 0;
  int valid = 0, all = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Output& output = reconstruction.Advance(inputs[i]);
    if (static_cast<double>(i) < options.rate_hz * kMadeStandS) continue;
    ++all;
    if (!output.valid || !output.momentum.trusted) continue;
    ++valid;
    body::ComputeKinematics(scene.body.skeleton, scene.motion.q.col(static_cast<Eigen::Index>(i)),
                            at);
    const double error_m = output.momentum.p_WC_m.z() - body::CentreOfMass(scene.body, at).z();
    square_m2 += error_m * error_m;
  }
  EXPECT_LT(std::sqrt(square_m2 / valid), 0.05);  // squats1 at half speed has 0.045.
  EXPECT_GT(valid, 0.7 * all);
}

INSTANTIATE_TEST_SUITE_P(OpenCap, SlowMotion,
                         testing::Values(SlowClip{"squats1", 1.5}, SlowClip{"squats1", 2},
                                         SlowClip{"STS1", 1.5}, SlowClip{"STS1", 2}));

}  // namespace
}  // namespace footing::reconstruction

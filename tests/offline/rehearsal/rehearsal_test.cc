#include "daemon/offline/rehearsal/rehearsal.h"

#include <gtest/gtest.h>

#include "common/body/points.h"

namespace footing::rehearsal {
namespace {

/// Stands in a T-pose all the time.
motion::Motion Standing(double seconds) {
  motion::Motion motion;
  motion.skeleton = body::StandardPerson(1.75);
  const body::Landmarks landmarks = body::FindLandmarks(motion.skeleton).value();
  motion.rate_hz = 60;
  motion.q = body::TPose(motion.skeleton, landmarks)
                 .replicate(1, static_cast<Eigen::Index>(seconds * motion.rate_hz));
  return motion;
}

Rehearsal Rehearsed(const Settings& settings) {
  return Rehearse(Standing(4), settings, "standing").value();
}

TEST(Rehearsal, TheCellsCarryTheBody) {
  Settings settings;
  settings.mass_kg = 80;
  const Rehearsal rehearsal = Rehearsed(settings);
  ASSERT_GT(rehearsal.frames.size(), 600u);
  for (const Frame& frame : {rehearsal.frames[100], rehearsal.frames.back()}) {
    const auto pressure = momentum::PressureOf(frame.inputs.loads, 10);
    EXPECT_NEAR(pressure.total_n, 80 * 9.80665, 1);
    EXPECT_NEAR((pressure.p_WP_m - frame.com_m).head<2>().norm(), 0, 0.005);
    EXPECT_NEAR(frame.feet[0].load_n + frame.feet[1].load_n, pressure.total_n, 1);
  }
}

TEST(Rehearsal, TheHandsAreWhereTheFistsAreButForTheirNoise) {
  Settings settings;
  settings.hand_noise_m = 0.02;
  const Rehearsal rehearsal = Rehearsed(settings);
  body::Kinematics at(rehearsal.body.skeleton);
  double sum = 0;
  for (const Frame& frame : rehearsal.frames) {
    body::ComputeKinematics(rehearsal.body.skeleton, frame.q, at);
    const body::Point fist = body::Fist(rehearsal.body, 1);
    const auto joint = static_cast<std::size_t>(fist.joint);
    ASSERT_TRUE(frame.inputs.hands[1].valid);
    sum += (frame.inputs.hands[1].p_W_m - body::Place(fist, at.R_WJ[joint], at.p_WJ[joint]))
               .squaredNorm();
  }
  // Three axes of 2 cm each.
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(rehearsal.frames.size()) / 3), 0.02, 0.002);
  settings.hands = false;
  EXPECT_FALSE(Rehearsed(settings).frames[0].inputs.hands[0].valid);
}

TEST(Rehearsal, ErrorsOfTheLayoutMoveWhereTheCellsAreToldToBe) {
  Settings settings;
  const Rehearsal right = Rehearsed(settings);
  settings.gap_error_m = 0.04;
  settings.mass_error = 0.02;
  const Rehearsal wrong = Rehearsed(settings);
  const auto cell = [](const Rehearsal& r, std::size_t foot, std::size_t frame) {
    return r.frames[frame].inputs.loads.feet[foot].cells[0];
  };
  EXPECT_NEAR(cell(wrong, 0, 0).p_WS_m.y() - cell(right, 0, 0).p_WS_m.y(), 0.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 1, 0).p_WS_m.y() - cell(right, 1, 0).p_WS_m.y(), -0.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 0, 0).load_n / cell(right, 0, 0).load_n, 1.02, 1e-9);
  EXPECT_NEAR(cell(wrong, 0, 400).load_n / cell(right, 0, 400).load_n, 1, 1e-9);
}

TEST(Rehearsal, NamesTheClipThatHasNoPerson) {
  motion::Motion motion = Standing(1);
  motion.skeleton.joints[0].name = "thing";
  for (body::Joint& joint : motion.skeleton.joints) joint.name = "x" + joint.name;
  const auto made = Rehearse(motion, {}, "chair.bvh");
  ASSERT_FALSE(made.ok());
  EXPECT_NE(made.error().message.find("chair.bvh"), std::string::npos);
}

}  // namespace
}  // namespace footing::rehearsal

#include "common/virtual/motion/standard_layout.h"

#include <gtest/gtest.h>

#include "common/body/kinematics.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion_files/load.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

/// Mean distance of the joints of the limbs in both motions, m.
double JointsApart(const Motion& a, const Motion& b) {
  const auto in_a = body::FindLandmarks(a.skeleton).value();
  const auto in_b = body::FindLandmarks(b.skeleton).value();
  body::Kinematics at_a(a.skeleton), at_b(b.skeleton);
  double sum = 0, count = 0;
  for (Eigen::Index t = 0; t < a.frames(); t += 10) {
    body::ComputeKinematics(a.skeleton, a.q.col(t), at_a);
    body::ComputeKinematics(b.skeleton, b.q.col(t), at_b);
    using body::Landmark;
    for (const Landmark left :
         {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, Landmark::kLeftShoulder,
          Landmark::kLeftElbow, Landmark::kLeftWrist}) {
      for (const Landmark landmark : {left, body::Mirrored(left)}) {
        sum += (at_a.p_WJ[static_cast<std::size_t>(in_a[landmark])] -
                at_b.p_WJ[static_cast<std::size_t>(in_b[landmark])])
                   .norm();
        ++count;
      }
    }
  }
  return sum / count;
}

TEST(ToStandardLayout, KeepsTheJointsOfAnotherSkeletonsMotion) {
  // GIVEN a character of an animation program, of 84 degrees of freedom and another axis for all.
  SKIP_WITHOUT_SHARED_DATA();
  const auto loaded = motion_files::LoadMotion(test::SharedData() + "/mocap/cmu_bvh/002_04.bvh");
  ASSERT_TRUE(loaded);
  const auto motion = WithLandmarksOnly(loaded->motion).value();
  ASSERT_FALSE(HasStandardLayout(motion));
  const auto standard = ToStandardLayout(motion);
  ASSERT_TRUE(standard) << standard.error().message;
  EXPECT_TRUE(HasStandardLayout(standard->motion));
  EXPECT_EQ(standard->motion.frames(), motion.frames());
  EXPECT_LT(standard->rms_m, 0.008);
  EXPECT_LT(JointsApart(motion, standard->motion), 0.02);
}

}  // namespace
}  // namespace footing::motion

#include "daemon/simulation/pose_service/subject_body.h"

#include <gtest/gtest.h>

#include "common/body/kinematics.h"

namespace footing::pose_service {
namespace {

TEST(SubjectBody, HasTheSubjectsHeightAndWeight) {
  const auto body = MakeSubjectBody({"a", 1.62, 58, 0});
  ASSERT_TRUE(body.ok());
  EXPECT_DOUBLE_EQ(body->height_m, 1.62);
  EXPECT_NEAR(body->mass_kg, 58, 1e-9);
}

TEST(SubjectBody, WithoutAWeightItIsAnAverageOne) {
  const auto body = MakeSubjectBody({"a", 2.0, 0, 0});
  ASSERT_TRUE(body.ok());
  EXPECT_NEAR(body->mass_kg, 22.5 * 4, 1e-9);
}

TEST(SubjectBody, AKnownFootIsAsLongAsItWasMeasured) {
  const auto body = MakeSubjectBody({"a", 1.75, 70, 0.30});
  ASSERT_TRUE(body.ok());
  body::Kinematics at(body->skeleton);
  body::ComputeKinematics(body->skeleton, body::TPose(body->skeleton, body->landmarks), at);
  const auto place = [&](body::Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body->landmarks[landmark])];
  };
  const Eigen::Vector3d to_tip =
      place(body::Landmark::kLeftToeEnd) - place(body::Landmark::kLeftAnkle);
  // The ankle is a quarter of the foot ahead of the heel.
  EXPECT_NEAR(to_tip.head<2>().norm(), 0.75 * 0.30, 0.01);
}

}  // namespace
}  // namespace footing::pose_service

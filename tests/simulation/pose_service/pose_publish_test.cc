#include "daemon/simulation/pose_service/pose_publish.h"

#include <gtest/gtest.h>

#include "tests/simulation/reconstruction/made_person.h"

namespace footing::pose_service {
namespace {

TEST(PosePublish, TheSkeletonHasALinkForEveryJointWithItsParent) {
  const body::Body person = reconstruction::MadePerson();
  const stream::Skeleton skeleton = ToSkeleton(person);
  ASSERT_EQ(skeleton.links.size(), person.skeleton.joints.size());
  for (std::size_t i = 0; i < skeleton.links.size(); ++i) {
    EXPECT_EQ(skeleton.links[i].name, person.skeleton.joints[i].name);
    EXPECT_EQ(skeleton.links[i].parent, person.skeleton.joints[i].parent);
    EXPECT_GT(skeleton.links[i].size_m.minCoeff(), 0);
  }
}

}  // namespace
}  // namespace footing::pose_service

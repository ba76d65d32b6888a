#include "daemon/offline/eval/arm.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/body/body.h"

namespace footing::eval {
namespace {

constexpr double kRateHz = 20;
constexpr int kBlocks = 12, kBlockFrames = 60;  // Blocks of 3 s: what is alike is another moment.

arms::ArmGeometry LeftArm() { return {body::MakeBody(body::StandardPerson(1.75), {}).value(), 0}; }

/// The forearm ahead, the upper arm hanging or out to the side: the same attitude of the fist.
arms::ArmDirections Hanging() {
  return {-Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX()};
}
arms::ArmDirections Aside() {
  return {Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()};
}

/// Two arms that do the same: blocks of one arm pose and the other in turn.
nlohmann::ordered_json Alternating(const arms::ArmDirections& one, const arms::ArmDirections& other,
                                   const pose_run::Places& places) {
  std::vector<ArmBound> both;
  for (int arm = 0; arm < 2; ++arm) both.emplace_back(LeftArm(), places, kRateHz);
  for (int i = 0; i < kBlocks * kBlockFrames; ++i) {
    const bool first = i / kBlockFrames % 2 == 0;
    ArmMoment moment{.turns_W = {}, .truth = first ? one : other, .error = {3, 2, 1}};
    moment.turns_W.fill(Eigen::Matrix3d::Identity());
    if (!first)  // The strap on the upper arm turns with it.
      moment.turns_W[1] =
          Eigen::Quaterniond::FromTwoVectors(one.upper, other.upper).toRotationMatrix();
    for (ArmBound& arm : both) arm.Add(moment);
  }
  return ArmBound::Json(both);
}

TEST(ArmBound, IsTheDeviationAmongMomentsOfEqualAttitudes) {
  const auto report = Alternating(Hanging(), Aside(), pose_run::kFists);
  // Either pose half of the time: each is off the middle by half of what is between them.
  const double between_cm = Distance(LeftArm(), Hanging(), Aside()).hand_cm;
  EXPECT_GT(between_cm, 30);
  EXPECT_NEAR(report["least"]["hand_position_rms_cm"].get<double>(), between_cm / 2,
              0.1 * between_cm);
  EXPECT_GT(report["least"]["shoulder_error_deg"].get<double>(), 30);
  EXPECT_NEAR(report["least"]["elbow_error_deg"].get<double>(), 0, 1e-6);  // 90 degrees in both.
  EXPECT_GT(report["alike_share"].get<double>(), 0.95);
  EXPECT_EQ(report["observable_share"].get<double>(), 0);
}

TEST(ArmBound, IsNoneWhereAStrapShowsTheUpperArm) {
  const auto report = Alternating(Hanging(), Aside(), {true, true, false});
  EXPECT_NEAR(report["least"]["hand_position_rms_cm"].get<double>(), 0, 1e-6);
  EXPECT_EQ(report["observable_share"].get<double>(), 1);
  EXPECT_NEAR(report["in_observable"]["shoulder_error_deg"].get<double>(), 3, 1e-9);
  EXPECT_NEAR(report["in_observable"]["elbow_error_deg"].get<double>(), 2, 1e-9);
  EXPECT_NEAR(report["in_observable"]["hand_position_rms_cm"].get<double>(), 1, 1e-9);
}

TEST(ArmBound, IsNotKnownOfWhatHappensOnce) {
  std::vector<ArmBound> one;
  one.emplace_back(LeftArm(), pose_run::kFists, kRateHz);
  for (int i = 0; i < 100; ++i) {
    ArmMoment moment{.turns_W = {}, .truth = Hanging(), .error = {}};
    moment.turns_W.fill(Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitX()).toRotationMatrix());
    one.front().Add(moment);
  }
  EXPECT_EQ(ArmBound::Json(one)["alike_share"].get<double>(), 0);
}

}  // namespace
}  // namespace footing::eval

#include "common/virtual/motion/joint_angles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/body/skeleton.h"

namespace footing::joint_angles {
namespace {

using body::AxisRotation;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Axis = body::Axis;

constexpr double kSplay = 0.35;  ///< Splay of the legs at rest, as in CMU's skeletons.

/// At rest the arms are held out and the legs apart.
body::Skeleton Body() {
  std::vector<body::Joint> joints;
  const auto add = [&](const std::string& name, int parent, const Vector3d& offset_m) {
    body::Joint joint;
    joint.name = name;
    joint.parent = parent;
    joint.offset_m = offset_m;
    joint.rotations = {{Axis::kZ}, {Axis::kX}, {Axis::kY}};
    joints.push_back(joint);
    return static_cast<int>(joints.size()) - 1;
  };
  const int root = add("root", -1, Vector3d::Zero());
  const int thorax = add("thorax", root, {0, 0, 0.4});
  const int neck = add("lowerneck", thorax, {0, 0, 0.15});
  add("head", neck, {0, 0, 0.1});
  for (const double y : {1.0, -1.0}) {
    const std::string s = y > 0 ? "l" : "r";
    const Vector3d leg(0, y * std::sin(kSplay), -std::cos(kSplay));
    const int thigh = add(s + "femur", root, {0, 0.1 * y, 0});
    const int shank = add(s + "tibia", thigh, 0.4 * leg);
    const int foot = add(s + "foot", shank, 0.42 * leg);
    add(s + "toes", foot, {0.13, 0, -0.04});
    const int upper_arm = add(s + "humerus", thorax, {0, 0.2 * y, 0.1});
    const int forearm = add(s + "radius", upper_arm, {0, 0.3 * y, 0});
    const int wrist = add(s + "wrist", forearm, {0, 0.25 * y, 0});
    add(s + "hand", wrist, {0, 0.08 * y, 0});
  }
  return body::MakeSkeleton(std::move(joints));
}

class JointAnglesTest : public ::testing::Test {
 protected:
  JointAnglesTest() {
    motion_.skeleton = Body();
    motion_.rate_hz = 100;
    motion_.q.setZero(motion_.skeleton.dof, 1);
    Stand(0);
  }
  int Find(const std::string& name) const { return body::FindJoint(motion_.skeleton, name); }
  void Set(Eigen::Index frame, const std::string& name, const Matrix3d& R_PJ) {
    body::SetJointRotation(motion_.skeleton.joint(Find(name)), R_PJ, motion_.q.col(frame));
  }
  /// Upright: the legs come together, the arms stay out.
  void Stand(Eigen::Index frame) {
    motion_.q.col(frame)(2) = 1;
    for (const std::string s : {"l", "r"}) Set(frame, s + "femur", Upright(s));
  }
  static Matrix3d Upright(const std::string& side) {
    return AxisRotation(Axis::kX, side == "l" ? -kSplay : kSplay);
  }
  /// A rotation of a leg's joint about an axis of the upright leg.
  static Matrix3d OfLeg(const std::string& side, const Matrix3d& R) {
    return Upright(side).transpose() * R * Upright(side);
  }
  motion::Table Angles() const {
    const auto table = JointAngles(motion_);
    EXPECT_TRUE(table.ok()) << table.error().message;
    return *table;
  }
  static double At(const motion::Table& table, const std::string& column, Eigen::Index row = 0) {
    const int index = motion::FindColumn(table, column);
    EXPECT_GE(index, 0) << column;
    return index < 0 ? 0 : table.values(row, index);
  }

  motion::Motion motion_;
};

TEST_F(JointAnglesTest, TheTPoseIsZeroButForTheArms) {
  const motion::Table table = Angles();
  EXPECT_TRUE(table.in_degrees);
  for (std::size_t i = 1; i < table.columns.size(); ++i) {
    const std::string& column = table.columns[i];
    const double expected = column == "pelvis_ty"             ? 1
                            : column.rfind("arm_add", 0) == 0 ? -90  // Away from the trunk.
                                                              : 0;
    EXPECT_NEAR(table.values(0, static_cast<Eigen::Index>(i)), expected, 2e-6) << column;
  }
}

TEST_F(JointAnglesTest, SignsAreThoseOfOpenSim) {
  const auto degrees = [](double value) { return DegreesToRadians(value); };
  for (const std::string s : {"l", "r"}) {
    const double out = s == "l" ? 1 : -1;
    // The thigh goes ahead by 40 degrees and out by 10, the shank back by 60, the toes up by 15.
    Set(0, s + "femur",
        AxisRotation(Axis::kY, degrees(-40)) * AxisRotation(Axis::kX, out * degrees(10)) *
            Upright(s));
    Set(0, s + "tibia", OfLeg(s, AxisRotation(Axis::kY, degrees(60))));
    Set(0, s + "foot", OfLeg(s, AxisRotation(Axis::kY, degrees(-15))));
  }
  // The trunk bends forwards by 20 degrees and turns to the left by 5; the body looks left by 30.
  Set(0, "thorax", AxisRotation(Axis::kY, degrees(20)) * AxisRotation(Axis::kZ, degrees(5)));
  Set(0, "root", AxisRotation(Axis::kZ, degrees(30)));
  motion_.q.col(0).head<3>() << 0.1, 0.2, 0.9;
  const motion::Table table = Angles();
  for (const std::string s : {"_l", "_r"}) {
    EXPECT_NEAR(At(table, "hip_flexion" + s), 40, 2e-6);
    EXPECT_NEAR(At(table, "hip_adduction" + s), -10, 2e-6);
    EXPECT_NEAR(At(table, "hip_rotation" + s), 0, 2e-6);
    EXPECT_NEAR(At(table, "knee_angle" + s), 60, 2e-6);
    EXPECT_NEAR(At(table, "ankle_angle" + s), 15, 2e-6);
  }
  EXPECT_NEAR(At(table, "lumbar_extension"), -20, 2e-6);
  EXPECT_NEAR(At(table, "lumbar_rotation"), 5, 2e-6);
  EXPECT_NEAR(At(table, "pelvis_rotation"), 30, 2e-6);
  EXPECT_NEAR(At(table, "pelvis_tx"), 0.1, 1e-12);
  EXPECT_NEAR(At(table, "pelvis_ty"), 0.9, 1e-12);
  EXPECT_NEAR(At(table, "pelvis_tz"), -0.2, 1e-12);
}

/// OpenSim's own product: about z, then x, then y.
Matrix3d OpenSim(double z_deg, double x_deg, double y_deg) {
  const auto about = [](double angle_deg, const Vector3d& axis) {
    return Eigen::AngleAxisd(DegreesToRadians(angle_deg), axis).toRotationMatrix();
  };
  return about(z_deg, Vector3d::UnitZ()) * about(x_deg, Vector3d::UnitX()) *
         about(y_deg, Vector3d::UnitY());
}

TEST_F(JointAnglesTest, OpenSimPutsEveryLimbWhereItIs) {
  const int frames = 40;
  motion_.q.setZero(motion_.skeleton.dof, frames);
  for (int i = 0; i < frames; ++i) {
    Stand(i);
    const double t = 0.1 * i;
    Set(i, "root", AxisRotation(Axis::kZ, 0.5 * t) * AxisRotation(Axis::kX, 0.2 * std::sin(t)));
    Set(i, "thorax", AxisRotation(Axis::kY, 0.4 * std::sin(2 * t)));
    for (const std::string s : {"l", "r"}) {
      const double out = s == "l" ? 1 : -1;
      Set(i, s + "femur",
          AxisRotation(Axis::kY, -std::sin(t)) * AxisRotation(Axis::kZ, 0.3 * out * t) *
              Upright(s));
      Set(i, s + "tibia", OfLeg(s, AxisRotation(Axis::kY, 0.3 * t)));
      // The arm comes down and ahead; the elbow bends about an axis 0.5 rad off the upright one.
      Set(i, s + "humerus",
          AxisRotation(Axis::kX, -0.3 * out * t) * AxisRotation(Axis::kZ, -0.1 * out * t));
      const Vector3d hinge(out * std::sin(0.5), 0, -out * std::cos(0.5));
      Set(i, s + "radius", Eigen::AngleAxisd(0.4 * t, hinge).toRotationMatrix());
    }
  }
  const motion::Table table = Angles();
  Matrix3d M;  // W to OpenSim.
  M << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Vector3d down = -Vector3d::UnitY();
  body::Kinematics at(motion_.skeleton);
  for (int i = 0; i < frames; ++i) {
    body::ComputeKinematics(motion_.skeleton, motion_.q.col(i), at);
    const auto get = [&](const std::string& column) { return At(table, column, i); };
    const auto direction = [&](const std::string& from, const std::string& to) -> Vector3d {
      const auto place = [&](const std::string& name) {
        return at.p_WJ[static_cast<std::size_t>(Find(name))];
      };
      return M * (place(to) - place(from)).normalized();
    };
    const Matrix3d pelvis = OpenSim(get("pelvis_tilt"), get("pelvis_list"), get("pelvis_rotation"));
    const Matrix3d torso =
        pelvis * OpenSim(get("lumbar_extension"), get("lumbar_bending"), get("lumbar_rotation"));
    for (const std::string s : {"l", "r"}) {
      const double sign = s == "l" ? -1 : 1;  // OpenSim's left joints turn about -x and -y.
      const Matrix3d thigh =
          pelvis * OpenSim(get("hip_flexion_" + s), sign * get("hip_adduction_" + s),
                           sign * get("hip_rotation_" + s));
      const Matrix3d shank = thigh * OpenSim(-get("knee_angle_" + s), 0, 0);
      const Matrix3d upper_arm = torso * OpenSim(get("arm_flex_" + s), sign * get("arm_add_" + s),
                                                 sign * get("arm_rot_" + s));
      const Matrix3d forearm = upper_arm * OpenSim(get("elbow_flex_" + s), 0, 0);
      EXPECT_LT((thigh * down - direction(s + "femur", s + "tibia")).norm(), 1e-6) << s << i;
      EXPECT_LT((shank * down - direction(s + "tibia", s + "foot")).norm(), 1e-6) << s << i;
      EXPECT_LT((upper_arm * down - direction(s + "humerus", s + "radius")).norm(), 1e-6) << s << i;
      EXPECT_LT((forearm * down - direction(s + "radius", s + "wrist")).norm(), 1e-6) << s << i;
    }
  }
}

TEST_F(JointAnglesTest, ArmsThatCircleStayWithinOneTurnAndTheBodyDoesNot) {
  const int frames = 100;
  motion_.q.setZero(motion_.skeleton.dof, frames);
  for (int i = 0; i < frames; ++i) {
    Stand(i);
    const double angle_rad = 0.2 * i;  // Three turns.
    Set(i, "root", AxisRotation(Axis::kZ, angle_rad));
    Set(i, "rhumerus", AxisRotation(Axis::kY, -angle_rad) * AxisRotation(Axis::kX, 1.2));
  }
  const motion::Table table = Angles();
  for (int i = 0; i < frames; ++i) {
    const double angle_deg = RadiansToDegrees(0.2 * i);
    EXPECT_LE(std::abs(At(table, "arm_flex_r", i)), 270) << i;
    EXPECT_NEAR(std::remainder(At(table, "arm_flex_r", i) - angle_deg, 360), 0, 1e-4) << i;
    EXPECT_NEAR(At(table, "pelvis_rotation", i), angle_deg, 1e-4) << i;
  }
}

TEST_F(JointAnglesTest, NearAnotherMotionTheSamePoseHasTheSameAngles) {
  const int frames = 100;
  motion_.q.setZero(motion_.skeleton.dof, frames);
  for (int i = 0; i < frames; ++i) {
    Stand(i);
    const double angle_rad = 0.2 * i;  // Three turns.
    Set(i, "root", AxisRotation(Axis::kZ, angle_rad));
    Set(i, "rhumerus", AxisRotation(Axis::kY, -angle_rad) * AxisRotation(Axis::kX, 1.2));
  }
  // Another one comes to the last pose at once.
  motion::Motion other = motion_;
  for (int i = 0; i + 1 < frames; ++i) other.q.col(i) = motion_.q.col(0);
  const auto alone = JointAngles(other);
  const auto near = JointAngles(other, &motion_);
  ASSERT_TRUE(alone.ok() && near.ok());
  const motion::Table table = Angles();
  const auto last = table.values.row(frames - 1);
  EXPECT_LT((near->values.row(frames - 1) - last).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_GT((alone->values.row(frames - 1) - last).cwiseAbs().maxCoeff(), 300);
}

/// Stands for a second, then bends hips, knees and trunk, spreads the legs and turns them inwards.
class SinceStandingTest : public JointAnglesTest {
 protected:
  static constexpr int kStands = 100, kFrames = 200;

  SinceStandingTest() { Squat(Matrix3d::Identity(), Matrix3d::Identity()); }

  /// With a pelvis and thighs whose own frames are turned by these: another laboratory's.
  void Squat(const Matrix3d& of_pelvis, const Matrix3d& of_thigh) {
    motion_.q.setZero(motion_.skeleton.dof, kFrames);
    for (int i = 0; i < kFrames; ++i) {
      const double bend = i < kStands ? 0 : 0.01 * (i - kStands);
      if (i > 0) motion_.q.col(i) = motion_.q.col(i - 1);
      motion_.q(2, i) = 1 - 0.3 * bend;
      const Matrix3d pelvis = AxisRotation(Axis::kZ, 0.4) * AxisRotation(Axis::kY, 0.5 * bend);
      Set(i, "root", pelvis * of_pelvis);
      Set(i, "thorax", of_pelvis.transpose() * AxisRotation(Axis::kY, 0.2 * bend));
      for (const std::string s : {"l", "r"}) {
        const double out = s == "l" ? 1 : -1;
        const Matrix3d thigh = AxisRotation(Axis::kY, -1.4 * bend) *
                               AxisRotation(Axis::kX, out * 0.3 * bend) *
                               AxisRotation(Axis::kZ, -out * 0.2 * bend);
        Set(i, s + "femur", of_pelvis.transpose() * thigh * of_thigh * Upright(s));
        Set(i, s + "tibia", OfLeg(s, of_thigh.transpose() * AxisRotation(Axis::kY, 1.6 * bend)));
      }
    }
  }
};

TEST_F(SinceStandingTest, AnotherFrameOfPelvisAndThighMakesNoDifference) {
  const motion::Table plain = Angles();
  const auto standing = FindStanding(plain);
  ASSERT_FALSE(standing.empty());
  EXPECT_EQ(standing.front(), 0);
  // Then no angle has changed by 4 degrees yet: the knee does in 4.4 frames.
  EXPECT_NEAR(static_cast<double>(standing.back()), kStands + 4, 1);
  std::vector<Eigen::Index> upright(standing.begin(), standing.begin() + kStands);
  const auto change = SinceStanding(plain, upright);
  ASSERT_TRUE(change.ok()) << change.error().message;
  const int last = kFrames - 1;
  const double bend = RadiansToDegrees(0.01 * (last - kStands));
  EXPECT_NEAR(At(*change, "pelvis_tilt", last), -0.5 * bend, 1e-4);  // Forwards.
  EXPECT_NEAR(At(*change, "pelvis_rotation", last), 0, 1e-4);        // Its heading is its own.
  EXPECT_NEAR(At(*change, "lumbar_extension", last), -0.2 * bend, 1e-4);
  for (const std::string s : {"_l", "_r"}) {
    EXPECT_NEAR(At(*change, "hip_flexion" + s, last), 1.4 * bend, 1e-4);
    EXPECT_NEAR(At(*change, "hip_adduction" + s, last), -0.3 * bend, 1e-4);
    EXPECT_NEAR(At(*change, "hip_rotation" + s, last), 0.2 * bend, 1e-4);
    EXPECT_NEAR(At(*change, "knee_angle" + s, last), 1.6 * bend, 1e-4);
  }
  EXPECT_EQ(motion::FindColumn(*change, "arm_flex_r"), -1);

  Squat(AxisRotation(Axis::kY, 0.3), AxisRotation(Axis::kZ, 0.25));
  const motion::Table turned = Angles();
  EXPECT_GT(std::abs(At(turned, "pelvis_tilt") - At(plain, "pelvis_tilt")), 15);
  EXPECT_GT(std::abs(At(turned, "hip_flexion_r") - At(plain, "hip_flexion_r")), 15);
  EXPECT_GT(std::abs(At(turned, "hip_rotation_r") - At(plain, "hip_rotation_r")), 10);
  const auto of_turned = SinceStanding(turned, upright);
  ASSERT_TRUE(of_turned.ok()) << of_turned.error().message;
  for (std::size_t i = 0; i < change->columns.size(); ++i) {
    const std::string& column = change->columns[i];
    // The thigh's frame is not the knee's: a hinge about another axis has another flexion.
    if (column.rfind("knee", 0) == 0 || column.rfind("ankle", 0) == 0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    EXPECT_LT((change->values.col(at) - of_turned->values.col(at)).cwiseAbs().maxCoeff(), 1e-3)
        << column;
  }
}

TEST_F(SinceStandingTest, StandingIsLookedForWhereItIsAskedForAndIsNotASquat) {
  const motion::Table table = Angles();
  EXPECT_EQ(FindStanding(table, 40).front(), 40);
  EXPECT_TRUE(FindStanding(table, kStands + 5).empty());
  motion::Table crouched = table;
  const auto knee = motion::FindColumn(table, "knee_angle_r");
  crouched.values.col(knee).array() += 45;
  EXPECT_TRUE(FindStanding(crouched).empty());
}

TEST_F(SinceStandingTest, TheTurnOfAStraightLegIsNotKnown) {
  const motion::Table table = Angles();
  EXPECT_FALSE(IsKnown(table, "hip_rotation_l", 0));
  EXPECT_TRUE(IsKnown(table, "hip_rotation_l", kFrames - 1));
  EXPECT_TRUE(IsKnown(table, "hip_flexion_l", 0));
  motion::Table radians = table;
  radians.in_degrees = false;
  radians.values *= kPi / 180;
  EXPECT_FALSE(IsKnown(radians, "hip_rotation_r", 0));
  EXPECT_TRUE(IsKnown(radians, "hip_rotation_r", kFrames - 1));
}

TEST_F(SinceStandingTest, ATableInRadiansIsReadAndOneWithoutALegIsRefused) {
  motion::Table table = Angles();
  const auto change = SinceStanding(table, {0, 1, 2});
  table.in_degrees = false;
  table.values.rightCols(table.values.cols() - 1) *= kPi / 180;
  const auto of_radians = SinceStanding(table, {0, 1, 2});
  ASSERT_TRUE(change.ok() && of_radians.ok());
  EXPECT_LT((change->values - of_radians->values).cwiseAbs().maxCoeff(), 1e-4);
  table.columns[static_cast<std::size_t>(motion::FindColumn(table, "hip_rotation_l"))] = "other";
  const auto refused = SinceStanding(table, {0, 1, 2});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("hip_rotation_l"), std::string::npos);
}

/// Bends and spreads the thighs until they point sideways, and further, and stands up again.
TEST_F(JointAnglesTest, ADeepSquatWithWideKneesEndsWhereItBegan) {
  constexpr int kFrames = 200;
  motion_.q.setZero(motion_.skeleton.dof, kFrames);
  for (int i = 0; i < kFrames; ++i) {
    const double depth = std::sin(kPi * i / (kFrames - 1));
    if (i > 0) motion_.q.col(i) = motion_.q.col(i - 1);
    for (const std::string s : {"l", "r"}) {
      const double out = s == "l" ? 1 : -1;
      Set(i, s + "femur",
          AxisRotation(Axis::kZ, out * 0.3 * depth) * AxisRotation(Axis::kX, out * 1.8 * depth) *
              AxisRotation(Axis::kY, -0.8 * depth) * Upright(s));
    }
  }
  const motion::Table table = Angles();
  for (const std::string s : {"_l", "_r"}) {
    for (const char* angle : {"hip_flexion", "hip_adduction", "hip_rotation"}) {
      EXPECT_NEAR(At(table, angle + s, kFrames - 1), 0, 1e-4) << angle << s;
      const int column = motion::FindColumn(table, angle + s);
      EXPECT_LE(table.values.col(column).cwiseAbs().maxCoeff(), 180) << angle << s;
    }
    const int spread = motion::FindColumn(table, "hip_adduction" + s);
    EXPECT_LT(table.values.col(spread).minCoeff(), -60);
    EXPECT_GE(table.values.col(spread).minCoeff(), -90);
  }
}

TEST(JointAngles, ASkeletonWithoutLegsIsRefusedByName) {
  motion::Motion motion;
  body::Joint root;
  root.name = "root";
  root.rotations = {{Axis::kZ}};
  motion.skeleton = body::MakeSkeleton({root});
  motion.rate_hz = 100;
  motion.q.setZero(motion.skeleton.dof, 2);
  const auto table = JointAngles(motion);
  ASSERT_FALSE(table.ok());
  EXPECT_NE(table.error().message.find("root"), std::string::npos);
}

}  // namespace
}  // namespace footing::joint_angles

#include "common/virtual/people/body_pose.h"

#include <Eigen/Geometry>
#include <cmath>

#include "common/base/units.h"

namespace footing::users {
namespace {

/// Lengths of segments over the stature (Winter, Biomechanics and Motor Control, table 4.1); to the
/// sensor in the fist, and on the middle of the shin.
constexpr double kUpperArm = 0.186;
constexpr double kElbowToFist = 0.186;
constexpr double kThigh = 0.245;
constexpr double kKneeToSensor = 0.12;
constexpr double kNeckToCrown = 0.18;
/// From the hips to the middle of the chest.
constexpr double kHipToChest = 0.2;
/// A Wiimote's accelerometer lies so far before the wrist, m.
constexpr double kWristToSensorM = 0.11;

/// A direction in the sagittal plane, `angle_rad` before straight down.
Eigen::Vector3d Sagittal(double angle_rad) {
  return {std::sin(angle_rad), 0, -std::cos(angle_rad)};
}

/// At `lever_m` over a joint about which it inclines sideways.
SensorPose Inclined(double lever_m, double roll_rad, double pelvis_m) {
  const Eigen::Vector3d front = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d left =
      Eigen::AngleAxisd(roll_rad, front) * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d up = front.cross(left);
  return {lever_m * up + Eigen::Vector3d(0, 0, pelvis_m), AxesFrom(left, front)};
}

}  // namespace

Eigen::Matrix3d AxesFrom(const Eigen::Vector3d& left, const Eigen::Vector3d& front) {
  Eigen::Matrix3d axes;
  axes << left, front, left.cross(front);
  return axes;
}

SensorPose WristPose(double swing_rad, double roll_rad) {
  const Eigen::Vector3d front(std::cos(swing_rad), 0, std::sin(swing_rad));
  const Eigen::Vector3d left =
      Eigen::AngleAxisd(roll_rad, front) * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  return {kWristToSensorM * front, AxesFrom(left, front)};
}

SensorPose ArmPose(double height_m, double shoulder_rad, double elbow_rad, double turned_rad,
                   double aside_rad) {
  const Eigen::AngleAxisd swing_plane(aside_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d upper = swing_plane * Sagittal(shoulder_rad);
  const Eigen::Vector3d fore = swing_plane * Sagittal(shoulder_rad + elbow_rad);
  const Eigen::Vector3d side = swing_plane * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d left = Eigen::AngleAxisd(turned_rad, fore) * side;
  return {height_m * (kUpperArm * upper + kElbowToFist * fore), AxesFrom(left, fore)};
}

SensorPose ShinPose(double height_m, double hip_rad, double knee_rad, double pelvis_m,
                    double grip_rad) {
  const Eigen::Vector3d shin = Sagittal(hip_rad - knee_rad);
  const Eigen::Vector3d left =
      Eigen::AngleAxisd(grip_rad, shin) * Eigen::Vector3d(Eigen::Vector3d::UnitY());
  const Eigen::Vector3d front = shin.cross(left);
  return {height_m * (kThigh * Sagittal(hip_rad) + kKneeToSensor * shin) +
              Eigen::Vector3d(0, 0, pelvis_m),
          AxesFrom(left, front)};
}

SensorPose HeadPose(double height_m, double roll_rad, double pelvis_m) {
  return Inclined(kNeckToCrown * height_m, roll_rad, pelvis_m);
}

SensorPose TrunkPose(double height_m, double roll_rad, double pelvis_m) {
  return Inclined(kHipToChest * height_m, roll_rad, pelvis_m);
}

Eigen::Vector3d SpecificForce(const SensorPose& before, const SensorPose& at,
                              const SensorPose& after, double step_s) {
  const Eigen::Vector3d acceleration =
      (after.p_W_m - 2 * at.p_W_m + before.p_W_m) / (step_s * step_s);
  const Eigen::Vector3d gravity(0, 0, kStandardGravityMps2);
  return at.R_WS.transpose() * (acceleration + gravity);
}

}  // namespace footing::users

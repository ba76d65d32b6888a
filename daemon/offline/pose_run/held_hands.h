#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/virtual/sensors/held_device.h"
#include "common/virtual/sensors/scene.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/arms/arm_features.h"
#include "daemon/simulation/arms/arm_model.h"
#include "daemon/simulation/arms/hand_attitude.h"

namespace footing::pose_run {

/// A Wiimote with MotionPlus in each fist of a scene: a sample for every column of its motion.
class HeldHands {
 public:
  HeldHands(const virtual_sensors::Scene& scene, std::uint64_t seed);

  /// The samples from the last call's column up to this one.
  std::array<std::vector<arms::HandReading>, arms::kArms> Until(Eigen::Index column);
  double step_s() const { return step_s_; }

 private:
  std::array<virtual_sensors::HeldCourse, arms::kArms> courses_;
  std::vector<virtual_sensors::HeldErrors> errors_;
  Eigen::Index next_ = 0;
  double step_s_;
};

/// Puts how the arms are held into the inputs, by the readings of a Wiimote in each hand.
void EstimateArms(const arms::ArmModel& model, PoseRun& run);

/// What a recorded motion would have given two Wiimotes alone, beside the truth.
struct ArmFrame {
  std::array<std::vector<arms::HandReading>, arms::kArms> readings;
  Eigen::VectorXd q;
};
struct ArmRun {
  body::Body body;
  double rate_hz = 60;           ///< Of the frames,
  double reading_s = 0;          ///< and the time from one reading to the next.
  std::size_t aligned = 0;       ///< The frame at whose end the T-pose is known.
  std::vector<ArmFrame> frames;  ///< Begins with kStandS in the T-pose.
};

/// As RunPose; of the settings the person, rate, loop and seed count.
Result<ArmRun> RunArms(const motion::Motion& clip, const Settings& settings,
                       const std::string& origin);

}  // namespace footing::pose_run

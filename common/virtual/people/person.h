#pragma once

#include <array>
#include <cstdint>
#include <variant>

#include <Eigen/Core>

#include "common/stream/user_interface.h"
#include "common/virtual/people/style.h"

namespace footing::users {

/// Where a worn sensor is, and its axes x left, y front, z down in W.
struct SensorPose {
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();
};

/// The sensor's axes from two of them: where its left and its front point.
Eigen::Matrix3d AxesFrom(const Eigen::Vector3d& left, const Eigen::Vector3d& front);

/// A remote held in front of a bent elbow that is swung up and down from the wrist, whose
/// joint is the origin. Angles: `swing_rad` up, `roll_rad` left side up.
SensorPose WristPose(double swing_rad, double roll_rad);

/// A remote held along the forearm, front to the fingers, buttons up when the elbow is bent: the
/// upper arm is `shoulder_rad` before hanging, the elbow bent by `elbow_rad`, the forearm and what
/// it holds turned about itself by `turned_rad`, to the right; `aside_rad` is the direction of the
/// swing, left of forward.
SensorPose ArmPose(double height_m, double shoulder_rad, double elbow_rad, double turned_rad,
                   double aside_rad);

/// A remote on a shin, axes of the frame M (z down along the shin): the thigh is `hip_rad` before
/// hanging, the knee bent by `knee_rad`; `pelvis_m` is the rise of the pelvis, `grip_rad` a
/// rotation about the shin.
SensorPose ShinPose(double height_m, double hip_rad, double knee_rad, double pelvis_m,
                    double grip_rad);

/// A remote on the head, inclined by `roll_rad` about the neck, left side up.
SensorPose HeadPose(double height_m, double roll_rad, double pelvis_m);

/// The same on the chest of a trunk that inclines at the hips; axes of the frame M.
SensorPose TrunkPose(double height_m, double roll_rad, double pelvis_m);

/// Specific force in S from three poses `step_s` apart, of the middle one: acceleration and
/// gravity.
Eigen::Vector3d SpecificForce(const SensorPose& before, const SensorPose& at,
                              const SensorPose& after, double step_s);

/// A person who swings two remotes from the wrists, or with the arms, or who steps in place with
/// one on each shin and one on the head or the trunk. A plain value.
class LimbBody {
 public:
  /// `turn_by`: of who steps, the head or the trunk inclines, or one foot is lifted higher.
  LimbBody(stream::UserInterface interface, const Style& style, std::uint64_t seed,
           stream::TurnSource turn_by);

  void Advance(const Intention& wanted, double step_s);
  void Feel(Felt& felt) const;
  stream::Gait gesture() const { return gesture_; }
  double limb_hz() const { return rhythm_.activity() > 0.05 ? rhythm_.frequency_hz() : 0; }

 private:
  static constexpr std::size_t kSensors = 3;
  using Poses = std::array<SensorPose, kSensors>;

  Poses PosesNow() const;
  SensorPose HandNow(bool left) const;
  SensorPose ShinNow(bool left) const;
  SensorPose TrunkNow() const;
  double LiftedBy(bool left) const;
  double PelvisRise() const;

  stream::UserInterface interface_;
  stream::TurnSource turn_by_;
  Style style_;
  Rhythm rhythm_;
  Follower turn_;  ///< Turn of hands, head or trunk, to the right: the left side up. Feet: a share.
  Follower bend_;  ///< Elbow.
  Follower hop_;   ///< 0 stepping to 1 hopping with both legs.
  Follower run_;   ///< 0 walking to 1 running.
  stream::Gait gesture_ = stream::Gait::kStep;
  double step_s_ = 1;
  std::array<Poses, 3> poses_;  ///< The newest last.
};

/// A person with a foot on each of two Balance Boards, 2 cm apart, who steps and runs in place,
/// leans, and rises on the toes to jump. A plain value.
class BoardBody {
 public:
  BoardBody(const Style& style, std::uint64_t seed);

  void Advance(const Intention& wanted, double step_s);
  void Feel(Felt& felt) const;
  stream::Gait gesture() const { return gesture_; }
  double limb_hz() const { return rhythm_.activity() > 0.05 ? rhythm_.frequency_hz() : 0; }

 private:
  double RightShare() const;
  double Load(double bounce_mps2) const;
  void Rise(double step_s);

  Style style_;
  noise::Random random_;
  Rhythm rhythm_;
  Follower lean_m_;  ///< Shift of the COM, to the right.
  Follower run_;     ///< 0 stepping to 1 running.
  Follower toes_m_;  ///< COP, forward of where it is in standing.
  double sway_m_ = 0;
  double rises_s_ = -1;   ///< Since the jump's gesture began, standing included; negative: none.
  double rise_size_ = 1;  ///< As it was begun.
  double lift_mps2_ = 0;  ///< Acceleration of the COM in a heel rise.
  stream::Gait gesture_ = stream::Gait::kStep;
};

/// The body of a user of one interface: turns an intention into motion, and motion into what the
/// devices feel. Its own clock runs in even steps. A plain value.
class Person {
 public:
  static constexpr double kStepS = 0.0025;

  /// kUnspecified counts as the wrist. `turn_by` is what turns with the leg interface.
  Person(stream::UserInterface interface, const Style& style, std::uint64_t seed,
         stream::TurnSource turn_by = stream::TurnSource::kHead);

  /// Moves on to `time_s`; an earlier one changes nothing.
  void Advance(double time_s, const Intention& wanted);
  const Felt& felt() const { return felt_; }
  /// The gait that the motion now under way is meant to command: a jump's gesture is over before
  /// the user's wish for a jump is.
  stream::Gait gesture() const;
  /// Frequency of one limb, at its tempo now; 0: no limb swings.
  double limb_hz() const;

 private:
  std::variant<LimbBody, StickBody, BoardBody> body_;
  double time_s_ = 0;
  Felt felt_;
};

}  // namespace footing::users

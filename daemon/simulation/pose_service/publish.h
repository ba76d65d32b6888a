#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/base/result.h"
#include "common/board/geometry.h"
#include "common/body/body.h"
#include "common/runtime/subject.h"
#include "common/stream/character.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/reconstruction/insole_walk.h"
#include "daemon/simulation/reconstruction/reconstruction.h"
#include "footing/v1/character.pb.h"

namespace footing::pose_service {

/// Sensors that the pose follows.
enum class PoseSource { kBoards, kInsoles };

/// Why a Wiimote that is there does not measure how its arm is held.
enum class HandTrouble {
  kNone,
  kNoModel,      ///< No arm.fmodel.
  kNoGyroscope,  ///< No MotionPlus in it.
  kSilent,       ///< Nothing comes from it.
  kAwaitsTPose,  ///< It was not heard for a while: how it has turned is not known.
  kOneStrap,     ///< It is strapped on the upper arm or the forearm, and the other one is missing.
};

/// Inputs of the pose engine, with where they came from. Fixed size.
struct PoseInputs {
  reconstruction::Inputs sensors;  ///< Its time is set by the engine's own steps.
  /// Impulses of the boards, whose newest samples are in `sensors`. Where both are valid, these
  /// count.
  std::array<board::BoardImpulse, momentum::kFeet> impulses;
  /// Cells in the shoes, where there are any. While one of them sends anything, they are followed
  /// instead of the boards.
  std::array<reconstruction::InsoleFoot, momentum::kFeet> insoles;
  std::array<HandTrouble, reconstruction::kHands> hand_trouble{};  ///< For people only.
  /// Worn sensors that are heard and do not know yet which way they face; for people only.
  std::array<bool, reconstruction::kBodySites> turn_awaits{};
  bool simulated = false;  ///< A simulated device is behind any of it.
  std::uint64_t sensor_epoch = 0;
  std::uint64_t sensor_sequence = 0;
  std::uint64_t calibrate_number = 0;  ///< T-poses asked for so far.
  std::uint64_t subject_number = 0;    ///< Subjects so far.
};

/// Inputs as they took effect: from this step on.
struct PoseApplied {
  std::uint64_t step = 0;
  PoseInputs inputs;
};

inline constexpr std::size_t kMaxLinks = 96;
inline constexpr int kMaxPoseApplied = 4;

/// Which inputs a frame has, and what is wrong with them.
struct PoseInputStatus {
  bool simulated = false;
  PoseSource source = PoseSource::kBoards;
  bool insoles_await = false;  ///< They measure, and take a T-pose of their own; boards go on.
  bool insoles_idle = false;   ///< They measure, but this mode or lag cannot follow them.
  std::array<bool, momentum::kFeet> feet_measured{};       ///< By the source, now.
  std::array<double, momentum::kFeet> load_n{};            ///< By the source, calibrated or not.
  std::array<bool, momentum::kFeet> at_edge{};             ///< The COP is at the edge of a board.
  std::array<bool, reconstruction::kHands> hands_valid{};  ///< Their places are measured,
  std::array<bool, reconstruction::kHands> arms_valid{};   ///< or how their arms are held.
  std::array<HandTrouble, reconstruction::kHands> hand_trouble{};
  std::array<bool, reconstruction::kBodySites> turn_awaits{};
  /// Tracked, and not where a T-pose has them: it is not taken while one of them is.
  std::array<bool, reconstruction::kHands> hands_off_t_pose{};
};

/// How far the T-pose has come.
struct TPoseStatus {
  bool complete = false;
  double progress = 0;
  std::uint32_t restarts = 0;
  double mass_kg = 0;  ///< As weighed; 0 before.
};

/// Links of the subject's skeleton.
struct PoseLinks {
  std::size_t count = 0;
  std::array<stream::LinkPose, kMaxLinks> pose;
  std::array<double, kMaxLinks> sd_m{};
  reconstruction::AngleSd angle_sd_rad = reconstruction::UnknownAngles();
};

/// Frame that the simulation thread hands over at every frame of the pose engine. Fixed size:
/// filling and moving it allocates nothing.
struct PoseFrame {
  std::uint64_t step = 0;
  double time_s = 0;
  std::uint64_t overruns = 0;
  std::uint64_t left_out = 0;  ///< Frames that were due and are not published.
  std::uint64_t subject_number = 0;
  std::uint64_t state_hash = 0;  ///< Hash of the pose's coordinates, bit for bit.
  PoseInputStatus input;
  TPoseStatus t_pose;

  bool valid = false;
  double lag_s = 0;
  std::uint32_t resets = 0;
  momentum::Estimate momentum;
  PoseLinks links;
  double solve_us = 0;  ///< CPU time of the newest step.

  std::array<PoseApplied, kMaxPoseApplied> applied;  ///< Since the last frame.
  int applied_count = 0;
};

using subject::Subject;

/// The standard person of the subject's height, weight and feet. A weight that is not known is
/// 22.5 kg/m^2 until the T-pose has weighed it.
Result<body::Body> MakeSubjectBody(const Subject& subject);

/// From a frame of the pose engine to the message of the protocol. `options`: the
/// mode, `tracker` the name of who tracks the hands.
v1::CharacterFrame ToCharacterFrame(const PoseFrame& frame, const Subject& subject,
                                    const reconstruction::Options& options,
                                    const std::string& world, const std::string& rig,
                                    const std::string& tracker = "");

/// One link a joint; its size is that of a ball about the joint that the limbs end in.
stream::Skeleton ToSkeleton(const body::Body& body);

/// Events that a person should learn once, from one frame to the next: boards or insoles lost and
/// back and which of them is followed, Wiimotes lost and back, a T-pose asked for and taken, the
/// next subject, filters that were reset.
class PoseEvents {
 public:
  /// Events since the last call's frame.
  v1::Events Between(const PoseFrame& frame, const Subject& subject, std::int64_t now_ns);

 private:
  void AddHands(const PoseFrame& frame, std::int64_t now_ns, v1::Events& events);

  std::array<HandTrouble, reconstruction::kHands> hand_trouble_{};
  bool has_last_ = false;
  bool measured_ = false;
  PoseSource source_ = PoseSource::kBoards;
  bool calibrated_ = false;
  std::uint64_t subject_number_ = 0;
  std::uint32_t resets_ = 0;
};

/// Further than this from the subject file, the weight on the boards is another person's, or a
/// board needs its tare.
inline constexpr double kMassTolerance = 0.03;

/// Why there is no measurement of the hand of that side ("left").
std::string HandText(HandTrouble trouble, const std::string& side);

/// Text for a person: the problem and what to do about it; empty when all is well.
std::string PoseNote(const PoseFrame& frame, const Subject& subject);

}  // namespace footing::pose_service

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/runtime/latest.h"
#include "daemon/simulation/pose_service/pose_arms.h"
#include "daemon/simulation/pose_service/pose_frame.h"
#include "daemon/simulation/pose_service/tracked_hand.h"
#include "daemon/simulation/reconstruction/hand_track.h"
#include "footing/v1/command.pb.h"
#include "footing/v1/session.pb.h"

namespace footing::pose_service {

/// Turns ticks of the sensor daemon into inputs of the pose engine, on the io thread: the newest
/// raw sample of the rig's left and right board with its cells' places in W and what they have felt
/// so far, of its insoles, of its hands and of the joints of its skeleton as they have gone on
/// since the tracker saw them, and how its arms are held by the Wiimotes on them.
///
/// Two boards in the layout of one are not followed: they would be in one place.
/// A board or an insole without samples, or a hand or joint not seen, for longer than its timeout
/// is not valid, which is not the same as no load. A joint that its tracker looked for and did not
/// see is not valid from then on. Hands of several trackers are fused (TrackedHand); joints are
/// those of one tracker, as long as it reports any. Samples that are not finite count as none.
class PoseSensors {
 public:
  static constexpr double kBoardTimeoutS = 0.2;
  static constexpr double kHandTimeoutS = kPointTimeoutS;
  static constexpr double kInsoleTimeoutS = 0.2;

  /// `rig` empty: the first rig with a board or an insole. Without an arm model Wiimotes are
  /// not used.
  PoseSensors(std::string rig, exchange::Latest<PoseInputs>& out,
              std::optional<arms::ArmModel> arm = std::nullopt);

  void OnTick(const v1::Tick& tick, std::int64_t now_ns);
  /// What the engine says of its T-pose, frame by frame: Wiimotes are aligned by it.
  void Follow(const PoseFrame& frame) {
    arms_.Follow(frame.t_pose.complete, frame.t_pose.progress);
  }
  void Calibrate();
  void TakeSubject(std::uint64_t number);

  const std::string& rig() const { return followed_rig_; }
  const PoseInputs& inputs() const { return inputs_; }
  /// Names of who tracked the hands last, "camera, kinect"; empty: nobody has.
  const std::string& tracker() const { return tracker_; }
  /// Why the boards are not followed although they are there, for a person; empty: they are.
  const std::string& board_problem() const { return board_problem_; }

 private:
  struct Board {
    bool bound = false;  ///< A device has the role.
    bool attached = false;
    std::uint32_t device = 0;
    bool seen = false;
    std::int64_t seen_ns = 0;
    bool simulated = false;
    board::ImpulseMeter meter;
  };
  /// A joint or an insole.
  struct BodySource {
    bool seen = false;
    std::int64_t seen_ns = 0;
    bool simulated = false;
  };

  void Bind(const v1::DeviceStatusList& status);
  void BindArms(const v1::DeviceStatusList& status);
  void BindMoves(const v1::DeviceStatusList& status);
  /// Puts the cells where the followed rig's boards have them.
  void Place(const v1::SetupState& setup);
  void CheckLayout();
  void TakeBoard(const v1::BoardSample& sample, std::int64_t now_ns);
  /// `age_s` of its exposure.
  void TakeHand(const v1::HandSample& sample, double age_s, std::int64_t now_ns);
  void TakeJoint(const v1::HandSample& sample, double age_s, std::int64_t now_ns);
  /// Whether the joints of this tracker are followed: another one's are once it is silent.
  bool FollowsJointsOf(const std::string& tracker, std::int64_t now_ns);
  void TakeInsole(const v1::ContactSample& sample, std::int64_t now_ns);
  void DropOld(std::int64_t now_ns);
  void ReportHands(std::int64_t now_ns, std::int64_t host_ns);

  const std::string wanted_rig_;
  std::string followed_rig_;
  exchange::Latest<PoseInputs>& out_;
  std::array<Board, momentum::kFeet> boards_{};
  std::array<TrackedHand, reconstruction::kHands> hands_{};
  std::array<BodySource, momentum::kFeet> insoles_{};
  std::array<BodySource, stream::kBodyJoints> joints_{};
  std::array<reconstruction::HandTrack, stream::kBodyJoints> joint_tracks_ =
      reconstruction::JointTracks();
  std::string tracker_;
  std::string joint_tracker_;  ///< Whose joints are followed.
  std::int64_t joint_tracker_ns_ = 0;
  v1::SetupState setup_;  ///< As published last.
  stream::BoardLayout layout_;
  std::string board_problem_;
  PoseArms arms_;
  PoseInputs inputs_;
};

}  // namespace footing::pose_service

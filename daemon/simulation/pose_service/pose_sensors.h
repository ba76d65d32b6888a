#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "common/rig/follower.h"
#include "common/runtime/exchange.h"
#include "daemon/simulation/pose/arm_tracker.h"
#include "daemon/simulation/pose/inertial_track.h"
#include "daemon/simulation/pose_service/publish.h"
#include "daemon/simulation/reconstruction/subject_model.h"
#include "footing/v1/session.pb.h"

namespace footing::pose_service {

/// How both arms are held by what the Wiimotes in the fists, or strapped on upper arms and
/// forearms, measure (docs/hands.md), on the io thread: the same arms::ArmTracker that footing-eval
/// runs. A Wiimote in a fist points forward with its buttons up in the T-pose, a strapped one along
/// the arm to the hand.
///
/// The gyroscope's own bias of the T-pose is taken off, not what footingd holds for it: a hand that
/// turns slowly and evenly looks like one at rest to footingd. A Wiimote that is not heard for
/// longer than kTimeoutS may have turned anywhere: it counts for nothing until the next T-pose.
class PoseArms {
 public:
  static constexpr double kTimeoutS = 0.2;

  /// Fists are estimated only with a model, in paper mode only with a network.
  explicit PoseArms(std::optional<arms::ArmModel> model,
                    std::optional<arm_network::ArmNetwork> network = std::nullopt);

  /// Whether the network of paper mode says how arms are held, or the regression.
  void UseNetwork(bool use);

  /// Whether the rig has a Wiimote there, and which device it is.
  void Bind(std::size_t side, std::optional<std::uint32_t> device,
            arms::Place place = arms::Place::kFist);
  void Take(const stream::MotionSample& sample, std::int64_t now_ns);
  /// Takes in the engine's report on its T-pose.
  void Follow(bool calibrated, double calibration_progress);
  /// Puts the arms and what is wrong with them into the inputs; times go forward.
  void Report(std::int64_t now_ns, PoseInputs& inputs);

 private:
  struct Device {
    std::optional<std::uint32_t> device;
    rig::LastHeard heard, turned;  ///< Any sample; one with an angular velocity.
    std::int64_t sampled_ns = 0;   ///< Time of the last one with an angular velocity.
  };
  void Take(const stream::MotionSample& sample, std::int64_t now_ns, std::size_t side,
            std::size_t place);
  HandTrouble TroubleOf(std::size_t side, std::size_t place, std::int64_t now_ns) const;
  /// Trouble of the devices that the arm has.
  HandTrouble TroubleOf(std::size_t side, std::int64_t now_ns) const;

  std::optional<arms::ArmModel> model_;
  std::optional<arm_network::ArmNetwork> network_;
  bool uses_network_ = false;
  arms::ArmTracker tracker_;
  std::array<std::array<Device, arms::kPlaces>, arms::kArms> devices_{};  ///< By arms::Place.
  bool calibrated_ = false;
  double progress_ = 0;
  std::int64_t reported_ns_ = 0;
};

/// How segments have turned since the T-pose by the devices worn on them, of any kind that has a
/// gyroscope, in the roles pelvis (on a belt), trunk (chest), head, and of each side thigh and leg
/// (shank), and by PS Moves and Wiimotes in the hands, which count at once. A device counts from
/// the first squat after the T-pose on (arms::SegmentAttitude), which the loads show. One that is
/// not heard for longer than PoseArms::kTimeoutS counts for nothing until the next T-pose.
class PoseSegments {
 public:
  PoseSegments();
  /// Which device is worn there.
  void Bind(reconstruction::BodySite site, std::optional<std::uint32_t> device);
  void Take(const stream::MotionSample& sample, std::int64_t now_ns);
  /// Takes in the engine's report on its T-pose, and on the body.
  void Follow(bool calibrated, double calibration_progress, const momentum::Estimate& body);
  /// Puts what they show into the inputs.
  void Report(std::int64_t now_ns, PoseInputs& inputs) const;

 private:
  struct Sensor {
    std::optional<std::uint32_t> device;
    rig::LastHeard heard;
    std::int64_t sampled_ns = 0;
    arms::SegmentAttitude attitude;
  };

  std::array<Sensor, reconstruction::kBodySites> sensors_;
  bool calibrated_ = false, squats_ = false;
  double progress_ = 0, t_pose_height_m_ = 0;
};

/// A point that is not heard of for longer counts as not seen.
inline constexpr double kPointTimeoutS = 0.15;

/// A tracked point with the deviations that count: no point is known better than to 2 mm, and its
/// information is the tracker's times its confidence, which a light at the sensor's limit lowers.
struct CountedPoint {
  Eigen::Vector3d p_W_m, sd_m, covariance_m2;
  Eigen::Matrix3d matrix_m2;  ///< The same covariance without that limit.

  explicit CountedPoint(const stream::HandSample& sample);
};

/// Whether the sample is of a point that was seen and whose place is in W: a tracker without
/// calibration reports places in its own frame.
bool IsSeenInWorld(const stream::HandSample& sample);

/// One hand as several trackers see it: a HandTrack for each of them, fused by their covariances.
/// Where they contradict each other the fused covariance grows with the contradiction (Birge's
/// ratio). At most kMostTrackers at once; another one replaces the one that was heard longest ago.
/// A camera's observations of a PS Move's sphere are joined to the Move's own readings
/// (inertial::Track) while there are any. A value.
class TrackedHand {
 public:
  static constexpr std::size_t kMostTrackers = 4;

  /// The PS Move in this hand, if there is one. Another one starts again.
  void Bind(std::optional<std::uint32_t> move);
  /// Nothing but for samples of that Move that have units.
  void Feel(const stream::MotionSample& sample);

  /// A sample by IsSeenInWorld, exposed then.
  void Add(const stream::HandSample& sample, double exposed_s, std::int64_t now_ns);

  struct Fused {
    reconstruction::HandInput hand;  ///< Invalid where no tracker has it.
    bool simulated = false;          ///< One of its trackers is.
    std::set<std::string> trackers;  ///< Their names.
  };
  /// Position fused from the trackers that have seen it lately. `host_ns`: the same instant by the
  /// clock of the samples' own times.
  Fused At(std::int64_t now_ns, std::int64_t host_ns = 0) const;

 private:
  struct Source {
    std::string tracker;
    rig::LastHeard heard;
    reconstruction::HandTrack track;
  };
  Source& SourceOf(const std::string& tracker);
  /// By the Move's readings and what that source sees of it. Invalid without either.
  reconstruction::HandInput Inertial(const Source& source, std::int64_t host_ns) const;

  std::array<Source, kMostTrackers> sources_;
  std::optional<std::uint32_t> move_;
  std::optional<inertial::Track> inertial_;  ///< From the Move's first sample on.
};

/// Turns ticks of the sensor daemon into inputs of the pose engine, on the io thread: the newest
/// raw sample of the rig's left and right board with its cells' places in W and what they have felt
/// so far, of its insoles, of its hands and of the joints of its skeleton as they have gone on
/// since the tracker saw them, and how its arms are held and its segments turned by the devices on
/// them.
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
              std::optional<arms::ArmModel> arm = std::nullopt,
              std::optional<arm_network::ArmNetwork> paper_arm = std::nullopt);

  /// Takes in a tick and hands the inputs over.
  void OnTick(const v1::Tick& message, std::int64_t now_ns);
  /// Takes in the engine's report on its T-pose, frame by frame: Wiimotes are aligned by it.
  void Follow(const PoseFrame& frame) {
    arms_.Follow(frame.t_pose.complete, frame.t_pose.progress);
    segments_.Follow(frame.t_pose.complete, frame.t_pose.progress, frame.momentum);
  }
  /// Asks the engine for a new T-pose.
  void Calibrate();
  /// Number of the subject that the next inputs are for.
  void TakeSubject(std::uint64_t number);
  /// Mode of the engine: arms with a Wiimote in the fist are estimated as it has it.
  void TakeMode(reconstruction::Mode mode) {
    arms_.UseNetwork(mode == reconstruction::Mode::kPaper);
  }

  const std::string& rig() const { return follower_.rig(); }
  const PoseInputs& inputs() const { return inputs_; }
  /// Names of who tracked the hands last, "camera, kinect"; empty: nobody has.
  const std::string& tracker() const { return tracker_; }
  /// Why the boards are not followed although they are there, for a person; empty: they are.
  const std::string& board_problem() const { return board_problem_; }

 private:
  struct Board {
    std::optional<std::uint32_t> device;  ///< The device that has the role.
    rig::LastHeard heard;
    board::ImpulseMeter meter;
  };

  /// Looks up which devices have the roles, and where the boards lie.
  void Bind();
  void TakeBoard(const stream::BoardSample& sample, std::int64_t now_ns);
  /// `age_s` of its exposure.
  void TakeHand(const stream::HandSample& sample, double age_s, std::int64_t now_ns);
  void TakeJoint(const stream::HandSample& sample, double age_s, std::int64_t now_ns);
  /// Whether the joints of this tracker are followed: another one's are once it is silent.
  bool FollowsJointsOf(const std::string& tracker, std::int64_t now_ns);
  void TakeInsole(const stream::ContactSample& sample, std::int64_t now_ns);
  void DropOld(std::int64_t now_ns);
  void ReportHands(std::int64_t now_ns, std::int64_t host_ns);

  rig::Follower follower_;
  exchange::Latest<PoseInputs>& out_;
  std::array<Board, momentum::kFeet> boards_{};
  std::array<TrackedHand, reconstruction::kHands> hands_{};
  std::array<rig::LastHeard, momentum::kFeet> insoles_{};
  std::array<rig::LastHeard, stream::kBodyJoints> joints_{};
  std::array<reconstruction::HandTrack, stream::kBodyJoints> joint_tracks_ =
      reconstruction::JointTracks();
  std::string tracker_;
  std::string joint_tracker_;  ///< Tracker whose joints are followed.
  rig::LastHeard joint_tracker_heard_;
  std::string board_problem_;
  PoseArms arms_;
  PoseSegments segments_;
  PoseInputs inputs_;
};

}  // namespace footing::pose_service

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "daemon/offline/learning/horizontal_com.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/offline/learning/time_alignment.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::learning {

/// How the floor of one recording lies in that of another: turned about the vertical, then moved.
struct FloorPlacement {
  double yaw_rad = 0;
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  double rms_m = 0;         ///< Residual of the points that count.
  Eigen::Index points = 0;  ///< Points that count.
};

/// Least squares of `from` on `to`, a column a pair, without the pairs that are left far off: feet
/// beyond a board's edge. There must be three pairs.
FloorPlacement PlaceFloor(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to);

/// The motion turned and moved as a whole.
motion::Motion Placed(const motion::Motion& motion, const FloorPlacement& placement);

/// A recording of boards and the motion that was captured beside it, on one clock and one floor.
struct OwnTake {
  RecordedSession session;
  momentum::TPose t_pose;
  body::Body body;        ///< Scaled to the weight in the T-pose.
  motion::Motion motion;  ///< In W of the boards.
  TimeAlignment alignment;
  FloorPlacement placement;

  /// Where the recording has the motion's first frame and its end.
  double from_s() const { return alignment.ToRecording(0); }
  double to_s() const { return alignment.ToRecording(motion.duration_s() - 1 / motion.rate_hz); }
};

/// Puts them on one clock (AlignInTime) and one floor: the motion is turned and moved so that its
/// feet press where the boards were pressed. `motion` lies on any floor, `person` is of its
/// skeleton. InvalidData: no T-pose, stomps or forces that do not go together, boards that lie
/// otherwise than the feet stand.
Result<OwnTake> MakeOwnTake(RecordedSession session, motion::Motion motion,
                            const body::Body& person, const std::string& motion_name);

/// All of it in the mirror at the plane y = 0. InvalidData where the mirrored skeleton is not
/// a person.
Result<OwnTake> MirrorImage(const OwnTake& take);

/// The measured loads with the COM of the motion, momentum::kNetworkRateHz, both counted from half
/// way between the feet's COPs in the T-pose; a clip for each span in which both boards speak.
std::vector<LoadClip> OwnLoads(const OwnTake& take);

/// Settings of the examples made from an own take.
struct OwnExampleSettings {
  PoseCues cues = PoseCues::kMomentum;
  double rate_hz = 60;
  double hand_noise_m = 0.01;  ///< Noise of the motion's fists, where no tracker measured hands.
  double piece_s = 10;         ///< Frames of one piece are in one fold,
  int first_piece = 0;         ///< numbered from here on.
  double settled_s = 1.5;      ///< After the T-pose and the motion's first frame: left out.
  std::uint64_t seed = 1;
};

/// Appends what the reconstruction would have estimated from the recording, with the poses of the
/// motion. InvalidData when there is no frame of both.
Result<void> AddOwnExamples(const OwnTake& take, const reconstruction::Models& basis,
                            const OwnExampleSettings& settings, PoseExamples& examples);

}  // namespace footing::learning

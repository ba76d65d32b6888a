#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/plot/line_plot.h"
#include "common/stream/hands.h"
#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::eval {

/// Output of a fusion trial.
struct FusionReport {
  nlohmann::ordered_json json;
  std::string figure;  ///< SVG: Figure 7 of the pose paper.
};

/// A person under boards and a simulated Kinect that loses a part of them, against the truth, four
/// ways: (a) the skeleton as it is, at its exposure, (b) the same skeleton solved for the most
/// likely pose, (c) boards and hands, and (d) boards, hands and joints, both by the engine that the
/// product runs (pose paper, section 7.3); the fields of `footing-eval fusion`. `run` has a
/// Kinect's joints.
Result<FusionReport> RunFusionTrial(const pose_run::PoseRun& run,
                                    const reconstruction::Models& models,
                                    const reconstruction::Options& options);

/// footing-eval fusion: a camera's skeleton and the boards, in squats that hide the legs.
void AddFusionCommand(CLI::App& app, Shared& shared);

/// Where a way has the joints of a skeleton, by body::IndexOf.
using JointPlaces = std::array<Eigen::Vector3d, stream::kBodyJoints>;

/// Errors of one way, cm: of hips and knees while the person squats, of any joint while the camera
/// infers it, and of those that it sees.
class FusedScore {
 public:
  void Add(const JointPlaces& truth, const JointPlaces& places,
           const std::array<bool, stream::kBodyJoints>& hidden, bool squats);
  double hip_cm() const { return hips_.mean(); }
  double knee_cm() const { return knees_.mean(); }
  double hidden_cm() const { return hidden_.mean(); }
  nlohmann::ordered_json Json() const;

 private:
  /// Why the knee of one side is off.
  void AddKnee(const JointPlaces& truth, const JointPlaces& places, std::size_t side);

  Spread hips_, knees_, hidden_, arms_, legs_, seen_, seen_arms_;
  Spread hip_heights_, feet_, turns_, unturned_;  ///< While the person squats.
};

/// Joints of a leg, W, m.
struct LegPlaces {
  Eigen::Vector3d hip, knee, ankle;
};

/// Why an estimated knee is off: a knee lies on a circle about the line from hip to ankle.
struct KneeError {
  double turn_rad = 0;    ///< Along that circle, from the truth, by the right-hand rule.
  double unturned_m = 0;  ///< Remaining distance with the knee turned back along it.
};

/// The circle of the truth is moved onto that of the estimate by the shortest rotation of the line.
/// A leg that is straight has no circle: the turn is 0.
KneeError SplitKneeError(const LegPlaces& truth, const LegPlaces& estimate);

/// The joints of a skeleton, and both hands.
struct StickPlaces {
  JointPlaces joints;
  std::array<Eigen::Vector3d, 2> hands;
};

/// Lines between them, seen from the front left.
plot::Sticks SticksOf(const StickPlaces& places);

/// Figure 7 of the pose paper: in the moment that hides most, the skeleton alone and what is made
/// of it with the boards, each over the truth. A moment is a squat, or any other in which joints
/// are inferred.
class Figure7 {
 public:
  struct Moment {
    double weight = 0;  ///< How much it shows: the one of most weight is drawn.
    double time_s = 0;
    int hidden = 0;
    StickPlaces truth, alone, fused;
  };

  void AddSquat(const Moment& moment) { Keep(moment, squat_); }
  void AddOther(const Moment& moment) { Keep(moment, other_); }
  std::string Svg() const;

 private:
  static void Keep(const Moment& moment, std::optional<Moment>& best) {
    if (!best || moment.weight > best->weight) best = moment;
  }

  std::optional<Moment> squat_, other_;
};

}  // namespace footing::eval

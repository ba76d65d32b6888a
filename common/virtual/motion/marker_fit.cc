#include "common/virtual/motion/marker_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/rotation.h"
#include "common/base/text.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/markers.h"

namespace footing::motion {
namespace {

using body::Landmark;
using body::PointTarget;

constexpr Eigen::Index kCalibrationFrames = 60;  // That place the markers on the segments.
constexpr int kRounds = 3;                       // Poses from places, then places from poses.
constexpr std::size_t kLeastMarkers = 10;        // Markers of a frame.
constexpr double kLongestHeldS = 1;              // A pose, in place of those not seen.
constexpr double kLeastSine = 0.17;              // Sine of a limb's bend that counts: 10 degrees.
// Cost of moving a joint, m/rad: limbs hardly anything from the frame before; of the back, the
// neck, the shoulder girdle and what lies beyond the last markers, a centimetre for a large bend.
constexpr double kHoldLimb = 0.002, kHoldSpine = 0.05;

std::size_t MarkerIndex(int value) { return static_cast<std::size_t>(value); }

/// Markers fixed to joints, and the track that each of them has.
struct AttachedMarkers {
  std::vector<FittedMarker> markers;
  std::vector<std::size_t> tracks;
};

/// Frames of a trial, spread over it, and the pose of each.
struct PosedFrames {
  std::vector<Eigen::Index> frames;
  std::vector<Eigen::VectorXd> poses;
};

class Fitter {
 public:
  Fitter(const body::Skeleton& skeleton, const body::Landmarks& landmarks)
      : skeleton_(skeleton),
        landmarks_(landmarks),
        fit_(skeleton),
        at_(skeleton),
        hold_(Eigen::VectorXd::Constant(skeleton.dof, kHoldLimb)) {
    // Joints between the segments that carry markers: they share a bend.
    hold_.head<3>().setZero();
    for (int joint = landmarks[Landmark::kVertex]; joint > 0;
         joint = skeleton.joint(joint).parent) {
      Hold(joint, kHoldSpine);
    }
    for (Landmark l : {Landmark::kLeftClavicle, Landmark::kRightClavicle, Landmark::kLeftWrist,
                       Landmark::kRightWrist, Landmark::kLeftToe, Landmark::kRightToe}) {
      Hold(landmarks[l], kHoldSpine);
    }
  }

  /// The pose of a frame from its joint centres; starts upright, facing as the hips do.
  bool PoseOfCentres(const Centres& centres, Eigen::VectorXd& q) {
    const auto& left = centres[static_cast<std::size_t>(Landmark::kLeftHip)];
    const auto& right = centres[static_cast<std::size_t>(Landmark::kRightHip)];
    if (!left || !right) return false;
    const Eigen::Vector3d across = *left - *right;
    q = body::TPose(skeleton_, landmarks_);
    q(3) = std::atan2(-across.x(), across.y());
    ComputeKinematics(skeleton_, q, at_);
    const Eigen::Vector3d middle = (at_.p_WJ[MarkerIndex(landmarks_[Landmark::kLeftHip])] +
                                    at_.p_WJ[MarkerIndex(landmarks_[Landmark::kRightHip])]) /
                                   2;
    q.head<3>() += (*left + *right) / 2 - middle;
    for (const int side : {0, 1}) {
      Bend(centres, side, {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle}, q);
      Bend(centres, side, {Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist}, q);
    }
    targets_.clear();
    for (int i = 0; i < body::kLandmarkCount; ++i) {
      const auto landmark = static_cast<Landmark>(i);
      const auto& centre = centres[MarkerIndex(i)];
      if (!centre || landmarks_[landmark] < 0 || landmark == Landmark::kHips) continue;
      // A neck or a hand is not quite where its markers are.
      const bool rough = landmark == Landmark::kNeck || landmark == Landmark::kHead ||
                         landmark == Landmark::kLeftHandEnd || landmark == Landmark::kRightHandEnd;
      targets_.push_back({landmarks_[landmark], Eigen::Vector3d::Zero(), *centre, rough ? 0.1 : 1});
    }
    fit_.Fit(targets_, {.iterations = 60}, q);
    return true;
  }

  /// The pose of a frame from its markers, from `q` on; false where too few were seen.
  bool PoseOfMarkers(const MarkerTracks& tracks, const AttachedMarkers& attached,
                     Eigen::Index frame, Eigen::VectorXd& q) {
    targets_.clear();
    for (std::size_t i = 0; i < attached.markers.size(); ++i) {
      const FittedMarker& marker = attached.markers[i];
      const Eigen::Vector3d p_W = tracks.p[attached.tracks[i]].col(frame);
      if (Seen(p_W)) targets_.push_back({marker.joint, marker.p_J, p_W, 1});
    }
    if (targets_.size() < kLeastMarkers) return false;
    neutral_ = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (hold_(i) == kHoldSpine) neutral_(i) = 0;
    }
    fit_.Fit(targets_, {.iterations = 20, .hold = &hold_, .neutral = &neutral_}, q);
    return true;
  }

  /// A place in a joint's frame, and back.
  Eigen::Vector3d Local(int joint, const Eigen::Vector3d& p_W) const {
    return at_.R_WJ[MarkerIndex(joint)].transpose() * (p_W - at_.p_WJ[MarkerIndex(joint)]);
  }
  Eigen::Vector3d World(int joint, const Eigen::Vector3d& p_J) const {
    return at_.p_WJ[MarkerIndex(joint)] + at_.R_WJ[MarkerIndex(joint)] * p_J;
  }
  void Place(const Eigen::VectorXd& q) { ComputeKinematics(skeleton_, q, at_); }

 private:
  /// Turns a limb so that its upper bone points as the centres do and its hinge bends in their
  /// plane. From a T-pose the fit would else bend a guard's elbows the wrong way round.
  void Bend(const Centres& centres, int side, const std::array<Landmark, 3>& left,
            Eigen::VectorXd& q) {
    std::array<int, 3> joints;
    std::array<Eigen::Vector3d, 3> places;
    for (std::size_t i = 0; i < 3; ++i) {
      const Landmark landmark = body::OfSide(left[i], side);
      const auto& centre = centres[static_cast<std::size_t>(landmark)];
      if (!centre) return;
      joints[i] = landmarks_[landmark];
      places[i] = *centre;
    }
    Place(q);
    const body::Joint &upper = skeleton_.joint(joints[0]), &hinge = skeleton_.joint(joints[1]);
    const Eigen::Vector3d bone = (places[1] - places[0]).normalized();
    const Eigen::Vector3d across = bone.cross((places[2] - places[1]).normalized());
    const double sine = across.norm();
    const Eigen::Vector3d now = at_.p_WJ[MarkerIndex(joints[1])] - at_.p_WJ[MarkerIndex(joints[0])];
    const Eigen::Vector3d axis = at_.axis_W[MarkerIndex(hinge.first_dof)];
    // A straight limb says nothing of the plane: its bone is turned the shortest way.
    const Eigen::Matrix3d turn = sine > kLeastSine
                                     ? Frame(bone, across) * Frame(now, axis).transpose()
                                     : LeastTurn(now, bone).toRotationMatrix();
    const Eigen::Matrix3d& R_WP = at_.R_WJ[MarkerIndex(upper.parent)];
    body::SetJointRotation(upper, R_WP.transpose() * turn * at_.R_WJ[MarkerIndex(joints[0])], q);
    q(hinge.first_dof) = std::atan2(sine, bone.dot((places[2] - places[1]).normalized()));
  }
  /// Right-handed, with its first axis along `along` and the second near `aside`.
  static Eigen::Matrix3d Frame(const Eigen::Vector3d& along, const Eigen::Vector3d& aside) {
    Eigen::Matrix3d frame;
    frame.col(0) = along.normalized();
    frame.col(1) = (aside - frame.col(0) * frame.col(0).dot(aside)).normalized();
    frame.col(2) = frame.col(0).cross(frame.col(1));
    return frame;
  }
  void Hold(int index, double hold) {
    const body::Joint& joint = skeleton_.joint(index);
    hold_.segment(joint.first_dof, static_cast<Eigen::Index>(joint.rotations.size()))
        .setConstant(hold);
  }

  const body::Skeleton& skeleton_;
  const body::Landmarks& landmarks_;
  body::PoseFit fit_;
  body::Kinematics at_;
  Eigen::VectorXd hold_, neutral_;
  std::vector<PointTarget> targets_;
};

std::vector<Eigen::Index> Spread(Eigen::Index frames, Eigen::Index most) {
  std::vector<Eigen::Index> spread;
  const Eigen::Index count = std::min(frames, most);
  for (Eigen::Index i = 0; i < count; ++i) spread.push_back(i * frames / count);
  return spread;
}

/// Fixes a marker to the carrier in whose frame it keeps still best over the poses.
FittedMarker Attach(Fitter& fitter, const std::vector<int>& carriers, const std::string& name,
                    const Eigen::Matrix3Xd& track, const PosedFrames& posed) {
  std::vector<Eigen::Vector3d> sums(carriers.size(), Eigen::Vector3d::Zero());
  std::vector<double> squares(carriers.size(), 0.0);
  double count = 0;
  for (std::size_t k = 0; k < posed.frames.size(); ++k) {
    const Eigen::Vector3d p_W = track.col(posed.frames[k]);
    if (!Seen(p_W)) continue;
    fitter.Place(posed.poses[k]);
    ++count;
    for (std::size_t c = 0; c < carriers.size(); ++c) {
      const Eigen::Vector3d p_J = fitter.Local(carriers[c], p_W);
      sums[c] += p_J;
      squares[c] += p_J.squaredNorm();
    }
  }
  FittedMarker best{name, -1, Eigen::Vector3d::Zero(), 0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < carriers.size() && count > 0; ++c) {
    const Eigen::Vector3d mean = sums[c] / count;
    // Where the trial hardly moves, the nearer segment.
    const double still = squares[c] / count - mean.squaredNorm() + 1e-3 * mean.squaredNorm();
    if (still < least) {
      least = still;
      best = {name, carriers[c], mean, 0};
    }
  }
  return best;
}

/// Poses from the joint centres of the frames in which the pelvis was seen.
PosedFrames PosesOfCentres(Fitter& fitter, const MarkerTracks& tracks, const MarkerSet& set) {
  PosedFrames posed;
  for (const Eigen::Index frame : Spread(tracks.frames(), kCalibrationFrames)) {
    Eigen::VectorXd q;
    if (!fitter.PoseOfCentres(JointCentres(tracks, set, frame), q)) continue;
    posed.frames.push_back(frame);
    posed.poses.push_back(std::move(q));
  }
  return posed;
}

/// Markers of which the set says where they sit do not jump; points without a name are anywhere.
Result<void> CheckSteps(const MarkerTracks& tracks, const MarkerCarriers& carriers) {
  for (std::size_t i = 0; i < tracks.p.size(); ++i) {
    if (carriers.known[i] < 0) continue;
    const Eigen::Matrix3Xd& p = tracks.p[i];
    for (Eigen::Index frame = 1; frame < p.cols(); ++frame) {
      const double step_m = (p.col(frame) - p.col(frame - 1)).norm();
      if (std::isnan(step_m)) continue;  // Not seen.
      auto good =
          CheckStep(step_m, tracks.rate_hz, tracks.start_s, frame, "marker " + tracks.names[i]);
      if (!good) return good;
    }
  }
  return {};
}

/// Where the markers sit: the poses place them, then they place the poses.
Result<AttachedMarkers> AttachMarkers(Fitter& fitter, const MarkerTracks& tracks,
                                      const MarkerCarriers& carriers, PosedFrames& posed) {
  AttachedMarkers attached;
  for (int round = 0; round < kRounds; ++round) {
    attached = {};
    for (std::size_t i = 0; i < tracks.names.size(); ++i) {
      FittedMarker marker = Attach(fitter, carriers.Of(i), tracks.names[i], tracks.p[i], posed);
      if (marker.joint < 0) continue;
      attached.markers.push_back(std::move(marker));
      attached.tracks.push_back(i);
    }
    if (attached.markers.size() < kLeastMarkers) {
      return InvalidData("fewer than ten markers were seen");
    }
    for (std::size_t k = 0; k < posed.frames.size(); ++k) {
      fitter.PoseOfMarkers(tracks, attached, posed.frames[k], posed.poses[k]);
    }
  }
  return attached;
}

/// The pose of every frame, each from the one before, and how far the markers are off.
void FitMotion(Fitter& fitter, const MarkerTracks& tracks, const AttachedMarkers& attached,
               Eigen::VectorXd q, MarkerFit& out) {
  out.motion.q.resize(out.motion.skeleton.dof, tracks.frames());
  out.markers = attached.markers;
  double sum = 0, count = 0;
  std::vector<double> counts(out.markers.size(), 0.0);
  for (Eigen::Index frame = 0; frame < tracks.frames(); ++frame) {
    fitter.PoseOfMarkers(tracks, attached, frame, q);
    out.motion.q.col(frame) = q;
    fitter.Place(q);
    for (std::size_t i = 0; i < out.markers.size(); ++i) {
      const Eigen::Vector3d p_W = tracks.p[attached.tracks[i]].col(frame);
      if (!Seen(p_W)) continue;
      const double square =
          (p_W - fitter.World(out.markers[i].joint, out.markers[i].p_J)).squaredNorm();
      out.markers[i].rms_m += square;
      ++counts[i];
      sum += square;
      ++count;
    }
  }
  for (std::size_t i = 0; i < out.markers.size(); ++i) {
    if (counts[i] > 0) out.markers[i].rms_m = std::sqrt(out.markers[i].rms_m / counts[i]);
  }
  if (count > 0) out.rms_m = std::sqrt(sum / count);
}

}  // namespace

Result<MarkerFit> FitMarkers(const MarkerTracks& tracks, const MarkerFitOptions& options) {
  const MarkerTracks& still = options.still != nullptr ? *options.still : tracks;
  const auto set = FindMarkerSet(still, options.set);
  if (!set) return set.error();
  if (const auto seen = CheckSeen(tracks, kLeastMarkers, kLongestHeldS); !seen) return seen.error();
  auto lengths = FitLengths(still, *set, options.sex);
  if (!lengths) return lengths.error();
  MarkerFit out;
  out.set = std::string(set->name);
  out.height_m = lengths->height_m;
  out.motion = {std::move(lengths->skeleton), tracks.rate_hz, tracks.start_s, {}};
  const auto landmarks = body::FindLandmarks(out.motion.skeleton);
  if (!landmarks) return landmarks.error();
  const MarkerCarriers carriers = FindCarriers(out.motion.skeleton, *landmarks, tracks, *set);
  if (const auto steady = CheckSteps(tracks, carriers); !steady) return steady.error();
  Fitter fitter(out.motion.skeleton, *landmarks);
  PosedFrames posed = PosesOfCentres(fitter, tracks, *set);
  if (posed.frames.empty()) return InvalidData("no frame has all the markers of the pelvis");
  const auto attached = AttachMarkers(fitter, tracks, carriers, posed);
  if (!attached) return attached.error();
  FitMotion(fitter, tracks, *attached, posed.poses.front(), out);
  return out;
}

namespace {

constexpr Eigen::Index kMostFrames = 400;              // Frames of a trial that its lengths take.
constexpr double kLeastRatio = 0.6, kMostRatio = 1.6;  // Ratio of a length to the standard one.

/// Medians of distances between centres over the frames in which both are there.
class Lengths {
 public:
  Lengths(const MarkerTracks& tracks, const MarkerSet& set) {
    const Eigen::Index step = std::max<Eigen::Index>(1, tracks.frames() / kMostFrames);
    for (Eigen::Index frame = 0; frame < tracks.frames(); frame += step) {
      frames_.push_back(JointCentres(tracks, set, frame));
    }
  }

  /// 0 where the two are never there together.
  double Between(Landmark a, Landmark b) const {
    return MedianOf([&](const Centres& centres) -> std::optional<double> {
      const auto& from = centres[static_cast<std::size_t>(a)];
      const auto& to = centres[static_cast<std::size_t>(b)];
      if (!from || !to) return std::nullopt;
      return (*from - *to).norm();
    });
  }
  double Trunk() const {
    return MedianOf([](const Centres& centres) -> std::optional<double> {
      const auto& left = centres[static_cast<std::size_t>(Landmark::kLeftShoulder)];
      const auto& right = centres[static_cast<std::size_t>(Landmark::kRightShoulder)];
      const auto& hips = centres[static_cast<std::size_t>(Landmark::kHips)];
      if (!left || !right || !hips) return std::nullopt;
      return ((*left + *right) / 2 - *hips).norm();
    });
  }

 private:
  template <typename F>
  double MedianOf(F length) const {
    std::vector<double> values;
    for (const Centres& centres : frames_) {
      if (const auto value = length(centres)) values.push_back(*value);
    }
    return text::Median(std::move(values));
  }

  std::vector<Centres> frames_;
};

/// Mean of both legs, m.
double LegLength(const Lengths& lengths) {
  double legs_m = 0;
  for (int side = 0; side < 2; ++side) {
    legs_m +=
        (lengths.Between(OfSide(Landmark::kLeftHip, side), OfSide(Landmark::kLeftKnee, side)) +
         lengths.Between(OfSide(Landmark::kLeftKnee, side), OfSide(Landmark::kLeftAnkle, side))) /
        2;
  }
  return legs_m;
}

/// Gives a skeleton the lengths between the joint centres.
class SkeletonScaling {
 public:
  SkeletonScaling(const Lengths& lengths, const body::Landmarks& landmarks,
                  body::Skeleton& skeleton)
      : lengths_(lengths), landmarks_(landmarks), skeleton_(skeleton) {}

  /// The bones of arms and legs; hips and shoulders as far apart as they were seen.
  void ScaleLimbs() {
    const double hips_m = lengths_.Between(Landmark::kLeftHip, Landmark::kRightHip);
    const double shoulders_m = lengths_.Between(Landmark::kLeftShoulder, Landmark::kRightShoulder);
    for (int side = 0; side < 2; ++side) {
      const auto here = [side](Landmark left) { return OfSide(left, side); };
      Stretch(here(Landmark::kLeftHip), here(Landmark::kLeftKnee));
      Stretch(here(Landmark::kLeftKnee), here(Landmark::kLeftAnkle));
      Stretch(here(Landmark::kLeftAnkle), here(Landmark::kLeftToe));
      Stretch(here(Landmark::kLeftShoulder), here(Landmark::kLeftElbow));
      Stretch(here(Landmark::kLeftElbow), here(Landmark::kLeftWrist));
      const double sign = side == 0 ? 1 : -1;
      Offset(landmarks_[here(Landmark::kLeftHip)]).y() = sign * hips_m / 2;
      if (shoulders_m > 0) {
        Offset(landmarks_[here(Landmark::kLeftShoulder)]).y() = sign * shoulders_m / 2;
      }
    }
  }

  /// The back, so that hips and shoulders are `trunk_m` apart.
  void ScaleBack(double trunk_m) {
    double back_m = 0;
    const int chest = landmarks_[Landmark::kLeftClavicle];
    for (int i = chest; i > 0; i = skeleton_.joint(i).parent) back_m += Offset(i).z();
    const double rest_m = Offset(landmarks_[Landmark::kLeftShoulder]).z() -
                          Offset(landmarks_[Landmark::kLeftHip]).z();
    if (!(trunk_m > 0 && back_m > 0)) return;
    const double ratio = std::clamp((trunk_m - rest_m) / back_m, kLeastRatio, kMostRatio);
    for (int i = chest; i > 0; i = skeleton_.joint(i).parent) {
      for (body::Joint& joint : skeleton_.joints) {  // All that hang on the same bone.
        if (joint.parent == skeleton_.joint(i).parent && joint.parent > 0 &&
            joint.offset_m == Offset(i) &&
            &joint != &skeleton_.joints[static_cast<std::size_t>(i)]) {
          joint.offset_m *= ratio;
        }
      }
      Offset(i) *= ratio;
    }
  }

  /// Bones of a length that no person has, and that length; empty when there are none.
  const std::string& impossible() const { return impossible_; }

 private:
  Eigen::Vector3d& Offset(int joint) {
    return skeleton_.joints[static_cast<std::size_t>(joint)].offset_m;
  }

  /// Stretches the bones from `of` (not itself) down to `to` by the ratio of their lengths.
  void Stretch(Landmark of, Landmark to) {
    const double measured_m = lengths_.Between(of, to);
    double standard_m = 0;
    const int from = landmarks_[of];
    for (int i = landmarks_[to]; i != from; i = skeleton_.joint(i).parent) {
      standard_m += Offset(i).norm();
    }
    double ratio = measured_m / standard_m;
    // A toe's marker is anywhere from the ball of the foot to the tip of the shoe.
    if (to == Landmark::kLeftToe || to == Landmark::kRightToe) ratio = std::clamp(ratio, 0.8, 1.4);
    if (measured_m == 0) return;  // Never seen: the standard one.
    if (!(ratio > kLeastRatio && ratio < kMostRatio)) {
      impossible_ += (impossible_.empty() ? "" : ", ") + std::string(LandmarkName(of)) + " to " +
                     std::string(LandmarkName(to)) + " " + std::to_string(measured_m) + " m";
      return;
    }
    for (int i = landmarks_[to]; i != from; i = skeleton_.joint(i).parent) Offset(i) *= ratio;
  }

  const Lengths& lengths_;
  const body::Landmarks& landmarks_;
  body::Skeleton& skeleton_;
  std::string impossible_;
};

}  // namespace

Result<FittedSkeleton> FitLengths(const MarkerTracks& tracks, const MarkerSet& set, body::Sex sex) {
  const Lengths lengths(tracks, set);
  const double trunk_m = lengths.Trunk();
  const double height_m = body::StatureOfLengths(sex) * (LegLength(lengths) + trunk_m);
  if (!(height_m > 0.5 && height_m < 2.6)) {
    return InvalidData("the joint centres make a person of " + std::to_string(height_m) +
                       " m: are the markers in W (z up), and of that set?");
  }
  FittedSkeleton fitted{body::StandardPerson(height_m, sex), height_m};
  const auto landmarks = body::FindLandmarks(fitted.skeleton);
  if (!landmarks) return landmarks.error();
  SkeletonScaling scaling(lengths, *landmarks, fitted.skeleton);
  scaling.ScaleLimbs();
  if (!scaling.impossible().empty()) {
    return InvalidData("no person has these lengths: " + scaling.impossible() +
                       "; are the markers named as in set " + std::string(set.name) + "?");
  }
  scaling.ScaleBack(trunk_m);
  return fitted;
}

}  // namespace footing::motion

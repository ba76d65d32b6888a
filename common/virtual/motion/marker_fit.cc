#include "common/virtual/motion/marker_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/body/body.h"
#include "common/body/fit.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/joint_centres.h"

namespace footing::motion {
namespace {

using body::Landmark;
using body::PointTarget;

constexpr Eigen::Index kCalibrationFrames = 60;  // That place the markers on the segments.
constexpr int kRounds = 3;                       // Of poses from places and places from poses.
constexpr std::size_t kLeastMarkers = 10;        // Of a frame.
// What a joint costs to move, m/rad: limbs hardly anything from the frame before; of the back, the
// neck, the shoulder girdle and what lies beyond the last markers, a centimetre for a large bend.
constexpr double kHoldLimb = 0.002, kHoldSpine = 0.05;

std::size_t MarkerIndex(int value) { return static_cast<std::size_t>(value); }

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
  bool PoseOfMarkers(const MarkerTracks& tracks, const std::vector<FittedMarker>& markers,
                     const std::vector<int>& tracks_of, Eigen::Index frame, Eigen::VectorXd& q) {
    targets_.clear();
    for (std::size_t i = 0; i < markers.size(); ++i) {
      if (tracks_of[i] < 0) continue;
      const Eigen::Vector3d p_W = tracks.p[MarkerIndex(tracks_of[i])].col(frame);
      if (Seen(p_W)) targets_.push_back({markers[i].joint, markers[i].p_J, p_W, 1});
    }
    if (targets_.size() < kLeastMarkers) return false;
    neutral_ = q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (hold_(i) == kHoldSpine) neutral_(i) = 0;
    }
    fit_.Fit(targets_, {.iterations = 20, .hold = &hold_, .neutral = &neutral_}, q);
    return true;
  }

  /// Place of a marker in each candidate joint's frame.
  Eigen::Vector3d Local(int joint, const Eigen::Vector3d& p_W) const {
    return at_.R_WJ[MarkerIndex(joint)].transpose() * (p_W - at_.p_WJ[MarkerIndex(joint)]);
  }
  Eigen::Vector3d World(int joint, const Eigen::Vector3d& p_J) const {
    return at_.p_WJ[MarkerIndex(joint)] + at_.R_WJ[MarkerIndex(joint)] * p_J;
  }
  void Place(const Eigen::VectorXd& q) { ComputeKinematics(skeleton_, q, at_); }

  /// Joints that can carry markers of which the set does not say where they sit: segments that have
  /// markers it does know.
  std::vector<int> Carriers(const MarkerSet& set) const {
    std::vector<int> carriers = {0};
    for (Landmark l :
         {Landmark::kChest, Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftElbow,
          Landmark::kRightElbow, Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftKnee,
          Landmark::kRightKnee, Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
      carriers.push_back(landmarks_[l]);
    }
    for (Landmark l : {Landmark::kLeftWrist, Landmark::kRightWrist}) {
      carriers.push_back(skeleton_.joint(landmarks_[l]).parent);  // The forearm as it turns.
      if (!set.hand.empty()) carriers.push_back(landmarks_[l]);
    }
    if (!set.head.empty()) carriers.push_back(landmarks_[Landmark::kHead]);
    return carriers;
  }

  /// The joint that carries each marker the set knows; -1 for the others.
  std::vector<int> KnownCarriers(const MarkerTracks& tracks, const MarkerSet& set) const {
    std::vector<int> known(tracks.names.size(), -1);
    for (int side = 0; side < 2; ++side) {
      const auto of = [&](Landmark left) { return landmarks_[side == 0 ? left : Mirrored(left)]; };
      const int forearm = skeleton_.joint(of(Landmark::kLeftWrist)).parent;
      const std::pair<std::string_view, int> kFields[] = {
          {set.asis, 0},
          {set.psis, 0},
          {set.knee_lateral, of(Landmark::kLeftHip)},
          {set.knee_medial, of(Landmark::kLeftHip)},
          {set.ankle_lateral, of(Landmark::kLeftKnee)},
          {set.ankle_medial, of(Landmark::kLeftKnee)},
          {set.heel, of(Landmark::kLeftAnkle)},
          {set.toe, of(Landmark::kLeftAnkle)},
          {set.fifth_metatarsal, of(Landmark::kLeftAnkle)},
          {set.shoulder, of(Landmark::kLeftClavicle)},
          {set.elbow_lateral, of(Landmark::kLeftShoulder)},
          {set.elbow_medial, of(Landmark::kLeftShoulder)},
          {set.wrist_radius, forearm},
          {set.wrist_ulna, forearm},
          {set.hand, of(Landmark::kLeftWrist)},
          {set.cervicale, landmarks_[Landmark::kChest]},
          {set.sternum, landmarks_[Landmark::kChest]},
          {set.head, landmarks_[Landmark::kHead]},
      };
      for (const auto& [field, joint] : kFields) {
        for (const int marker : MarkersOf(tracks, set, field, side))
          known[MarkerIndex(marker)] = joint;
      }
    }
    return known;
  }

 private:
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
                    const Eigen::Matrix3Xd& track, const std::vector<Eigen::Index>& frames,
                    const std::vector<Eigen::VectorXd>& poses) {
  std::vector<Eigen::Vector3d> sums(carriers.size(), Eigen::Vector3d::Zero());
  std::vector<double> squares(carriers.size(), 0.0);
  double count = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Eigen::Vector3d p_W = track.col(frames[k]);
    if (!Seen(p_W)) continue;
    fitter.Place(poses[k]);
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

}  // namespace

Result<MarkerFit> FitMarkers(const MarkerTracks& tracks, const MarkerFitOptions& options) {
  const MarkerTracks& still = options.still != nullptr ? *options.still : tracks;
  const auto set = FindMarkerSet(still, options.set);
  if (!set) return set.error();
  auto lengths = FitLengths(still, *set, options.sex);
  if (!lengths) return lengths.error();
  MarkerFit out;
  out.set = std::string(set->name);
  out.height_m = lengths->height_m;
  out.motion = {std::move(lengths->skeleton), tracks.rate_hz, tracks.start_s, {}};
  const auto landmarks = body::FindLandmarks(out.motion.skeleton);
  if (!landmarks) return landmarks.error();
  Fitter fitter(out.motion.skeleton, *landmarks);
  const std::vector<int> carriers = fitter.Carriers(*set);
  const std::vector<int> known = fitter.KnownCarriers(tracks, *set);

  // Where the markers sit: poses from the joint centres place them, then they place the poses.
  std::vector<Eigen::Index> frames;
  std::vector<Eigen::VectorXd> poses;
  for (const Eigen::Index frame : Spread(tracks.frames(), kCalibrationFrames)) {
    Eigen::VectorXd q;
    if (!fitter.PoseOfCentres(JointCentres(tracks, *set, frame), q)) continue;
    frames.push_back(frame);
    poses.push_back(std::move(q));
  }
  if (frames.empty()) return InvalidData("no frame has all the markers of the pelvis");
  std::vector<int> tracks_of;
  for (int round = 0; round < kRounds; ++round) {
    out.markers.clear();
    tracks_of.clear();
    for (std::size_t i = 0; i < tracks.names.size(); ++i) {
      FittedMarker marker = Attach(fitter, known[i] < 0 ? carriers : std::vector<int>{known[i]},
                                   tracks.names[i], tracks.p[i], frames, poses);
      if (marker.joint < 0) continue;
      out.markers.push_back(std::move(marker));
      tracks_of.push_back(static_cast<int>(i));
    }
    if (out.markers.size() < kLeastMarkers) return InvalidData("fewer than ten markers were seen");
    for (std::size_t k = 0; k < frames.size(); ++k) {
      fitter.PoseOfMarkers(tracks, out.markers, tracks_of, frames[k], poses[k]);
    }
  }

  out.motion.q.resize(out.motion.skeleton.dof, tracks.frames());
  Eigen::VectorXd q = poses.front();
  double sum = 0, count = 0;
  std::vector<double> counts(out.markers.size(), 0.0);
  for (Eigen::Index frame = 0; frame < tracks.frames(); ++frame) {
    fitter.PoseOfMarkers(tracks, out.markers, tracks_of, frame, q);
    out.motion.q.col(frame) = q;
    fitter.Place(q);
    for (std::size_t i = 0; i < out.markers.size(); ++i) {
      const Eigen::Vector3d p_W = tracks.p[MarkerIndex(tracks_of[i])].col(frame);
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
  return out;
}

}  // namespace footing::motion

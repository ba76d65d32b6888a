#include "common/virtual/motion/standard_layout.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/marker_fit.h"

namespace footing::motion {
namespace {

using body::Landmark;
using Eigen::Vector3d;

constexpr Eigen::Index kEnoughFrames = 2000;  // Frames of a long motion, evenly spread.

Eigen::Index Stride(const Motion& motion) {
  return std::max<Eigen::Index>(1, motion.frames() / kEnoughFrames);
}

/// Places of landmarks in one pose.
class Places {
 public:
  Places(const Motion& motion, const body::Landmarks& landmarks)
      : skeleton_(motion.skeleton), landmarks_(landmarks), at_(motion.skeleton) {}

  void Take(const Eigen::VectorXd& q) { body::ComputeKinematics(skeleton_, q, at_); }
  const Vector3d& At(Landmark landmark) const { return at_.p_WJ[Index(landmark)]; }
  const Eigen::Matrix3d& Turn(Landmark landmark) const { return at_.R_WJ[Index(landmark)]; }
  Vector3d Line(Landmark from, Landmark to) const { return (At(to) - At(from)).normalized(); }
  /// Direction of the line from the right hip to the left one.
  Vector3d Left() const { return Line(Landmark::kRightHip, Landmark::kLeftHip); }
  Vector3d Up() const {
    const Vector3d hips = 0.5 * (At(Landmark::kLeftHip) + At(Landmark::kRightHip));
    return (At(Landmark::kNeck) - hips).normalized();
  }
  /// Cosines of how far trunk and legs are from the vertical: their least, and their sum.
  std::pair<double, double> Uprightness() const {
    double least = Up().z(), sum = Up().z();
    for (const int side : {0, 1}) {
      const auto of = [side](Landmark left) { return body::OfSide(left, side); };
      for (const auto& [from, to] : {std::pair{Landmark::kLeftHip, Landmark::kLeftKnee},
                                     {Landmark::kLeftKnee, Landmark::kLeftAnkle}}) {
        const double down = -Line(of(from), of(to)).z();
        least = std::min(least, down);
        sum += down;
      }
    }
    return {least, sum};
  }

 private:
  std::size_t Index(Landmark landmark) const {
    return static_cast<std::size_t>(landmarks_[landmark]);
  }

  const body::Skeleton& skeleton_;
  const body::Landmarks& landmarks_;
  body::Kinematics at_;
};

/// A standing person who looks along x, arms wherever.
bool IsPerson(const Places& places) {
  constexpr double kNear = 0.8;  // Some 37 degrees.
  return places.Uprightness().first > kNear && places.Left().y() > kNear;
}

/// The skeleton's pose turned about the vertical so that its hips stand along y.
Eigen::VectorXd Facing(const Motion& motion, const Places& places, Eigen::VectorXd q) {
  const Vector3d left = places.Left();
  const Eigen::Matrix3d turn =
      body::AxisRotation(body::Axis::kZ, kPi / 2 - std::atan2(left.y(), left.x()));
  const body::Joint& root = motion.skeleton.joint(0);
  body::SetJointRotation(root, turn * body::JointRotation(root, q), q);
  return q;
}

/// The side towards which a hinge's axis points, over the motion.
class Hinge {
 public:
  /// `sign` is 1 where upper x lower points to the lateral side, else -1.
  Hinge(Landmark from, Landmark joint, Landmark to, double sign)
      : from_(from), joint_(joint), to_(to), sign_(sign) {}

  void Take(const Places& places) {
    const Vector3d bent = places.Line(from_, joint_).cross(places.Line(joint_, to_));
    const double sine = bent.norm();
    // A straight limb has no plane. Weighed by itself, since it is known the better.
    if (!(sine > kLeastSine)) return;
    sum_J_ += places.Turn(from_).transpose() * (sign_ * sine * bent);
    weight_ += sine * sine;
  }
  /// In W, with the joints as they are now.
  Vector3d Lateral(const Places& places, const Vector3d& otherwise_W) const {
    const bool agreed = weight_ > 0 && sum_J_.norm() > kLeastAgreement * weight_;
    Vector3d axis_W = agreed ? Vector3d(places.Turn(from_) * sum_J_) : otherwise_W;
    const Vector3d bone_W = places.Line(from_, joint_);
    axis_W -= bone_W * bone_W.dot(axis_W);
    return axis_W.normalized();
  }

 private:
  static constexpr double kLeastSine = 0.26;  // 15 degrees.
  static constexpr double kLeastAgreement = 0.7;

  Landmark from_, joint_, to_;
  double sign_;
  Vector3d sum_J_ = Vector3d::Zero();
  double weight_ = 0;
};

}  // namespace

Eigen::VectorXd ReferencePose(const Motion& motion, const body::Landmarks& landmarks) {
  Places places(motion, landmarks);
  Eigen::VectorXd q = body::TPose(motion.skeleton, landmarks);
  places.Take(q);
  if (IsPerson(places) || motion.frames() == 0) return q;
  Eigen::Index best = 0;
  double most = -10;  // Below every sum of five cosines.
  for (Eigen::Index i = 0; i < motion.frames(); i += Stride(motion)) {
    places.Take(motion.q.col(i));
    const double upright = places.Uprightness().second;
    if (upright > most) {
      most = upright;
      best = i;
    }
  }
  q = motion.q.col(best);
  places.Take(q);
  return Facing(motion, places, q);
}

HingeAxes FindHingeAxes(const Motion& motion, const body::Landmarks& landmarks,
                        const Eigen::VectorXd& pose) {
  const auto hinge = [](Landmark from, Landmark joint, Landmark to, int side, double left_sign) {
    return Hinge(body::OfSide(from, side), body::OfSide(joint, side), body::OfSide(to, side),
                 side == 0 ? left_sign : -left_sign);
  };
  // A knee bends its shank backwards, an elbow the forearm forwards.
  std::array<Hinge, 2> knees = {
      hinge(Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, 0, 1),
      hinge(Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, 1, 1)};
  std::array<Hinge, 2> elbows = {
      hinge(Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist, 0, -1),
      hinge(Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist, 1, -1)};
  Places places(motion, landmarks);
  for (Eigen::Index i = 0; i < motion.frames(); i += Stride(motion)) {
    places.Take(motion.q.col(i));
    for (std::size_t side = 0; side < 2; ++side) {
      knees[side].Take(places);
      elbows[side].Take(places);
    }
  }
  places.Take(pose);
  HingeAxes axes;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector3d out(0, side == 0 ? 1 : -1, 0);
    axes.knee_W[side] = knees[side].Lateral(places, out);
    axes.elbow_W[side] = elbows[side].Lateral(places, -Vector3d::UnitX());
  }
  return axes;
}

namespace {

constexpr double kPelvisDepthM = 0.15;  // Any: the regression of the hips is met with it.

/// A marker on a joint's frame.
struct Marker {
  std::string name;
  std::size_t joint;
  Eigen::Vector3d p_J_m;
};

/// Markers of the set plug-in-gait, put where its joint centres become the skeleton's joints.
class Placer {
 public:
  Placer(const Motion& motion, const body::Landmarks& landmarks)
      : skeleton_(motion.skeleton), landmarks_(landmarks), at_(motion.skeleton) {
    const Eigen::VectorXd pose = ReferencePose(motion, landmarks);
    axes_ = FindHingeAxes(motion, landmarks, pose);
    body::ComputeKinematics(skeleton_, pose, at_);
  }

  std::vector<Marker> Place() {
    PlacePelvis();
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
    for (const int side : {0, 1}) {
      const std::string s = side == 0 ? "L" : "R";
      const auto of = [side](Landmark left) { return body::OfSide(left, side); };
      const Eigen::Vector3d& knee = axes_.knee_W[static_cast<std::size_t>(side)];
      const Eigen::Vector3d& elbow = axes_.elbow_W[static_cast<std::size_t>(side)];
      Pair(s + "KNE", s + "KNM", of(Landmark::kLeftHip), of(Landmark::kLeftKnee), 0.055 * knee);
      Pair(s + "ANK", s + "MED", of(Landmark::kLeftKnee), of(Landmark::kLeftAnkle), 0.04 * knee);
      Pair(s + "ELB", s + "ELM", of(Landmark::kLeftShoulder), of(Landmark::kLeftElbow),
           0.045 * elbow);
      Pair(s + "WRA", s + "WRB", of(Landmark::kLeftElbow), of(Landmark::kLeftWrist), -0.03 * elbow);
      const Eigen::Vector3d ankle = At(of(Landmark::kLeftAnkle));
      Add(s + "HEE", of(Landmark::kLeftAnkle), ankle - 0.045 * x - 0.05 * z);
      const Landmark toe = of(Landmark::kLeftToe);
      Add(s + "TOE", of(Landmark::kLeftAnkle), landmarks_[toe] >= 0 ? At(toe) : ankle + 0.14 * x);
      const Landmark shoulder = of(Landmark::kLeftShoulder);
      AddTo(s + "SHO", skeleton_.joint(landmarks_[shoulder]).parent, At(shoulder) + 0.04 * z);
      const Landmark hand = of(Landmark::kLeftHandEnd);
      if (landmarks_[hand] >= 0) Add(s + "FIN", of(Landmark::kLeftWrist), At(hand));
    }
    const int chest = skeleton_.joint(landmarks_[Landmark::kNeck]).parent;
    AddTo("C7", chest, At(Landmark::kNeck) - 0.05 * x);
    AddTo("CLAV", chest, At(Landmark::kNeck) + 0.05 * x);
    const Landmark head = landmarks_[Landmark::kHead] >= 0 ? Landmark::kHead : Landmark::kNeck;
    for (const double left_m : {0.07, -0.07}) {
      for (const double ahead_m : {0.08, -0.08}) {
        Add(std::string(left_m > 0 ? "L" : "R") + (ahead_m > 0 ? "FHD" : "BHD"), head,
            At(head) + Eigen::Vector3d(ahead_m, left_m, 0.12));
      }
    }
    return std::move(markers_);
  }

 private:
  Eigen::Vector3d At(Landmark landmark) const {
    return at_.p_WJ[static_cast<std::size_t>(landmarks_[landmark])];
  }
  void AddTo(const std::string& name, int joint, const Eigen::Vector3d& p_W_m) {
    const auto index = static_cast<std::size_t>(std::max(joint, 0));
    markers_.push_back({name, index, at_.R_WJ[index].transpose() * (p_W_m - at_.p_WJ[index])});
  }
  void Add(const std::string& name, Landmark carrier, const Eigen::Vector3d& p_W_m) {
    AddTo(name, landmarks_[carrier], p_W_m);
  }
  /// Both sides of a joint, on the segment above it.
  void Pair(const std::string& one, const std::string& other, Landmark carrier, Landmark joint,
            const Eigen::Vector3d& aside_m) {
    Add(one, carrier, At(joint) + aside_m);
    Add(other, carrier, At(joint) - aside_m);
  }
  /// Where Harrington's regression (JointCentres) finds the hips again.
  void PlacePelvis() {
    const Eigen::Vector3d left = At(Landmark::kLeftHip), right = At(Landmark::kRightHip);
    const double width_m = std::max(0.05, (0.5 * (left - right).norm() - 0.0073) / 0.33);
    const Eigen::Vector3d front =
        0.5 * (left + right) +
        Eigen::Vector3d(0.24 * kPelvisDepthM + 0.0099, 0, 0.30 * width_m + 0.0109);
    const int pelvis = skeleton_.joint(landmarks_[Landmark::kLeftHip]).parent;
    for (const int sign : {1, -1}) {
      const std::string s = sign > 0 ? "L" : "R";
      AddTo(s + "ASI", pelvis, front + Eigen::Vector3d(0, 0.5 * sign * width_m, 0));
      AddTo(s + "PSI", pelvis, front + Eigen::Vector3d(-kPelvisDepthM, 0.05 * sign, 0));
    }
  }

  const body::Skeleton& skeleton_;
  const body::Landmarks& landmarks_;
  HingeAxes axes_;
  body::Kinematics at_;
  std::vector<Marker> markers_;
};

}  // namespace

bool HasStandardLayout(const Motion& motion) {
  return IsStandardLayout(body::DofNames(motion.skeleton));
}

bool IsStandardLayout(const std::vector<std::string>& dofs) {
  static const std::vector<std::string> kStandard = body::DofNames(body::StandardPerson(1.7));
  return dofs == kStandard;
}

Result<StandardMotion> ToStandardLayout(const Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return landmarks.error();
  const std::vector<Marker> markers = Placer(motion, *landmarks).Place();
  MarkerTracks tracks;
  tracks.rate_hz = motion.rate_hz;
  tracks.start_s = motion.start_s;
  for (const Marker& marker : markers) tracks.names.push_back(marker.name);
  tracks.p.assign(markers.size(), Eigen::Matrix3Xd(3, motion.frames()));
  body::Kinematics at(motion.skeleton);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    body::ComputeKinematics(motion.skeleton, motion.q.col(i), at);
    for (std::size_t k = 0; k < markers.size(); ++k) {
      tracks.p[k].col(i) = at.p_WJ[markers[k].joint] + at.R_WJ[markers[k].joint] * markers[k].p_J_m;
    }
  }
  auto fit = FitMarkers(tracks, {.set = "plug-in-gait"});
  if (!fit) return fit.error();
  return StandardMotion{std::move(fit->motion), fit->height_m, fit->rms_m};
}

}  // namespace footing::motion

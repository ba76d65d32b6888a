#include "common/virtual/motion/joint_centres.h"

#include <Eigen/Geometry>

namespace footing::motion {
namespace {

using body::Landmark;
using MaybePoint = std::optional<Eigen::Vector3d>;

// From a lateral marker's centre to the joint's, m: half the width of an adult's joint and the
// marker's own radius.
constexpr double kHalfKneeM = 0.055, kHalfAnkleM = 0.040, kHalfElbowM = 0.045, kHalfWristM = 0.0;

struct Markers {
  const MarkerTracks& tracks;
  const MarkerSet& set;
  Eigen::Index frame;

  /// Mean of the markers of a field; nothing where one of them was not seen.
  MaybePoint Mean(std::string_view field, int side) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto markers = MarkersOf(tracks, set, field, side);
    for (const int marker : markers) {
      sum += tracks.p[static_cast<std::size_t>(marker)].col(frame);
    }
    if (markers.empty() || !sum.allFinite()) return std::nullopt;
    return sum / static_cast<double>(markers.size());
  }
};

/// Harrington's regression, of the left (0) and right (1) hip. Pelvis: x ahead, y left, z up.
std::array<MaybePoint, 2> Hips(const Markers& markers) {
  const MaybePoint asis[2] = {markers.Mean(markers.set.asis, 0), markers.Mean(markers.set.asis, 1)};
  const MaybePoint psis[2] = {markers.Mean(markers.set.psis, 0), markers.Mean(markers.set.psis, 1)};
  if (!asis[0] || !asis[1] || !psis[0] || !psis[1]) return {};
  const Eigen::Vector3d front = (*asis[0] + *asis[1]) / 2, back = (*psis[0] + *psis[1]) / 2;
  const Eigen::Vector3d y = (*asis[0] - *asis[1]).normalized();
  const Eigen::Vector3d z = (front - back).cross(y).normalized();
  const Eigen::Vector3d x = y.cross(z);
  const double depth_m = (front - back).norm(), width_m = (*asis[0] - *asis[1]).norm();
  std::array<MaybePoint, 2> hips;
  for (int side = 0; side < 2; ++side) {
    hips[static_cast<std::size_t>(side)] = front + (-0.24 * depth_m - 0.0099) * x +
                                           (-0.30 * width_m - 0.0109) * z +
                                           (side == 0 ? 1 : -1) * (0.33 * width_m + 0.0073) * y;
  }
  return hips;
}

/// Midway between both markers, or from the lateral one inwards: square to the limb, along
/// `left_W`.
MaybePoint JointBetween(const MaybePoint& lateral, const MaybePoint& medial,
                        const MaybePoint& above, const Eigen::Vector3d& left_W, int side,
                        double half_width_m) {
  if (lateral && medial) return (*lateral + *medial) / 2;
  if (!lateral || !above) return std::nullopt;
  const Eigen::Vector3d limb = (*lateral - *above).normalized();
  const Eigen::Vector3d across = left_W - left_W.dot(limb) * limb;
  if (across.norm() < 0.1) return std::nullopt;
  return *lateral - (side == 0 ? 1 : -1) * half_width_m * across.normalized();
}

}  // namespace

Centres JointCentres(const MarkerTracks& tracks, const MarkerSet& set, Eigen::Index frame) {
  const Markers markers{tracks, set, frame};
  Centres centres;
  const auto at = [&centres](Landmark landmark) -> MaybePoint& {
    return centres[static_cast<std::size_t>(landmark)];
  };
  const auto hips = Hips(markers);
  const MaybePoint shoulders[2] = {markers.Mean(set.shoulder, 0), markers.Mean(set.shoulder, 1)};
  if (!hips[0] || !hips[1]) return centres;
  const Eigen::Vector3d middle = (*hips[0] + *hips[1]) / 2;
  at(Landmark::kHips) = middle;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (shoulders[0] && shoulders[1]) {
    up = ((*shoulders[0] + *shoulders[1]) / 2 - middle).normalized();
  }
  const Eigen::Vector3d left_W = (*hips[0] - *hips[1]).normalized();
  for (int side = 0; side < 2; ++side) {
    const auto here = [&](Landmark left) -> MaybePoint& { return at(OfSide(left, side)); };
    const auto mean = [&](std::string_view field) { return markers.Mean(field, side); };
    here(Landmark::kLeftHip) = hips[static_cast<std::size_t>(side)];
    here(Landmark::kLeftKnee) = JointBetween(mean(set.knee_lateral), mean(set.knee_medial),
                                             here(Landmark::kLeftHip), left_W, side, kHalfKneeM);
    here(Landmark::kLeftAnkle) = JointBetween(mean(set.ankle_lateral), mean(set.ankle_medial),
                                              here(Landmark::kLeftKnee), left_W, side, kHalfAnkleM);
    here(Landmark::kLeftToe) = mean(set.toe);
    if (shoulders[side]) {
      here(Landmark::kLeftShoulder) = *shoulders[side] - set.shoulder_over_joint_m * up;
    }
    here(Landmark::kLeftElbow) =
        JointBetween(mean(set.elbow_lateral), mean(set.elbow_medial), here(Landmark::kLeftShoulder),
                     left_W, side, kHalfElbowM);
    here(Landmark::kLeftWrist) =
        JointBetween(mean(set.wrist_radius), mean(set.wrist_ulna), here(Landmark::kLeftElbow),
                     left_W, side, kHalfWristM);
    here(Landmark::kLeftHandEnd) = mean(set.hand);
  }
  const MaybePoint cervicale = markers.Mean(set.cervicale, 0),
                   sternum = markers.Mean(set.sternum, 0);
  at(Landmark::kNeck) = cervicale;
  if (cervicale && sternum) at(Landmark::kNeck) = (*cervicale + *sternum) / 2;
  at(Landmark::kHead) = markers.Mean(set.head, 0);
  return centres;
}

}  // namespace footing::motion

#include "daemon/simulation/reconstruction/angle_spread.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace footing::reconstruction {
namespace {

using body::Landmark;

/// The turn of a segment against the one above it: up to three of body::kStatedAngles, about z,
/// then x, then y of OpenSim.
struct Turn {
  Landmark joint;
  Landmark from;  ///< kHips of the pelvis itself: W.
  std::size_t first;
  std::size_t count;
  std::size_t foot = momentum::kFeet;  ///< Its leg's foot, if it is of a leg.
};

// In the order of body::kStatedAngles.
constexpr Turn kTurns[] = {
    {Landmark::kHips, Landmark::kHips, 0, 3},
    {Landmark::kRightHip, Landmark::kHips, 3, 3, 1},
    {Landmark::kRightKnee, Landmark::kRightHip, 6, 1, 1},
    {Landmark::kRightAnkle, Landmark::kRightKnee, 7, 1, 1},
    {Landmark::kLeftHip, Landmark::kHips, 8, 3, 0},
    {Landmark::kLeftKnee, Landmark::kLeftHip, 11, 1, 0},
    {Landmark::kLeftAnkle, Landmark::kLeftKnee, 12, 1, 0},
    {Landmark::kChest, Landmark::kHips, 13, 3},
};
static_assert(kTurns[7].first + kTurns[7].count == body::kStatedAngles.size());

constexpr std::size_t kTurnsAFrame = 2;
/// A leg in the air: of a shank's length.
constexpr double kShankM = 0.4;
/// Nearer to the singularity of the angles their deviations stay as there.
constexpr double kLeastSine = 0.2;

int JointOf(const body::Body& body, Landmark landmark) {
  const int joint = body.landmarks[landmark];
  if (joint >= 0 || landmark != Landmark::kChest) return joint;
  return body.skeleton.joint(body.landmarks[Landmark::kNeck]).parent;
}

/// The rates of the three angles are this times the angular velocity against the segment above:
/// rotations about its z (W's -y in the upright body), the line across, and the lower segment's y.
Eigen::Matrix3d ToAngles(const Eigen::Matrix3d& above, const Eigen::Matrix3d& below) {
  const Eigen::Vector3d first = -above.col(1), third = below.col(2);
  const Eigen::Vector3d across = third.cross(first);
  const double sine = across.norm();
  if (sine < kLeastSine) return Eigen::Matrix3d::Identity() / kLeastSine;
  Eigen::Matrix3d axes;
  axes << first, across / sine, third;
  return axes.inverse();
}

}  // namespace

AngleSpread::AngleSpread(const SubjectModel& model) : model_(&model) {}

void AngleSpread::Measure(std::size_t turn, pose::GaussNewton& solver) {
  const Turn& one = kTurns[turn];
  const body::Body& body = model_->body;
  const int joint = JointOf(body, one.joint);
  const bool of_root = one.joint == one.from;
  const int from = of_root ? -1 : JointOf(body, one.from);
  const auto since_t_pose = [&](int of) -> Eigen::Matrix3d {
    const auto index = static_cast<std::size_t>(of);
    return solver.at().R_WJ[index] * model_->t_pose_at.R_WJ[index].transpose();
  };
  const Eigen::Matrix3d above = of_root ? Eigen::Matrix3d::Identity() : since_t_pose(from);
  const Eigen::Vector3d open =
      solver.TurnVariances(joint, from, ToAngles(above, since_t_pose(joint)));
  for (std::size_t i = 0; i < one.count; ++i) {
    sd_rad_[one.first + i] = std::sqrt(open(static_cast<Eigen::Index>(i)));
  }
}

double AngleSpread::KneeBendRad(const body::Kinematics& at) const {
  double sum_rad = 0;
  for (const int side : {0, 1}) {
    const auto place = [&](Landmark left) {
      return at.p_WJ[static_cast<std::size_t>(model_->body.landmarks[body::OfSide(left, side)])];
    };
    const Eigen::Vector3d knee = place(Landmark::kLeftKnee);
    const Eigen::Vector3d thigh = knee - place(Landmark::kLeftHip);
    const Eigen::Vector3d shank = place(Landmark::kLeftAnkle) - knee;
    sum_rad += std::atan2(thigh.cross(shank).norm(), thigh.dot(shank));
  }
  return sum_rad / 2;
}

void AngleSpread::Advance(const BestConstants& best, pose::GaussNewton& solver) {
  const double bend = std::min(1.0, KneeBendRad(solver.at()) / kDeepBendRad);
  solver.Weigh(best.angle_weight + bend * (best.bent_angle_weight - best.angle_weight));
  for (std::size_t i = 0; i < kTurnsAFrame; ++i) {
    Measure(next_, solver);
    next_ = (next_ + 1) % std::size(kTurns);
  }
}

AngleSd AngleSpread::Report(double doubt, const momentum::Estimate& then,
                            const BestConstants& best) const {
  AngleSd sd_rad = sd_rad_;
  for (const Turn& turn : kTurns) {
    const bool aloft = turn.foot < momentum::kFeet && !then.feet[turn.foot].contact;
    const double airborne_s = aloft ? then.feet[turn.foot].airborne_s : 0;
    const double aloft_rad =
        best.aloft_sd_m / kShankM * (1 - std::exp(-airborne_s / best.aloft_time_s));
    for (std::size_t i = turn.first; i < turn.first + turn.count; ++i) {
      sd_rad[i] = std::min(kUnknownAngleRad, std::hypot(doubt * sd_rad[i], aloft_rad));
    }
  }
  return sd_rad;
}

}  // namespace footing::reconstruction

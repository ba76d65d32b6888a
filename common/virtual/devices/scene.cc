#include "common/virtual/devices/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "common/base/text.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/edit.h"

namespace footing::virtual_sensors {
namespace {

using body::Landmark;

constexpr Eigen::Index kFramesPerProgress = 2000;

// A T-pose of straight lines has its weight over the heels. A person leans ahead until it is over
// the rest point of the soles: all but the feet turn about the ankles.
void Lean(const body::Body& body, double rest_share, Eigen::VectorXd& pose) {
  motion::Motion still;
  still.skeleton = body.skeleton;
  still.rate_hz = 100;
  still.q = pose.replicate(1, 2);
  const BodyCourse course = Follow(body, still);
  double rest_x = 0;
  for (const auto& sole : course.sole_m)
    rest_x += (1 - rest_share) * 0.25 * (sole[0](0, 0) + sole[1](0, 0)) +
              rest_share * 0.25 * (sole[2](0, 0) + sole[3](0, 0));
  const double angle = (rest_x - course.com_m(0, 0)) / course.com_m(2, 0);
  const body::Skeleton& skeleton = body.skeleton;
  const Eigen::Matrix3d turn = body::AxisRotation(body::Axis::kY, angle);
  body::SetJointRotation(skeleton.joint(0), turn * body::JointRotation(skeleton.joint(0), pose),
                         pose);
  pose(0) += angle * pose(2);
  body::Kinematics at(skeleton);
  for (const Landmark landmark : {Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    const int ankle = body.landmarks[landmark];
    const body::Joint& joint = skeleton.joint(ankle);
    body::ComputeKinematics(skeleton, pose, at);
    const Eigen::Matrix3d& R_WP = at.R_WJ[static_cast<std::size_t>(joint.parent)];
    const Eigen::Matrix3d& R_WJ = at.R_WJ[static_cast<std::size_t>(ankle)];
    body::SetJointRotation(joint, R_WP.transpose() * turn.transpose() * R_WJ, pose);
  }
}

// The T-pose where the clip begins, on feet that stand as they do there, held, then the clip.
motion::Motion WithTPose(const motion::Motion& clip, const body::Body& body,
                         const SceneOptions& options) {
  Eigen::VectorXd pose = body::TPose(clip.skeleton, body.landmarks);
  Stance stance(body, pose, clip.q.col(0));
  Lean(body, options.rest_share, pose);
  stance.StandOver(pose);
  const auto hold = static_cast<Eigen::Index>(std::lround(options.hold_s * clip.rate_hz));
  const auto leave = static_cast<Eigen::Index>(std::lround(options.leave_s * clip.rate_hz));
  motion::Motion out = clip;
  out.q.resize(clip.q.rows(), hold + leave + clip.q.cols());
  for (Eigen::Index i = 0; i < hold + leave; ++i) {
    const double u = std::max(0.0, static_cast<double>(i - hold) / static_cast<double>(leave));
    const double s = u * u * u * (10 - 15 * u + 6 * u * u);
    Eigen::VectorXd q = pose + s * (clip.q.col(0) - pose);
    if (u > 0) stance.KeepFeet(s, q);
    out.q.col(i) = q;
  }
  out.q.rightCols(clip.q.cols()) = clip.q;
  return out;
}

}  // namespace

Result<Scene> MakeScene(motion::Motion clip, const body::PersonParameters& person,
                        const SceneOptions& options, const std::string& origin) {
  const auto named = [&origin](const Error& error) {
    return Error{error.kind, origin + ": " + error.message};
  };
  const auto landmarks = body::FindLandmarks(clip.skeleton);
  if (!landmarks) return named(landmarks.error());
  auto made = body::MakeBody(clip.skeleton, person);
  if (!made) return named(made.error());
  if (clip.frames() < 2) return InvalidData(origin + ": a motion needs two frames");

  if (options.t_pose) {
    clip = motion::FacingForward(motion::Continuous(std::move(clip)), *landmarks);
    clip.q.row(2).array() -= motion::FloorHeight(clip, *landmarks);
    if (options.loop_s > 0) clip = motion::Looped(clip, options.loop_s);
    clip = WithTPose(clip, *made, options);
  }
  Scene scene;
  scene.body = *std::move(made);
  scene.motion = motion::Continuous(std::move(clip));
  scene.course = Follow(scene.body, scene.motion);
  scene.reaction = React(scene.course);
  return scene;
}

void Shift(const Eigen::Vector2d& by, Scene& scene) {
  scene.motion.q.topRows<2>().colwise() += by;
  scene.course.com_m.topRows<2>().colwise() += by;
  for (auto& sole : scene.course.sole_m) {
    for (auto& point : sole) point.topRows<2>().colwise() += by;
  }
  scene.reaction.cop_m.colwise() += by;
}

Eigen::Vector3d SoleMiddle(const BodyCourse& course, std::size_t foot, Eigen::Index frame) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& point : course.sole_m[foot]) middle += point.col(frame) / kFootPoints;
  return middle;
}

std::vector<std::array<FootForce, kFeet>> ShareThroughout(
    const Scene& scene, const std::function<void(double done)>& progress) {
  std::vector<std::array<FootForce, kFeet>> feet;
  const Eigen::Index frames = scene.course.frames();
  feet.reserve(static_cast<std::size_t>(frames));
  for (Eigen::Index i = 0; i < frames; ++i) {
    feet.push_back(ShareBetweenFeet(scene.course, scene.reaction, i));
    if (progress && (i + 1) % kFramesPerProgress == 0)
      progress(static_cast<double>(i + 1) / static_cast<double>(frames));
  }
  return feet;
}

namespace {

constexpr double kLeastFootM = 0.02;  // From ankle to toe over the ground; shorter is on end.
constexpr double kMostTurnRad = 0.8;
// Further apart nobody stands upright for five seconds; closer, one foot is on the other.
constexpr double kMostAheadM = 0.5, kLeastApartM = 0.06, kMostApartM = 0.8;
constexpr double kMostThighTurnRad = 0.5;  // Clips of standing people begin with up to 0.56.
constexpr double kFirstBendRad = 0.2;      // A straight knee could be bent either way.
constexpr double kStretchedShare = 0.999;  // Share of a leg's length; a straight leg cannot bend.

/// The way from the right ankle to the left one as near to this as a person can stand.
Eigen::Vector2d AsOneStands(const Eigen::Vector2d& apart_m) {
  return {std::clamp(apart_m.x(), -kMostAheadM, kMostAheadM),
          std::clamp(apart_m.y(), kLeastApartM, kMostApartM)};
}

/// How far the foot is turned over the ground from where it points in the T-pose, rad. 0 for one
/// that is on end, or turned further than anybody stands: it is in the air.
double TurnOf(const body::Body& body, const body::Kinematics& standing, const body::Kinematics& at,
              int foot) {
  const auto ahead_m = [&](const body::Kinematics& pose) -> Eigen::Vector2d {
    const auto place = [&](Landmark left) -> Eigen::Vector2d {
      const int joint = body.landmarks[body::OfSide(left, foot)];
      return pose.p_WJ[static_cast<std::size_t>(joint)].head<2>();
    };
    return place(Landmark::kLeftToe) - place(Landmark::kLeftAnkle);
  };
  if (body.landmarks[body::OfSide(Landmark::kLeftToe, foot)] < 0) return 0;
  const Eigen::Vector2d straight = ahead_m(standing), turned = ahead_m(at);
  if (straight.norm() < kLeastFootM || turned.norm() < kLeastFootM) return 0;
  const double cross = straight.x() * turned.y() - straight.y() * turned.x();
  const double turn_rad = std::atan2(cross, straight.dot(turned));
  return std::abs(turn_rad) > kMostTurnRad ? 0 : turn_rad;
}

}  // namespace

Stance::Stance(const body::Body& body, const Eigen::VectorXd& t_pose,
               const Eigen::VectorXd& first_q)
    : body_(body),
      legs_{motion::LegSolver(body, true, motion::LegAim::kWhole),
            motion::LegSolver(body, false, motion::LegAim::kWhole)},
      stance_(Places(t_pose)),
      first_(Places(first_q)) {
  const Eigen::Vector2d middle_m = (first_[0].p_WA + first_[1].p_WA).head<2>() / 2;
  const Eigen::Vector2d apart_m = AsOneStands((first_[0].p_WA - first_[1].p_WA).head<2>());
  stance_[0].p_WA.head<2>() = middle_m + apart_m / 2;
  stance_[1].p_WA.head<2>() = middle_m - apart_m / 2;
  body::Kinematics standing(body.skeleton), beginning(body.skeleton);
  body::ComputeKinematics(body.skeleton, t_pose, standing);
  body::ComputeKinematics(body.skeleton, first_q, beginning);
  for (int foot = 0; foot < kFeet; ++foot) {
    motion::FootPlace& place = stance_[static_cast<std::size_t>(foot)];
    const double turn_rad = TurnOf(body, standing, beginning, foot);
    place.R_WA = body::AxisRotation(body::Axis::kZ, turn_rad) * place.R_WA;
    place.thigh_turn_rad = std::clamp(first_[static_cast<std::size_t>(foot)].thigh_turn_rad,
                                      -kMostThighTurnRad, kMostThighTurnRad);
  }
}

FeetPlaces Stance::Places(const Eigen::VectorXd& q) const {
  body::Kinematics at(body_.skeleton);
  body::ComputeKinematics(body_.skeleton, q, at);
  FeetPlaces places;
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const auto ankle = static_cast<std::size_t>(legs_[foot].ankle());
    places[foot] = {at.p_WJ[ankle], at.R_WJ[ankle], legs_[foot].ThighTurn(at)};
  }
  return places;
}

void Stance::StandOver(Eigen::VectorXd& q) {
  const FeetPlaces now = Places(q);
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    q.head<2>() += (stance_[foot].p_WA - now[foot].p_WA).head<2>() / kFeet;
  }
  body::Kinematics at(body_.skeleton);
  body::ComputeKinematics(body_.skeleton, q, at);
  double too_high_m = 0;
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const motion::LegSolver& leg = legs_[foot];
    const Eigen::Vector3d up_m = at.p_WJ[static_cast<std::size_t>(leg.hip())] - stance_[foot].p_WA;
    const double reach_m = kStretchedShare * (leg.thigh_m() + leg.shank_m());
    const double below_m =
        std::sqrt(std::max(0.0, reach_m * reach_m - up_m.head<2>().squaredNorm()));
    too_high_m = std::max(too_high_m, up_m.z() - below_m);
  }
  q(2) -= too_high_m;
  for (motion::LegSolver& leg : legs_) leg.BendKnee(kFirstBendRad, q);
  KeepFeet(0, q);
}

void Stance::KeepFeet(double share, Eigen::VectorXd& q) {
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const motion::FootPlace &from = stance_[foot], &to = first_[foot];
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond(from.R_WA).slerp(share, Eigen::Quaterniond(to.R_WA));
    const double thigh_turn_rad =
        from.thigh_turn_rad + share * (to.thigh_turn_rad - from.thigh_turn_rad);
    legs_[foot].Solve(
        {from.p_WA + share * (to.p_WA - from.p_WA), turn.toRotationMatrix(), thigh_turn_rad}, q);
  }
}

}  // namespace footing::virtual_sensors

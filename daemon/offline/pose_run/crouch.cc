#include "daemon/offline/pose_run/crouch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"

namespace footing::pose_run {
namespace {

using body::Landmark;

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The least of both knees' and both hips' bends.
double LeastBend(const body::Body& body, const Eigen::VectorXd& q, body::Kinematics& at) {
  body::ComputeKinematics(body.skeleton, q, at);
  const auto place = [&](Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body.landmarks[landmark])];
  };
  const Eigen::Vector3d hips = 0.5 * (place(Landmark::kLeftHip) + place(Landmark::kRightHip));
  const Eigen::Vector3d trunk = place(Landmark::kNeck) - hips;
  double least = kPi;
  for (const bool right : {false, true}) {
    const auto of = [&](Landmark left) { return place(right ? body::Mirrored(left) : left); };
    const Eigen::Vector3d hip = of(Landmark::kLeftHip), knee = of(Landmark::kLeftKnee);
    const Eigen::Vector3d ankle = of(Landmark::kLeftAnkle);
    least = std::min({least, Angle(trunk, hip - knee), Angle(knee - hip, ankle - knee)});
  }
  return least;
}

}  // namespace

Crouch DeepestCrouch(const PoseRun& run, std::size_t from) {
  body::Kinematics at(run.body.skeleton);
  Crouch deepest{from, 0};
  for (std::size_t i = from; i < run.frames.size(); ++i) {
    const Frame& frame = run.frames[i];
    if (!(frame.feet[0].load_n > kLoadedN && frame.feet[1].load_n > kLoadedN)) continue;
    const double bend_rad = LeastBend(run.body, frame.q, at);
    if (bend_rad > deepest.bend_rad) deepest = {i, bend_rad};
  }
  return deepest;
}

}  // namespace footing::pose_run

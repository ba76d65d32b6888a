#include "daemon/simulation/pose_service/subject_body.h"

#include <utility>

namespace footing::pose_service {
namespace {

constexpr double kMassOverHeightSquared = 22.5;  // kg/m^2: the middle of the healthy range.
/// The ankle joint is so much of the foot ahead of the heel (docs/body.md).
constexpr double kAnkleFromHeel = 0.25;

/// Ankle to ball and ball to tip, so that heel to tip has the length.
void StretchFeet(const body::Landmarks& landmarks, double length_m, body::Skeleton& skeleton) {
  using body::Landmark;
  for (const auto& [ball, tip] : {std::pair(Landmark::kLeftToe, Landmark::kLeftToeEnd),
                                  std::pair(Landmark::kRightToe, Landmark::kRightToeEnd)}) {
    if (landmarks[ball] < 0 || landmarks[tip] < 0) continue;
    Eigen::Vector3d& to_ball = skeleton.joints[static_cast<std::size_t>(landmarks[ball])].offset_m;
    Eigen::Vector3d& to_tip = skeleton.joints[static_cast<std::size_t>(landmarks[tip])].offset_m;
    const double ahead_m = (to_ball + to_tip).head<2>().norm();
    if (ahead_m <= 0) continue;
    const double scale = (1 - kAnkleFromHeel) * length_m / ahead_m;
    to_ball.head<2>() *= scale;
    to_tip.head<2>() *= scale;
  }
}

}  // namespace

Result<body::Body> MakeSubjectBody(const Subject& subject) {
  body::Skeleton skeleton = body::StandardPerson(subject.height_m);
  if (subject.foot_length_m > 0) {
    const auto landmarks = body::FindLandmarks(skeleton);
    if (!landmarks) return landmarks.error();
    StretchFeet(*landmarks, subject.foot_length_m, skeleton);
  }
  body::PersonParameters person;
  person.height_m = subject.height_m;
  person.mass_kg = subject.mass_kg > 0
                       ? subject.mass_kg
                       : kMassOverHeightSquared * subject.height_m * subject.height_m;
  return body::MakeBody(skeleton, person);
}

}  // namespace footing::pose_service

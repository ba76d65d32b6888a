#pragma once

#include <algorithm>
#include <random>

#include "common/body/body.h"
#include "common/body/landmarks.h"
#include "daemon/simulation/pose/gauss_newton.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

inline body::Body Person() {
  body::PersonParameters parameters;
  parameters.mass_kg = 70;
  parameters.height_m = 1.75;
  return body::MakeBody(body::StandardPerson(1.75), parameters).value();
}

/// Poses about the T-pose: a few correlated ways to move, like a person's.
inline Eigen::MatrixXd Poses(const body::Body& person, int count, int ways, std::uint32_t seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const int dof = person.skeleton.dof;
  Eigen::MatrixXd directions(dof, ways);
  for (int i = 0; i < directions.size(); ++i) directions(i) = 0.08 * normal(engine);
  directions.topRows<3>() *= 0.3;
  Eigen::MatrixXd poses(dof, count);
  const Eigen::VectorXd rest = body::TPose(person.skeleton, person.landmarks);
  for (int i = 0; i < count; ++i) {
    poses.col(i) = rest;
    for (int way = 0; way < ways; ++way) {
      poses.col(i) += normal(engine) / (1 + 0.2 * way) * directions.col(way);
    }
  }
  return poses;
}

struct World {
  body::Body person = Person();
  Eigen::MatrixXd poses = Poses(person, 400, 12, 1);
  PoseBasis basis = FitBasis(poses, {});
  body::Kinematics at{person.skeleton};

  Eigen::Vector3d At(const Eigen::VectorXd& q, body::Landmark landmark) {
    body::ComputeKinematics(person.skeleton, q, at);
    return at.p_WJ[static_cast<std::size_t>(person.landmarks[landmark])];
  }

  /// Hands, feet and COM of a pose, as if measured exactly.
  PoseTargets Targets(const Eigen::VectorXd& q, double sd_m) {
    PoseTargets targets;
    for (const body::Landmark landmark :
         {body::Landmark::kLeftWrist, body::Landmark::kRightWrist, body::Landmark::kLeftAnkle,
          body::Landmark::kRightAnkle, body::Landmark::kLeftToe, body::Landmark::kRightToe}) {
      PointTarget point;
      point.joint = person.landmarks[landmark];
      point.p_W_m = At(q, landmark);
      point.sd_m.setConstant(sd_m);
      targets.Add(point);
    }
    targets.has_com = true;
    targets.com_W_m = body::CentreOfMass(person, at);
    targets.com_sd_m.setConstant(sd_m);
    return targets;
  }

  double WorstM(const Eigen::VectorXd& q, const PoseTargets& targets) {
    body::ComputeKinematics(person.skeleton, q, at);
    double worst_m =
        targets.has_com ? (targets.com_W_m - body::CentreOfMass(person, at)).norm() : 0;
    for (int i = 0; i < targets.count; ++i) {
      const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
      const auto joint = static_cast<std::size_t>(point.joint);
      worst_m =
          std::max(worst_m, (point.p_W_m - at.p_WJ[joint] - at.R_WJ[joint] * point.p_J_m).norm());
    }
    return worst_m;
  }
};

}  // namespace footing::pose

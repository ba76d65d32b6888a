#include <Eigen/Core>
#include <cmath>

#include "common/body/momentum.h"
#include "common/runtime/clock.h"
#include "common/virtual/devices/random.h"
#include "daemon/offline/bench/pairs.h"

namespace footing::bench {
namespace {

constexpr int kKinematicsPairs = 15;
constexpr int kPoses = 64;
constexpr int kEvaluations = 20'000;  // A run: some 50 ms.
constexpr double kPersonHeightM = 1.75;

struct Poses {
  Eigen::MatrixXd q, q_dot;

  explicit Poses(int dof) : q(dof, kPoses), q_dot(dof, kPoses) {
    noise::Random random(1);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q(i) = random.Uniform(-1, 1);
      q_dot(i) = random.Uniform(-3, 3);
    }
  }
};

/// Microseconds of CPU time for one call.
template <typename F>
double CostUs(F evaluate) {
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (int i = 0; i < kEvaluations; ++i) evaluate(i % kPoses);
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e3 / kEvaluations;
}

}  // namespace

Result<Rows> BodyKinematics() {
  body::PersonParameters person;
  person.height_m = kPersonHeightM;
  const auto body = body::MakeBody(body::StandardPerson(kPersonHeightM), person);
  if (!body) return body.error();
  const body::Skeleton& skeleton = body->skeleton;
  const Poses poses(skeleton.dof);
  body::Kinematics at(skeleton);
  body::JointVelocities velocities(skeleton);
  body::CompositeMasses workspace(skeleton);
  body::CentroidalMatrix matrix(6, skeleton.dof);
  volatile double kept = 0;  // So that nothing is left out.
  const auto momentum = [&] {
    return CostUs([&](int pose) {
      body::ComputeKinematics(skeleton, poses.q.col(pose), at);
      body::ComputeVelocities(skeleton, at, poses.q_dot.col(pose), velocities);
      kept = body::ComputeMomentum(*body, at, velocities).angular_W.x();
    });
  };
  const auto centroidal = [&] {
    return CostUs([&](int pose) {
      body::ComputeKinematics(skeleton, poses.q.col(pose), at);
      body::ComputeCentroidalMatrix(*body, at, workspace, matrix);
      kept = matrix(3, 7);
    });
  };
  // What no forward kinematics can do without.
  const auto sines = [&] {
    return CostUs([&](int pose) {
      double sum = 0;
      for (int dof = 3; dof < skeleton.dof; ++dof) {
        sum += std::sin(poses.q(dof, pose)) * std::cos(poses.q(dof, pose));
      }
      kept = sum;
    });
  };
  return Rows{
      RunPairs("body_kinematics_com_momentum_us", "us (baseline: the angles' sines and cosines)",
               kKinematicsPairs, momentum, sines),
      RunPairs("body_centroidal_matrix_us", "us (baseline: the angles' sines and cosines)",
               kKinematicsPairs, centroidal, sines)};
}

}  // namespace footing::bench

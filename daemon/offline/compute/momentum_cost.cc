#include "daemon/offline/compute/momentum_cost.h"

#include <cstdint>

#include "common/body/kinematics.h"
#include "common/runtime/clock.h"

namespace footing::timing {
namespace {

constexpr int kRuns = 2000;

}  // namespace

double MomentumCostUs(const body::Body& body, const Eigen::VectorXd& q) {
  body::Kinematics at(body.skeleton);
  body::JointVelocities velocities(body.skeleton);
  const Eigen::VectorXd rate = Eigen::VectorXd::Constant(q.size(), 0.1);
  volatile double kept = 0;  // So that nothing is left out.
  const std::int64_t begin_ns = clock::ThreadCpuNs();
  for (int i = 0; i < kRuns; ++i) {
    body::ComputeKinematics(body.skeleton, q, at);
    body::ComputeVelocities(body.skeleton, at, rate, velocities);
    kept = body::ComputeMomentum(body, at, velocities).angular_W.x();
    static_cast<void>(kept);
  }
  return static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e3 / kRuns;
}

}  // namespace footing::timing

#include "daemon/simulation/reconstruction/head_seat.h"

#include "daemon/simulation/reconstruction/skeleton.h"

namespace footing::reconstruction {
namespace {

constexpr double kFarthestSeatM = 0.35;  // Further off is a camera that was never placed.
constexpr double kLeastShare = 0.5;
constexpr double kSureSdM = 0.025;  // Root mean square of the axes.

}  // namespace

bool HeadSeat::IsLone(const JointInputs& joints) {
  const JointInput& head = joints[kHeadJoint];
  return head.valid && head.sd_m.squaredNorm() <= 3 * kSureSdM * kSureSdM && !IsSkeleton(joints);
}

void HeadSeat::Start(const body::Point& middle) {
  *this = {};
  middle_ = point_ = middle;
}

void HeadSeat::See(const JointInputs& joints, const body::Kinematics& at, double step_s) {
  if (!Seeks()) return;
  sought_s_ += step_s;
  if (IsLone(joints)) {
    const JointInput& head = joints[kHeadJoint];
    const auto joint = static_cast<std::size_t>(middle_.joint);
    seen_s_ += step_s;
    sum_J_m_ += step_s * (at.R_WJ[joint].transpose() * (head.p_W_m - at.p_WJ[joint]));
  }
  if (Seeks() || seen_s_ < kLeastShare * sought_s_) return;
  const Eigen::Vector3d seat_m = sum_J_m_ / seen_s_;
  found_ = (seat_m - middle_.p_J_m).norm() <= kFarthestSeatM;
  if (found_) point_.p_J_m = seat_m;
}

}  // namespace footing::reconstruction

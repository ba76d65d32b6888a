#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/body/landmarks.h"
#include "common/base/units.h"

namespace footing::eval {

/// How far a value is from going on as it went: the root mean square of its second difference from
/// frame to frame.
class Roughness {
 public:
  /// The value of the next frame; only where `counted`.
  void Add(double value, bool counted = true) {
    const double bend = value - 2 * last_ + before_;
    before_ = last_;
    last_ = value;
    if (++frames_ < 3 || !counted) return;
    sum_ += bend * bend;
    ++count_;
  }
  double rms() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0; }

 private:
  double last_ = 0, before_ = 0, sum_ = 0;
  int frames_ = 0, count_ = 0;
};

/// By how much an elbow is bent; 0 is a straight arm. Side 0 is the left one.
inline double ElbowBendDeg(const body::Landmarks& landmarks, const body::Kinematics& at, int side) {
  const auto place = [&](body::Landmark left) {
    const body::Landmark landmark = side == 0 ? left : body::Mirrored(left);
    return at.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
  };
  const Eigen::Vector3d elbow = place(body::Landmark::kLeftElbow);
  const Eigen::Vector3d upper = elbow - place(body::Landmark::kLeftShoulder);
  const Eigen::Vector3d fore = place(body::Landmark::kLeftWrist) - elbow;
  return RadiansToDegrees(
      std::acos(std::clamp(upper.normalized().dot(fore.normalized()), -1.0, 1.0)));
}

}  // namespace footing::eval

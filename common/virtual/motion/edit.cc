#include "common/virtual/motion/edit.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/low_pass.h"
#include "common/base/result.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/table.h"

namespace footing::motion {
namespace {

constexpr double kCutoffOfNewRate = 0.4;
constexpr double kStandShare = 0.25;  // Share of the frames that have a foot lower than it stands.

std::size_t Index(int value) { return static_cast<std::size_t>(value); }

/// The rotations of a joint through the frames, a quaternion a column, signs continuous.
Eigen::MatrixXd QuaternionsOf(const body::Joint& joint, const Motion& motion) {
  Eigen::MatrixXd quaternions(4, motion.frames());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::Quaterniond turned(JointRotation(joint, motion.q.col(frame)));
    quaternions.col(frame) = turned.coeffs();
    if (frame > 0 && quaternions.col(frame).dot(quaternions.col(frame - 1)) < 0) {
      quaternions.col(frame) *= -1;
    }
  }
  return quaternions;
}

/// Low-passes a motion whose angles are continuous.
void LowPassPoses(double cutoff_hz, Motion& motion) {
  if (motion.frames() == 0) return;
  const Motion before = motion;
  motion.q = LowPass(before.q, motion.rate_hz, cutoff_hz);
  for (const body::Joint& joint : motion.skeleton.joints) {
    if (joint.rotations.size() != 3) continue;
    const Eigen::MatrixXd smooth = LowPass(QuaternionsOf(joint, before), motion.rate_hz, cutoff_hz);
    Eigen::VectorXd q = before.q.col(0);
    for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
      const Eigen::Quaterniond turned(Eigen::Vector4d(smooth.col(frame).normalized()));
      // Turns that cancel each other within the filter's time leave no rotation.
      if (smooth.col(frame).norm() > 0.01) SetJointRotation(joint, turned.toRotationMatrix(), q);
      motion.q.col(frame).segment<3>(joint.first_dof) = q.segment<3>(joint.first_dof);
    }
  }
}

}  // namespace

Eigen::VectorXd NearestPose(const body::Skeleton& skeleton, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& near_q) {
  Eigen::VectorXd nearest = near_q;
  nearest.head<3>() = q.head<3>();
  for (const body::Joint& joint : skeleton.joints) {
    if (joint.rotations.size() == 3) {
      SetJointRotation(joint, JointRotation(joint, q), nearest);
      continue;
    }
    for (std::size_t i = 0; i < joint.rotations.size(); ++i) {
      const int dof = joint.first_dof + static_cast<int>(i);
      nearest(dof) = NearestTurn(q(dof), near_q(dof));
    }
  }
  return nearest;
}

Motion Continuous(Motion motion) {
  for (Eigen::Index frame = 1; frame < motion.frames(); ++frame) {
    motion.q.col(frame) =
        NearestPose(motion.skeleton, motion.q.col(frame), motion.q.col(frame - 1));
  }
  return motion;
}

Motion Canonical(Motion motion) {
  if (motion.frames() > 0) {
    motion.q.col(0) =
        NearestPose(motion.skeleton, motion.q.col(0), Eigen::VectorXd::Zero(motion.skeleton.dof));
  }
  return Continuous(std::move(motion));
}

Motion Smoothed(const Motion& motion, double cutoff_hz) {
  Motion smooth = Continuous(motion);
  LowPassPoses(cutoff_hz, smooth);
  return smooth;
}

Motion Resampled(const Motion& motion, double rate_hz) {
  FOOTING_CHECK(IsRate(rate_hz));
  Motion out = Continuous(motion);
  if (rate_hz == motion.rate_hz) return out;
  if (rate_hz < motion.rate_hz) LowPassPoses(kCutoffOfNewRate * rate_hz, out);
  const Spline spline(std::move(out.q), motion.rate_hz);
  const double span_s = static_cast<double>(motion.frames() - 1) / motion.rate_hz;
  const auto frames = static_cast<Eigen::Index>(std::floor(span_s * rate_hz + 1e-9)) + 1;
  out.rate_hz = rate_hz;
  out.q.resize(motion.skeleton.dof, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    out.q.col(i) = spline.Value(static_cast<double>(i) / rate_hz);
  }
  return out;
}

MotionRates Rates(const Motion& motion) {
  const Spline spline(Continuous(motion).q, motion.rate_hz);
  MotionRates rates{Eigen::MatrixXd(motion.q.rows(), motion.frames()),
                    Eigen::MatrixXd(motion.q.rows(), motion.frames())};
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const double t_s = static_cast<double>(i) / motion.rate_hz;
    rates.q_dot.col(i) = spline.FirstDerivative(t_s);
    rates.q_ddot.col(i) = spline.SecondDerivative(t_s);
  }
  return rates;
}

Motion Looped(const Motion& motion, double seconds, double ease_s) {
  FOOTING_CHECK(seconds >= 0 && ease_s >= 0);
  Motion out = Continuous(motion);
  const double span_s = static_cast<double>(motion.frames() - 1) / motion.rate_hz;
  const auto frames = static_cast<Eigen::Index>(std::floor(seconds * motion.rate_hz + 1e-9)) + 1;
  const Spline spline(std::move(out.q), motion.rate_hz);
  out.q.resize(motion.skeleton.dof, frames);
  // One way: speed 1 in the middle, linear to 0 over `ease` of clip at its ends. A stretch e of
  // clip at mean speed 1/2 takes 2 e.
  const double ease = std::min(ease_s, span_s / 2);
  const double way_s = span_s + 2 * ease;
  for (Eigen::Index i = 0; i < frames; ++i) {
    double at = 0;
    if (way_s > 0) {
      at = std::fmod(static_cast<double>(i) / motion.rate_hz, 2 * way_s);
      if (at > way_s) at = 2 * way_s - at;
      const bool late = at > way_s / 2;
      const double from_end = late ? way_s - at : at;
      const double along =
          ease > 0 && from_end < 2 * ease ? from_end * from_end / (4 * ease) : from_end - ease;
      at = late ? span_s - along : along;
    }
    out.q.col(i) = spline.Value(at);
  }
  return out;
}

Motion FacingForward(const Motion& motion, const body::Landmarks& landmarks) {
  body::Kinematics at(motion.skeleton);
  std::vector<double> x, y, turn_x, turn_y;
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
    const Eigen::Vector3d left = at.p_WJ[Index(landmarks[body::Landmark::kLeftHip])];
    const Eigen::Vector3d right = at.p_WJ[Index(landmarks[body::Landmark::kRightHip])];
    const Eigen::Vector3d ahead = (left - right).cross(Eigen::Vector3d::UnitZ()).normalized();
    x.push_back((left.x() + right.x()) / 2);
    y.push_back((left.y() + right.y()) / 2);
    turn_x.push_back(ahead.x());
    turn_y.push_back(ahead.y());
  }
  const double heading_rad = std::atan2(text::Median(turn_y), text::Median(turn_x));
  const Eigen::Vector3d middle(text::Median(x), text::Median(y), 0);
  const Eigen::Matrix3d back = body::AxisRotation(body::Axis::kZ, -heading_rad);
  Motion out = motion;
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd before = motion.q.col(frame);
    Eigen::VectorXd q = before;
    if (frame > 0) {  // Near the frame before.
      const Eigen::VectorXd last = out.q.col(frame - 1);
      q.segment(root.first_dof, static_cast<int>(root.rotations.size())) =
          last.segment(root.first_dof, static_cast<int>(root.rotations.size()));
    }
    q.head<3>() = back * (before.head<3>() - middle);
    SetJointRotation(root, back * JointRotation(root, before), q);
    out.q.col(frame) = q;
  }
  return out;
}

double FloorHeight(const Motion& motion, const body::Landmarks& landmarks) {
  std::vector<int> joints;
  for (const body::Landmark left : {body::Landmark::kLeftAnkle, body::Landmark::kLeftToe}) {
    for (const body::Landmark landmark : {left, body::Mirrored(left)}) {
      if (landmarks[landmark] >= 0) joints.push_back(landmarks[landmark]);
    }
  }
  body::Kinematics standing(motion.skeleton), at(motion.skeleton);
  body::ComputeKinematics(motion.skeleton, body::TPose(motion.skeleton, landmarks), standing);
  std::vector<double> lowest;
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    body::ComputeKinematics(motion.skeleton, motion.q.col(i), at);
    double low = std::numeric_limits<double>::infinity();
    for (const int joint : joints) {
      const auto index = static_cast<std::size_t>(joint);
      low = std::min(low, at.p_WJ[index].z() - standing.p_WJ[index].z());
    }
    lowest.push_back(low);
  }
  return text::Quantile(std::move(lowest), kStandShare);
}

namespace {

using body::Joint;
using body::Landmark;

/// `name` with its first `from` replaced, where it has one.
std::optional<std::string> Replaced(const std::string& name, std::string_view from,
                                    std::string_view to) {
  const auto at = name.find(from);
  if (at == std::string::npos) return std::nullopt;
  std::string replaced = name;
  return replaced.replace(at, from.size(), to);
}

/// The joint of the other side by its name, or the joint itself.
int Partner(const body::Skeleton& skeleton, int index) {
  constexpr std::pair<std::string_view, std::string_view> kSides[] = {
      {"Left", "Right"}, {"left", "right"}, {"LEFT", "RIGHT"}, {"_L_", "_R_"},
      {"_l_", "_r_"},    {".L", ".R"},      {".l", ".r"},
  };
  const std::string& name = skeleton.joint(index).name;
  const auto there = [&](const std::optional<std::string>& other) {
    return other ? body::FindJoint(skeleton, *other) : -1;
  };
  for (const auto& [left, right] : kSides) {
    for (const auto& other : {Replaced(name, left, right), Replaced(name, right, left)}) {
      if (const int found = there(other); found >= 0) return found;
    }
  }
  for (const auto& [a, b] : {std::pair{'l', 'r'}, {'r', 'l'}, {'L', 'R'}, {'R', 'L'}}) {
    if (name.empty() || name[0] != a) continue;
    if (const int found = there(b + name.substr(1)); found >= 0) return found;
  }
  return index;
}

Eigen::Matrix3d Mirror() { return Eigen::Vector3d(1, -1, 1).asDiagonal(); }

}  // namespace

Motion Mirrored(const Motion& motion) {
  const Eigen::Matrix3d S = Mirror();
  std::vector<int> partner;
  std::vector<Joint> joints = motion.skeleton.joints;
  for (int i = 0; i < motion.skeleton.size(); ++i) {
    partner.push_back(Partner(motion.skeleton, i));
    joints[static_cast<std::size_t>(i)].offset_m =
        S * motion.skeleton.joint(partner.back()).offset_m;
  }
  Motion out{body::MakeSkeleton(std::move(joints)), motion.rate_hz, motion.start_s, motion.q};
  Eigen::VectorXd q = Eigen::VectorXd::Zero(motion.skeleton.dof);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const Eigen::VectorXd from = motion.q.col(frame);
    q.head<3>() = S * from.head<3>();
    for (int i = 0; i < motion.skeleton.size(); ++i) {
      const Joint& other = motion.skeleton.joint(partner[static_cast<std::size_t>(i)]);
      SetJointRotation(out.skeleton.joint(i), S * JointRotation(other, from) * S, q);
    }
    out.q.col(frame) = q;
  }
  return out;
}

Result<std::vector<std::string>> HumanBones(const body::Skeleton& skeleton) {
  const auto found = body::FindLandmarks(skeleton);
  if (!found) return found.error();
  const body::Landmarks& landmarks = *found;
  using body::Landmark;
  std::vector<std::string> names(skeleton.joints.size());
  const auto set = [&](int joint, const std::string& name) {
    if (joint >= 0 && names[Index(joint)].empty()) names[Index(joint)] = name;
  };
  set(landmarks[Landmark::kHips], "Hips");
  set(landmarks[Landmark::kNeck], "Neck");
  set(landmarks[Landmark::kHead], "Head");
  constexpr std::pair<Landmark, const char*> kOfSide[] = {
      {Landmark::kLeftClavicle, "Shoulder"}, {Landmark::kLeftShoulder, "UpperArm"},
      {Landmark::kLeftElbow, "LowerArm"},    {Landmark::kLeftWrist, "Hand"},
      {Landmark::kLeftHip, "UpperLeg"},      {Landmark::kLeftKnee, "LowerLeg"},
      {Landmark::kLeftAnkle, "Foot"},        {Landmark::kLeftToe, "Toes"}};
  for (const int side : {0, 1}) {
    for (const auto& [landmark, name] : kOfSide) {
      set(landmarks[body::OfSide(landmark, side)],
          (side == 0 ? "Left" : "Right") + std::string(name));
    }
  }
  // The trunk from below: the first joint, the second one, and the uppermost.
  std::vector<int> trunk;
  for (int joint = skeleton.joint(landmarks[Landmark::kNeck]).parent;
       joint >= 0 && joint != landmarks[Landmark::kHips]; joint = skeleton.joint(joint).parent) {
    trunk.insert(trunk.begin(), joint);
  }
  if (!trunk.empty()) set(trunk.front(), "Spine");
  if (trunk.size() > 2) set(trunk.back(), "UpperChest");
  if (trunk.size() > 1) set(trunk[1], "Chest");
  return names;
}

Result<Motion> Humanoid(const Motion& motion) {
  const body::Skeleton& from = motion.skeleton;
  const auto landmarks = body::FindLandmarks(from);
  if (!landmarks) return landmarks.error();
  const std::vector<std::string> names = HumanBones(from).value();
  body::Kinematics rest(from);
  body::ComputeKinematics(from, body::TPose(from, *landmarks), rest);
  std::vector<body::Joint> joints;
  for (int i = 0; i < from.size(); ++i) {
    body::Joint joint;
    joint.name = names[Index(i)].empty() ? from.joint(i).name : names[Index(i)];
    joint.parent = from.joint(i).parent;
    if (i > 0) joint.offset_m = rest.p_WJ[Index(i)] - rest.p_WJ[Index(joint.parent)];
    if (!body::IsEnd(from, i)) {
      joint.rotations = {{body::Axis::kZ}, {body::Axis::kX}, {body::Axis::kY}};
    }
    joints.push_back(std::move(joint));
  }
  Motion out{body::MakeSkeleton(std::move(joints)), motion.rate_hz, motion.start_s, {}};
  out.q.setZero(out.skeleton.dof, motion.frames());
  body::Kinematics at(from);
  std::vector<Eigen::Matrix3d> R_WJ(from.joints.size());
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    if (frame > 0) out.q.col(frame) = out.q.col(frame - 1);  // The nearest angles.
    body::ComputeKinematics(from, motion.q.col(frame), at);
    out.q.col(frame).head<3>() = motion.q.col(frame).head<3>();
    for (int i = 0; i < from.size(); ++i) {
      const body::Joint& joint = out.skeleton.joint(i);
      R_WJ[Index(i)] = at.R_WJ[Index(i)] * rest.R_WJ[Index(i)].transpose();
      if (joint.rotations.empty()) continue;
      const Eigen::Matrix3d R_PJ =
          i == 0 ? R_WJ[0]
                 : Eigen::Matrix3d(R_WJ[Index(joint.parent)].transpose() * R_WJ[Index(i)]);
      body::SetJointRotation(joint, R_PJ, out.q.col(frame));
    }
  }
  return out;
}

Result<Motion> WithLandmarksOnly(const Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return landmarks.error();
  const body::Skeleton& from = motion.skeleton;
  std::vector<bool> keep(from.joints.size(), false);
  for (int i = 0; i < body::kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    if (landmark == Landmark::kLeftHandEnd || landmark == Landmark::kRightHandEnd) continue;
    for (int joint = (*landmarks)[landmark]; joint >= 0; joint = from.joint(joint).parent) {
      keep[static_cast<std::size_t>(joint)] = true;
    }
  }
  // Where each kept joint goes, and which of the dropped ones ends a wrist.
  std::vector<Joint> joints;
  std::vector<int> place(from.joints.size(), -1), sources;
  const auto add = [&](int index) {
    Joint joint = from.joint(index);
    joint.parent = index == 0 ? -1 : place[static_cast<std::size_t>(joint.parent)];
    place[static_cast<std::size_t>(index)] = static_cast<int>(joints.size());
    sources.push_back(index);
    joints.push_back(std::move(joint));
  };
  for (int i = 0; i < from.size(); ++i) {
    if (!keep[static_cast<std::size_t>(i)]) continue;
    add(i);
    for (const auto& [wrist, end] : {std::pair{Landmark::kLeftWrist, Landmark::kLeftHandEnd},
                                     {Landmark::kRightWrist, Landmark::kRightHandEnd}}) {
      if (i != (*landmarks)[wrist]) continue;
      int child = (*landmarks)[end];
      while (child >= 0 && from.joint(child).parent != i) child = from.joint(child).parent;
      for (int k = i + 1; child < 0 && k < from.size(); ++k) {
        if (from.joint(k).parent == i) child = k;
      }
      if (child < 0) continue;
      Joint tip;
      tip.name = from.joint(i).name + "_end";
      tip.parent = place[static_cast<std::size_t>(i)];
      tip.offset_m = from.joint(child).offset_m;
      joints.push_back(std::move(tip));
      sources.push_back(-1);
    }
  }
  Motion out{body::MakeSkeleton(std::move(joints)), motion.rate_hz, motion.start_s, {}};
  out.q.resize(out.skeleton.dof, motion.frames());
  out.q.topRows<3>() = motion.q.topRows<3>();
  for (int i = 0; i < out.skeleton.size(); ++i) {
    const Joint& joint = out.skeleton.joint(i);
    const auto rows = static_cast<Eigen::Index>(joint.rotations.size());
    if (rows == 0) continue;
    out.q.middleRows(joint.first_dof, rows) =
        motion.q.middleRows(from.joint(sources[static_cast<std::size_t>(i)]).first_dof, rows);
  }
  return out;
}

Spline::Spline(Eigen::MatrixXd samples, double rate_hz)
    : samples_(std::move(samples)), rate_hz_(rate_hz) {
  FOOTING_CHECK(samples_.cols() > 0 && rate_hz > 0);
  const Eigen::Index n = samples_.cols();
  curvatures_.setZero(samples_.rows(), n);
  if (n < 3) return;
  // c[i-1] + 4 c[i] + c[i+1] = 6 (x[i-1] - 2 x[i] + x[i+1]) / h^2, c = 0 at both ends.
  Eigen::VectorXd upper(n);
  upper(0) = 0;
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double pivot = 1 / (4 - upper(i - 1));
    upper(i) = pivot;
    curvatures_.col(i) =
        pivot *
        (6 * rate_hz * rate_hz * (samples_.col(i - 1) - 2 * samples_.col(i) + samples_.col(i + 1)) -
         curvatures_.col(i - 1));
  }
  for (Eigen::Index i = n - 3; i >= 1; --i) {
    curvatures_.col(i) -= upper(i) * curvatures_.col(i + 1);
  }
}

Spline::Place Spline::At(double t_s) const {
  const double last = static_cast<double>(samples_.cols() - 1);
  const double at = std::clamp(t_s * rate_hz_, 0.0, last);
  const auto before = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at), 0,
                                               std::max<Eigen::Index>(samples_.cols() - 2, 0));
  return {before, at - static_cast<double>(before)};
}

Eigen::VectorXd Spline::Value(double t_s) const {
  if (samples_.cols() == 1) return samples_.col(0);
  const auto [i, b] = At(t_s);
  const double a = 1 - b, h2 = 1 / (6 * rate_hz_ * rate_hz_);
  return a * samples_.col(i) + b * samples_.col(i + 1) +
         h2 * ((a * a * a - a) * curvatures_.col(i) + (b * b * b - b) * curvatures_.col(i + 1));
}

Eigen::VectorXd Spline::FirstDerivative(double t_s) const {
  if (samples_.cols() == 1) return Eigen::VectorXd::Zero(samples_.rows());
  const auto [i, b] = At(t_s);
  const double a = 1 - b, h = 1 / (6 * rate_hz_);
  return rate_hz_ * (samples_.col(i + 1) - samples_.col(i)) +
         h * ((1 - 3 * a * a) * curvatures_.col(i) + (3 * b * b - 1) * curvatures_.col(i + 1));
}

Eigen::VectorXd Spline::SecondDerivative(double t_s) const {
  if (samples_.cols() == 1) return Eigen::VectorXd::Zero(samples_.rows());
  const auto [i, b] = At(t_s);
  return (1 - b) * curvatures_.col(i) + b * curvatures_.col(i + 1);
}

}  // namespace footing::motion

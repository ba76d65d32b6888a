#include "daemon/offline/analysis/pose_metrics.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/base/rotation.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::eval {
namespace {

using body::Landmark;
using nlohmann::ordered_json;

constexpr const char* kAngles[] = {"hip", "knee", "shoulder", "elbow", "chest"};
constexpr const char* kHipParts[] = {
    "hip_swing_deg",       "hip_twist_deg",   "hip_twist_bent_deg", "pelvis_deg",
    "thigh_direction_deg", "hip_flexion_deg", "hip_abduction_deg",  "hip_rotation_deg"};
constexpr double kBentDeg = 30;  // Flexion of the true knee from which the turn of the thigh shows.

void AddSides(const body::Body& body, Landmark left, std::vector<int>& joints) {
  for (const Landmark landmark : {left, body::Mirrored(left)}) {
    if (body.landmarks[landmark] >= 0) joints.push_back(body.landmarks[landmark]);
  }
}

/// The joint between elbow and wrist, if there is one: the forearm's own.
void AddForearms(const body::Body& body, std::vector<int>& joints) {
  for (const Landmark left : {Landmark::kLeftWrist, body::Mirrored(Landmark::kLeftWrist)}) {
    const Landmark elbow =
        left == Landmark::kLeftWrist ? Landmark::kLeftElbow : body::Mirrored(Landmark::kLeftElbow);
    const int parent = body.skeleton.joint(body.landmarks[left]).parent;
    if (parent != body.landmarks[elbow]) joints.push_back(parent);
  }
}

/// Base of the skull: a CMU skeleton's own "head", else its landmark.
int SkullBase(const body::Body& body) {
  const int head = body::FindJoint(body.skeleton, "head");
  return head >= 0 ? head : body.landmarks[Landmark::kHead];
}

double AngleDeg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const double cosine = ((a.transpose() * b).trace() - 1) / 2;
  return RadiansToDegrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
}

double DirectionDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return RadiansToDegrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

/// How `b` is turned against `a` beyond the least turn that brings the direction `along_b` to
/// `along_a`, both of unit length.
double TwistDeg(const Eigen::Matrix3d& a, const Eigen::Vector3d& along_a, const Eigen::Matrix3d& b,
                const Eigen::Vector3d& along_b) {
  const Eigen::Quaterniond swing = LeastTurn(along_b, along_a);
  return AngleDeg(a, swing.toRotationMatrix() * b);
}

/// Mean length of what is left of the vectors when their mean is taken off.
double MeanAboutMean(const std::vector<Eigen::Vector3d>& vectors) {
  if (vectors.empty()) return 0;
  const auto count = static_cast<double>(vectors.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vector : vectors) mean += vector / count;
  double sum = 0;
  for (const Eigen::Vector3d& vector : vectors) sum += (vector - mean).norm();
  return sum / count;
}

}  // namespace

JudgedJoints::JudgedJoints(const body::Body& body) {
  for (const Landmark left :
       {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, Landmark::kLeftToe}) {
    AddSides(body, left, legs);
  }
  for (const int joint : {0, body.landmarks[Landmark::kChest], body.landmarks[Landmark::kNeck],
                          SkullBase(body), body.landmarks[Landmark::kVertex]}) {
    if (joint >= 0) torso.push_back(joint);
  }
  for (const Landmark left :
       {Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist}) {
    AddSides(body, left, arms);
  }
  AddForearms(body, arms);
}

double Spread::mean() const {
  double sum = 0;
  for (const double value : values_) sum += value;
  return values_.empty() ? 0 : sum / static_cast<double>(values_.size());
}

double Spread::rms() const {
  double sum = 0;
  for (const double value : values_) sum += value * value;
  return values_.empty() ? 0 : std::sqrt(sum / static_cast<double>(values_.size()));
}

double Spread::Quantile(double share) const {
  if (values_.empty()) return 0;
  return text::OfRank(values_,
                      static_cast<std::size_t>(share * static_cast<double>(values_.size() - 1)));
}

PoseScore::PoseScore(const body::Body& body)
    : body_(body),
      joints_(body),
      at_(body.skeleton),
      truth_(body.skeleton),
      errors_m_(static_cast<std::size_t>(body.skeleton.size())),
      t_pose_(body.skeleton) {
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), t_pose_);
}

double PoseScore::Mean(const std::vector<int>& joints, const Eigen::Vector3d& shift) const {
  double sum = 0;
  for (const int joint : joints) {
    sum += (errors_m_[static_cast<std::size_t>(joint)] - shift).norm();
  }
  return joints.empty() ? 0 : 100 * sum / static_cast<double>(joints.size());
}

void PoseScore::Add(const Eigen::VectorXd& q, const Eigen::VectorXd& true_q) {
  body::ComputeKinematics(body_.skeleton, q, at_);
  body::ComputeKinematics(body_.skeleton, true_q, truth_);
  for (std::size_t i = 0; i < errors_m_.size(); ++i) errors_m_[i] = at_.p_WJ[i] - truth_.p_WJ[i];
  const auto all = [this](const Eigen::Vector3d& shift) {
    const auto n = [](const std::vector<int>& joints) {
      return static_cast<double>(joints.size());
    };
    return (n(joints_.legs) * Mean(joints_.legs, shift) +
            n(joints_.torso) * Mean(joints_.torso, shift) +
            n(joints_.arms) * Mean(joints_.arms, shift)) /
           (n(joints_.legs) + n(joints_.torso) + n(joints_.arms));
  };
  frames_.Add(all(Eigen::Vector3d::Zero()));
  relative_.Add(all(errors_m_[0]));
  legs_.Add(Mean(joints_.legs, Eigen::Vector3d::Zero()));
  torso_.Add(Mean(joints_.torso, Eigen::Vector3d::Zero()));
  arms_.Add(Mean(joints_.arms, Eigen::Vector3d::Zero()));
  AddAngles();
}

void PoseScore::AddAngles() {
  const auto local = [this](const body::Kinematics& at, int joint) -> Eigen::Matrix3d {
    const int parent = body_.skeleton.joint(joint).parent;
    return at.R_WJ[static_cast<std::size_t>(parent)].transpose() *
           at.R_WJ[static_cast<std::size_t>(joint)];
  };
  constexpr Landmark kLeft[] = {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftShoulder,
                                Landmark::kLeftElbow};
  for (std::size_t i = 0; i < 4; ++i) {
    for (const Landmark landmark : {kLeft[i], body::Mirrored(kLeft[i])}) {
      const int joint = body_.landmarks[landmark];
      angles_[i].Add(AngleDeg(local(at_, joint), local(truth_, joint)));
    }
  }
  AddHips();
  const int chest = body_.landmarks[Landmark::kChest];
  if (chest < 0) return;
  const auto index = static_cast<std::size_t>(chest);
  angles_[4].Add(AngleDeg(at_.R_WJ[index], truth_.R_WJ[index]));  // Against the world.
}

void PoseScore::AddHips() {
  for (int side = 0; side < 2; ++side) {
    const auto joint = [&](Landmark left) {
      return static_cast<std::size_t>(body_.landmarks[body::OfSide(left, side)]);
    };
    const std::size_t h = joint(Landmark::kLeftHip), k = joint(Landmark::kLeftKnee);
    const auto pelvis = static_cast<std::size_t>(body_.skeleton.joints[h].parent);
    const auto thigh_W = [&](const body::Kinematics& at) -> Eigen::Vector3d {
      return (at.p_WJ[k] - at.p_WJ[h]).normalized();
    };
    const auto in_pelvis = [&](const body::Kinematics& at) -> Eigen::Matrix3d {
      return at.R_WJ[pelvis].transpose() * at.R_WJ[h];
    };
    const Eigen::Vector3d along = at_.R_WJ[pelvis].transpose() * thigh_W(at_);
    const Eigen::Vector3d true_along = truth_.R_WJ[pelvis].transpose() * thigh_W(truth_);
    const double twist_deg = TwistDeg(in_pelvis(at_), along, in_pelvis(truth_), true_along);
    const Eigen::AngleAxisd turn(in_pelvis(truth_).transpose() * in_pelvis(at_));
    hip_turns_rad_[static_cast<std::size_t>(side)].emplace_back(turn.angle() * turn.axis());
    const double bent_deg = AngleDeg(truth_.R_WJ[h], truth_.R_WJ[k]);
    hips_[0].Add(DirectionDeg(along, true_along));
    hips_[1].Add(twist_deg);
    if (bent_deg > kBentDeg) hips_[2].Add(twist_deg);
    hips_[3].Add(AngleDeg(at_.R_WJ[pelvis], truth_.R_WJ[pelvis]));
    hips_[4].Add(DirectionDeg(thigh_W(at_), thigh_W(truth_)));
    const auto angles = [&](const body::Kinematics& pose) {
      return HipAnglesDeg(t_pose_.R_WJ[pelvis] * in_pelvis(pose) * t_pose_.R_WJ[h].transpose(),
                          side);
    };
    const HipAngles off = Difference(angles(at_), angles(truth_));
    hips_[5].Add(off.flexion);
    hips_[6].Add(off.abduction);
    hips_[7].Add(off.rotation);
  }
}

ordered_json PoseScore::Json() const {
  ordered_json json = {{"mpjpe_cm", frames_.mean()},
                       {"mpjpe_p50_cm", frames_.Quantile(0.5)},
                       {"mpjpe_p95_cm", frames_.Quantile(0.95)},
                       {"mpjpe_root_relative_cm", relative_.mean()},
                       {"mpjpe_root_relative_p95_cm", relative_.Quantile(0.95)},
                       {"mpjpe_legs_cm", legs_.mean()},
                       {"mpjpe_torso_cm", torso_.mean()},
                       {"mpjpe_arms_cm", arms_.mean()}};
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    json["joint_angle_error_deg"][kAngles[i]] = angles_[i].mean();
  }
  for (std::size_t i = 0; i < hips_.size(); ++i) json[kHipParts[i]] = hips_[i].mean();
  json["hip_about_mean_deg"] =
      RadiansToDegrees(MeanAboutMean(hip_turns_rad_[0]) + MeanAboutMean(hip_turns_rad_[1])) / 2;
  return json;
}

HipAngles HipAnglesDeg(const Eigen::Matrix3d& R_PT, int side) {
  const double outwards = side == 0 ? 1 : -1;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ(), along = R_PT * down;
  const Eigen::Matrix3d about = LeastTurn(down, along).toRotationMatrix().transpose() * R_PT;
  return {RadiansToDegrees(std::atan2(along.x(), -along.z())),
          RadiansToDegrees(std::asin(std::clamp(outwards * along.y(), -1.0, 1.0))),
          RadiansToDegrees(-outwards * std::atan2(about(1, 0), about(0, 0)))};
}

HipAngles Difference(const HipAngles& a, const HipAngles& b) {
  const auto off = [](double one, double other) {
    return std::abs(std::remainder(one - other, 360.0));
  };
  return {off(a.flexion, b.flexion), off(a.abduction, b.abduction), off(a.rotation, b.rotation)};
}

}  // namespace footing::eval

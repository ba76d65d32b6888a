#include "common/virtual/people/perform.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/people/script.h"

namespace footing::choreography {
namespace {

constexpr int kRounds = 3;
constexpr int kCentrings = 3;          // Iterations for the root, a frame and round.
constexpr double kKneeBentRad = 0.14;  // At least; a straight knee is stiff.
constexpr double kFirstKneeRad = 0.3;
constexpr double kReachSoftM = 0.004;  // How softly the longer leg pulls the hips down.
constexpr double kSwayFadeS = 2;

/// Targets of a script for each frame.
struct Target {
  Values values;
  Eigen::Vector2d pressure_m;
};

class Dancer {
 public:
  Dancer(const Script& script, const body::Body& body, double rate_hz)
      : body_(body),
        posture_(body),
        legs_{motion::LegSolver(body, true), motion::LegSolver(body, false)},
        at_(body.skeleton) {
    const double end_s = script.duration_s();
    for (const Values& values : Sample(script, rate_hz)) {
      const double t_s = static_cast<double>(targets_.size()) / rate_hz;
      const double fade = std::clamp(std::min(t_s, end_s - t_s) / kSwayFadeS, 0.0, 1.0);
      targets_.push_back({values, posture_.PressureOf(values) +
                                      fade * fade * (3 - 2 * fade) * Sway(script.sway_m, t_s)});
    }
    motion_.skeleton = body.skeleton;
    motion_.rate_hz = rate_hz;
    motion_.q.resize(body.skeleton.dof, static_cast<Eigen::Index>(targets_.size()));
    motion_.q.colwise() = posture_.t_pose();
    // The knee that bends to the back, of the two that reach as far.
    for (const motion::LegSolver& leg : legs_) motion_.q(leg.knee_dof(), 0) = kFirstKneeRad;
    reach_m_ = std::sqrt(std::pow(legs_[0].thigh_m(), 2) + std::pow(legs_[0].shank_m(), 2) +
                         2 * legs_[0].thigh_m() * legs_[0].shank_m() * std::cos(kKneeBentRad));
  }

  /// Every frame with its centre of mass over `com_m` (a column a frame).
  void Move(const Eigen::Matrix2Xd& com_m) {
    foot_error_m_ = 0;
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const auto frame = static_cast<Eigen::Index>(i);
      auto q = motion_.q.col(frame);
      // Angles begin at the frame before, so that none jumps by a turn.
      if (i > 0) q.tail(q.size() - 3) = motion_.q.col(frame - 1).tail(q.size() - 3);
      posture_.PlaceUpperBody(targets_[i].values, q);
      for (int round = 0; round < kCentrings; ++round) {
        PlaceHips(targets_[i].values, q);
        for (int foot = 0; foot < 2; ++foot) {
          const double rest = legs_[static_cast<std::size_t>(foot)].Solve(
              posture_.FootOf(targets_[i].values, foot), q);
          if (round == kCentrings - 1) foot_error_m_ = std::max(foot_error_m_, rest);
        }
        if (round == kCentrings - 1) break;
        body::ComputeKinematics(body_.skeleton, q, at_);
        q.head<2>() += com_m.col(frame) - body::CentreOfMass(body_, at_).head<2>();
      }
    }
  }

  Eigen::Matrix2Xd WishedPressure() const {
    Eigen::Matrix2Xd out(2, static_cast<Eigen::Index>(targets_.size()));
    for (std::size_t i = 0; i < targets_.size(); ++i)
      out.col(static_cast<Eigen::Index>(i)) = targets_[i].pressure_m;
    return out;
  }
  const motion::Motion& motion() const { return motion_; }
  double foot_error_m() const { return foot_error_m_; }

 private:
  /// As high as the script says and both legs reach, with knees that stay a little bent.
  void PlaceHips(const Values& values, Eigen::Ref<Eigen::VectorXd> q) {
    body::ComputeKinematics(body_.skeleton, q, at_);
    double pull = std::exp(0.0);
    const double wished = posture_.t_pose()(2) - At(values, Channel::kCrouch);
    for (int foot = 0; foot < 2; ++foot) {
      const motion::LegSolver& leg = legs_[static_cast<std::size_t>(foot)];
      const Eigen::Vector3d hip = at_.p_WJ[static_cast<std::size_t>(leg.hip())];
      const Eigen::Vector3d ankle = posture_.FootOf(values, foot).p_WA;
      const double across = (hip - ankle).head<2>().norm();
      const double up = std::sqrt(std::max(reach_m_ * reach_m_ - across * across, 0.01));
      const double highest = q(2) + ankle.z() + up - hip.z();
      pull += std::exp((wished - highest) / kReachSoftM);
    }
    q(2) = wished - kReachSoftM * std::log(pull);
  }

  const body::Body& body_;
  Posture posture_;
  std::array<motion::LegSolver, 2> legs_;
  body::Kinematics at_;
  std::vector<Target> targets_;
  motion::Motion motion_;
  double reach_m_ = 0;
  double foot_error_m_ = 0;
};

/// Solves c - k c'' = p for c, k in frames squared; c'' is 0 at both ends (Thomas' algorithm).
Eigen::Matrix2Xd UnderPressure(const Eigen::Matrix2Xd& p, const Eigen::VectorXd& k) {
  const Eigen::Index n = p.cols();
  Eigen::VectorXd upper = Eigen::VectorXd::Zero(n);
  Eigen::Matrix2Xd c = p;
  for (Eigen::Index i = 1; i < n; ++i) {
    const bool end = i == n - 1;
    const double lower = end ? 0 : -k(i);
    const double pivot = (end ? 1 : 1 + 2 * k(i)) - lower * upper(i - 1);
    upper(i) = end ? 0 : -k(i) / pivot;
    c.col(i) = (p.col(i) - lower * c.col(i - 1)) / pivot;
  }
  for (Eigen::Index i = n - 2; i >= 0; --i) c.col(i) -= upper(i) * c.col(i + 1);
  return c;
}

}  // namespace

Result<body::Body> Performer(double height_m, double mass_kg) {
  body::PersonParameters person;
  person.mass_kg = mass_kg;
  person.height_m = height_m;
  return body::MakeBody(body::StandardPerson(height_m), person);
}

Performance Perform(const Script& script, const body::Body& body, double rate_hz,
                    const std::function<void(double done)>& progress) {
  Dancer dancer(script, body, rate_hz);
  const Eigen::Matrix2Xd wished = dancer.WishedPressure();
  Performance out;
  Eigen::VectorXd k = Eigen::VectorXd::Constant(
      wished.cols(), 0.55 * body.height_m / kStandardGravityMps2 * rate_hz * rate_hz);
  Eigen::Matrix2Xd com = UnderPressure(wished, k);
  for (int round = 0; round < kRounds; ++round) {
    dancer.Move(com);
    const virtual_sensors::BodyCourse course = virtual_sensors::Follow(body, dancer.motion());
    const virtual_sensors::GroundReaction reaction = virtual_sensors::React(course);
    const Eigen::Matrix2Xd left = wished - reaction.cop_m;
    out.pressure_error_m = std::sqrt(left.squaredNorm() / static_cast<double>(left.cols()));
    for (Eigen::Index i = 0; i < k.size(); ++i) {
      const double force_n =
          std::max(reaction.force_n(2, i), 0.3 * body.mass_kg * kStandardGravityMps2);
      k(i) = course.com_m(2, i) * body.mass_kg / force_n * rate_hz * rate_hz;
    }
    if (round + 1 < kRounds) com += UnderPressure(left, k);
    if (progress) progress(static_cast<double>(round + 1) / kRounds);
  }
  out.motion = dancer.motion();
  out.foot_error_m = dancer.foot_error_m();
  return out;
}

namespace {

using body::Axis;
using body::AxisRotation;
using body::Landmark;

// Shares of a movement of the trunk that the hips make; the rest is the back's.
constexpr double kHipsBow = 0.45, kHipsTwist = 0.35, kHipsBend = 0.2;
constexpr double kToesDownRadPerM = 1.2;  // Pitch of a lifted foot over its height.
// From where a standing foot carries to as far as a leaning body goes, m: well inside the sole.
constexpr double kToFrontM = 0.08, kToHeelM = 0.055;

Eigen::Matrix3d Turned(double forward_rad, double left_rad, double about_rad) {
  return AxisRotation(Axis::kZ, about_rad) * AxisRotation(Axis::kY, forward_rad) *
         AxisRotation(Axis::kX, -left_rad);
}

}  // namespace

Posture::Posture(const body::Body& body)
    : body_(body), t_pose_(body::TPose(body.skeleton, body.landmarks)) {
  const auto joint = [&body](const char* name) {
    const int index = body::FindJoint(body.skeleton, name);
    FOOTING_CHECK(index >= 0);
    return index;
  };
  back_ = {joint("lowerback"), joint("upperback"), joint("thorax")};
  neck_ = {joint("lowerneck"), joint("upperneck"), joint("head")};
  motion::Motion still;
  still.skeleton = body.skeleton;
  still.rate_hz = 100;
  still.q = t_pose_.replicate(1, 2);
  const auto course = virtual_sensors::Follow(body, still);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, t_pose_, at);
  const double share = virtual_sensors::SceneOptions{}.rest_share;
  double middle_x = 0;
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const auto ankle = static_cast<std::size_t>(
        body.landmarks[foot == 0 ? Landmark::kLeftAnkle : Landmark::kRightAnkle]);
    const auto& sole = course.sole_m[foot];
    const Eigen::Vector3d heel = 0.5 * (sole[0].col(0) + sole[1].col(0));
    const Eigen::Vector3d ball = 0.5 * (sole[2].col(0) + sole[3].col(0));
    standing_[foot] = {at.p_WJ[ankle], at.R_WJ[ankle]};
    rest_[foot] = ((1 - share) * heel + share * ball - at.p_WJ[ankle]).head<2>();
    middle_x += 0.25 * (heel.x() + ball.x());
  }
  t_pose_(0) -= middle_x;
  for (motion::FootPlace& place : standing_) place.p_WA.x() -= middle_x;
}

void Posture::Turn(int joint, const Eigen::Matrix3d& R_PJ, Eigen::Ref<Eigen::VectorXd> q) const {
  body::SetJointRotation(body_.skeleton.joint(joint), R_PJ, q);
}

void Posture::PlaceArm(const Values& values, bool left, Eigen::Ref<Eigen::VectorXd> q) const {
  const auto of = [&](Channel l, Channel r) { return At(values, left ? l : r); };
  const double side = left ? 1 : -1;
  const double raise = of(Channel::kLeftRaise, Channel::kRightRaise);
  const double front = of(Channel::kLeftFront, Channel::kRightFront);
  const double roll = of(Channel::kLeftRoll, Channel::kRightRoll);
  const int shoulder = body_.landmarks[left ? Landmark::kLeftShoulder : Landmark::kRightShoulder];
  const int elbow = body_.landmarks[left ? Landmark::kLeftElbow : Landmark::kRightElbow];
  Turn(shoulder,
       AxisRotation(Axis::kZ, -side * front) * AxisRotation(Axis::kX, side * raise) *
           AxisRotation(Axis::kY, -roll),
       q);
  q(body_.skeleton.joint(elbow).first_dof) = of(Channel::kLeftElbow, Channel::kRightElbow);
}

void Posture::PlaceUpperBody(const Values& values, Eigen::Ref<Eigen::VectorXd> q) const {
  const double bow = At(values, Channel::kBow), bend = At(values, Channel::kBend),
               twist = At(values, Channel::kTwist);
  Turn(0, Turned(kHipsBow * bow, kHipsBend * bend, kHipsTwist * twist), q);
  for (const int joint : back_)
    Turn(joint,
         Turned((1 - kHipsBow) * bow / 3, (1 - kHipsBend) * bend / 3, (1 - kHipsTwist) * twist / 3),
         q);
  for (const int joint : neck_)
    Turn(joint, Turned(At(values, Channel::kNod) / 3, 0, At(values, Channel::kLook) / 3), q);
  PlaceArm(values, true, q);
  PlaceArm(values, false, q);
}

motion::FootPlace Posture::FootOf(const Values& values, int foot) const {
  const bool left = foot == 0;
  const auto of = [&](Channel l, Channel r) { return At(values, left ? l : r); };
  motion::FootPlace place = standing_[static_cast<std::size_t>(foot)];
  const double lift = of(Channel::kLeftLift, Channel::kRightLift);
  place.p_WA += Eigen::Vector3d(of(Channel::kLeftStep, Channel::kRightStep),
                                (left ? 1 : -1) * of(Channel::kLeftOut, Channel::kRightOut), lift);
  place.R_WA = AxisRotation(Axis::kY, kToesDownRadPerM * lift) * place.R_WA;
  return place;
}

Eigen::Vector2d Posture::RestOf(const Values& values, int foot) const {
  return FootOf(values, foot).p_WA.head<2>() + rest_[static_cast<std::size_t>(foot)];
}

Eigen::Vector2d Posture::PressureOf(const Values& values) const {
  const double left = 0.5 * (1 + At(values, Channel::kWeight));
  Eigen::Vector2d place = left * RestOf(values, 0) + (1 - left) * RestOf(values, 1);
  const double ahead = At(values, Channel::kAhead);
  place.x() += ahead * (ahead > 0 ? kToFrontM : kToHeelM);
  return place;
}

}  // namespace footing::choreography

#include "common/virtual/people/perform.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/base/units.h"
#include "common/virtual/people/course.h"
#include "common/virtual/people/posture.h"
#include "common/virtual/devices/ground_reaction.h"

namespace footing::choreography {
namespace {

constexpr int kRounds = 3;
constexpr int kCentrings = 3;          // Of the root, a frame and round.
constexpr double kKneeBentRad = 0.14;  // At least; a straight knee is stiff.
constexpr double kFirstKneeRad = 0.3;
constexpr double kReachSoftM = 0.004;  // How softly the longer leg pulls the hips down.
constexpr double kSwayFadeS = 2;

/// What a script asks of each frame.
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

}  // namespace footing::choreography

#include "daemon/simulation/momentum/horizontal_com.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/base/units.h"

namespace footing::momentum {
namespace {

using Filter = HorizontalCom::Filter;
using Matrix3 = Eigen::Matrix3d;

// Below these shares of the weight there is no centre of pressure to speak of, and no shear force.
constexpr double kLeastLoadShare = 0.3;
constexpr double kFlightShare = 0.05;
constexpr double kFlightAcceleration = 0.3;  // m/s², standard deviation around 0.
constexpr double kLeastRatio = 2.0;          // 1/s², of load / mass / height.
constexpr double kLandsBesideM = 0.15;       // The body from the COP, when feet come down.
constexpr double kLeastHeight = 0.4;         // m
// A body surprises at once, and is in place again only some time after. One COP alone counts for no
// more than this, and those of an impact say nothing of where a body goes that has just landed.
constexpr double kSurpriseTimeS = 0.2, kCalmTimeS = 1, kMostSurprise = 100, kImpactS = 0.3;

Matrix3 Companion(const HorizontalPrior::Part& part) {
  const double p = part.pole_radps, w = part.frequency_radps, zeta = part.damping;
  Matrix3 a = Matrix3::Zero();
  a(0, 1) = a(1, 2) = 1;
  a.row(2) << -p * w * w, -(2 * zeta * w * p + w * w), -(p + 2 * zeta * w);
  return a;
}

// P of A P + P A' + b b' = 0, as 9 linear equations.
Matrix3 Stationary(const Matrix3& a) {
  Eigen::Matrix<double, 9, 9> system = Eigen::Matrix<double, 9, 9>::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        system(3 * i + j, 3 * k + j) += a(i, k);
        system(3 * i + j, 3 * i + k) += a(j, k);
      }
  Eigen::Matrix<double, 9, 1> right = Eigen::Matrix<double, 9, 1>::Zero();
  right(8) = -1;
  const Eigen::Matrix<double, 9, 1> p = system.partialPivLu().solve(right);
  return Eigen::Map<const Matrix3>(p.data());
}

// exp(a h) by scaling and a Taylor series.
Matrix3 Exponential(const Matrix3& a, double h) {
  constexpr int kHalvings = 6;
  const Matrix3 x = a * (h / (1 << kHalvings));
  Matrix3 term = Matrix3::Identity(), sum = term;
  for (int i = 1; i < 10; ++i) {
    term = (term * x / i).eval();
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = (sum * sum).eval();
  return sum;
}

}  // namespace

HorizontalCom::HorizontalCom(const HorizontalPrior& prior, const PostureError& posture,
                             double mass_kg, double step_s)
    : prior_(prior), posture_(posture), mass_kg_(mass_kg), step_s_(step_s) {
  a_.setZero();
  stationary_.setZero();
  int at = 0;
  for (const HorizontalPrior::Part& part : {prior.slow, prior.rhythmic}) {
    const Matrix3 companion = Companion(part);
    Matrix3 p = Stationary(companion);
    p *= part.spread_m * part.spread_m / p(0, 0);
    a_.block<3, 3>(at, at) = Exponential(companion, step_s);
    stationary_.block<3, 3>(at, at) = p;
    at += 3;
  }
  a_(6, 6) = std::exp(-step_s / prior.moment_time_s);
  stationary_(6, 6) = prior.moment_spread_m * prior.moment_spread_m;
  a_(7, 7) = std::exp(-step_s / posture.time_s);
  stationary_(7, 7) = posture.spread_m * posture.spread_m;
  q_ = stationary_ - a_ * stationary_ * a_.transpose();
  position_ << 1, 0, 0, 1, 0, 0, 0, 0;
  velocity_ << 0, 1, 0, 0, 1, 0, 0, 0;
  acceleration_ << 0, 0, 1, 0, 0, 1, 0, 0;
  filter_.Start(Filter::Vector::Zero(), stationary_);
}

void HorizontalCom::Start(double c_m, double centre_m) {
  centre_m_ = centre_m;
  surprise_ = 0;
  filter_.Start(Filter::Vector::Zero(), stationary_);
  filter_.Update(position_, c_m - centre_m, 1e-4);
  filter_.Update(velocity_, 0, 1e-4);
  filter_.Update(acceleration_, 0, 1e-2);
  filter_.Remember(position_, centre_m_);
}

void HorizontalCom::Land(double cop_m, double centre_m) {
  centre_m_ = centre_m;
  surprise_ = landed_s_ = 0;
  filter_.Start(Filter::Vector::Zero(), stationary_);
  filter_.Update(position_, cop_m - centre_m, kLandsBesideM * kLandsBesideM);
  filter_.Remember(position_, centre_m_);
}

void HorizontalCom::Advance(const HorizontalInput& input) {
  const double weight_n = mass_kg_ * kStandardGravityMps2;
  Filter::Vector shift = Filter::Vector::Zero();
  shift(0) = centre_m_ - input.centre_m;  // c stays where it is when the centre moves.
  centre_m_ = input.centre_m;
  filter_.Predict(a_, shift, q_);
  landed_s_ += step_s_;
  if (input.cop_valid && input.load_n > kLeastLoadShare * weight_n) {
    const double height = std::max(input.com_height_m, kLeastHeight);
    const double ratio = std::max(input.load_n / mass_kg_ / height, kLeastRatio);
    Filter::Row h = position_ - prior_.beta / ratio * acceleration_;
    h(6) = weight_n / input.load_n;  // e is a moment: its arm grows as the load falls.
    const double noise = prior_.cop_noise_m * weight_n / input.load_n;
    Surprise(filter_.Update(h, input.cop_m - centre_m_, noise * noise));
  } else if (input.load_n < kFlightShare * weight_n) {
    filter_.Update(acceleration_, 0, kFlightAcceleration * kFlightAcceleration);
  }
  filter_.Remember(position_, centre_m_);
}

void HorizontalCom::Surprise(double innovation) {
  if (landed_s_ < kImpactS) return;
  const double more = std::min(innovation, kMostSurprise) - surprise_;
  surprise_ += step_s_ / ((more > 0 ? kSurpriseTimeS : kCalmTimeS) + step_s_) * more;
}

void HorizontalCom::SeePosture(double c_m) {
  if (posture_.spread_m <= 0) return;
  Filter::Row h = posture_.share * position_;
  h(7) = 1;
  filter_.Update(h, c_m - centre_m_, posture_.white_m * posture_.white_m);
}

Filter::Scalar HorizontalCom::Position(int lag_steps) const {
  Filter::Scalar position = filter_.Delayed(lag_steps);
  position.variance *= prior_.spread_factor * prior_.spread_factor;
  return position;
}

std::vector<Filter::Scalar> SmoothHorizontal(const HorizontalPrior& prior, double mass_kg,
                                             double step_s, double start_m,
                                             const std::vector<HorizontalInput>& inputs) {
  if (inputs.empty()) return {};
  struct Step {
    Filter::Vector x;
    Filter::Matrix p;
    double centre_m;
  };
  HorizontalCom com(prior, {}, mass_kg, step_s);
  com.Start(start_m, inputs.front().centre_m);
  std::vector<Step> steps;
  steps.reserve(inputs.size());
  for (const HorizontalInput& input : inputs) {
    com.Advance(input);
    steps.push_back({com.filter().x(), com.filter().p(), com.centre_m()});
  }
  const Filter::Matrix& a = com.transition();
  const Filter::Row& row = com.position_row();
  std::vector<Filter::Scalar> out(steps.size());
  Filter::Vector x = steps.back().x;
  Filter::Matrix p = steps.back().p;
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (i + 1 < steps.size()) {
      Filter::Vector ahead = a * steps[i].x;
      ahead(0) += steps[i].centre_m - steps[i + 1].centre_m;
      const Filter::Matrix p_ahead = a * steps[i].p * a.transpose() + com.noise();
      const Filter::Matrix gain = p_ahead.partialPivLu().solve(a * steps[i].p).transpose();
      x = steps[i].x + gain * (x - ahead);
      p = steps[i].p + gain * (p - p_ahead) * gain.transpose();
    }
    out[i] = {row * x + steps[i].centre_m, std::max(0.0, (row * p * row.transpose())(0))};
  }
  return out;
}

namespace {

// 1 is what a filter expects of its innovations; C is off by so much per root of what is beyond.
constexpr double kUsualSurprise = 1, kSurpriseM = 0.11;
// A body that travels goes further, slowly and in its rhythm.
constexpr double kSlowFactor = 30, kRhythmicFactor = 3;

}  // namespace

HorizontalPrior Travelling(HorizontalPrior in_place) {
  in_place.slow.spread_m *= kSlowFactor;
  in_place.rhythmic.spread_m *= kRhythmicFactor;
  in_place.spread_factor = 1;
  return in_place;
}

PostureError TravellingPosture() { return {1, 0.10, 1, 0.01}; }

double DoubtOf(const HorizontalCom& in_place, double stepped_m) {
  const double beyond = std::max(in_place.surprise() - kUsualSurprise, 0.0);
  return beyond * kSurpriseM * kSurpriseM + stepped_m * stepped_m;
}

HorizontalCom::Filter::Scalar Weigh(const HorizontalCom::Filter::Scalar& in_place, double doubt_m2,
                                    const HorizontalCom::Filter::Scalar& travelling) {
  const double apart_m = travelling.mean - in_place.mean;
  const double gain = doubt_m2 / (doubt_m2 + travelling.variance);
  return {in_place.mean + gain * apart_m, (1 - gain) * (1 - gain) * (in_place.variance + doubt_m2) +
                                              gain * gain * travelling.variance};
}

}  // namespace footing::momentum

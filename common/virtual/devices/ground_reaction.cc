#include "common/virtual/devices/ground_reaction.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/motion/signal.h"
#include "common/virtual/devices/derivative.h"

namespace footing::virtual_sensors {
namespace {

constexpr double kFlightShare = 0.06;  // Of the weight.
constexpr double kReluctanceM = 0.025;
constexpr double kMomentScaleM = 0.3;  // Makes the COP's rows as large as the total's.
constexpr double kEquality = 30;       // Weight of total and COP against evenness.
constexpr int kForces = kFeet * kFootPoints;
constexpr int kEquations = 3 + kForces;

using Forces = Eigen::Matrix<double, kForces, 1>;

// min |a x - b| with x >= 0: Lawson & Hanson 1974, chapter 23.
Forces SolveNonNegative(const Eigen::Matrix<double, kEquations, kForces>& a,
                        const Eigen::Matrix<double, kEquations, 1>& b) {
  Forces x = Forces::Zero();
  std::array<bool, kForces> free{};
  for (int round = 0; round < 4 * kForces; ++round) {
    const Forces gradient = a.transpose() * (b - a * x);
    int best = -1;
    for (int i = 0; i < kForces; ++i)
      if (!free[static_cast<std::size_t>(i)] && gradient(i) > 1e-10 &&
          (best < 0 || gradient(i) > gradient(best)))
        best = i;
    if (best < 0) break;
    free[static_cast<std::size_t>(best)] = true;
    for (int inner = 0; inner < kForces; ++inner) {
      Eigen::Matrix<double, kEquations, kForces> part = a;
      for (int i = 0; i < kForces; ++i)
        if (!free[static_cast<std::size_t>(i)]) part.col(i).setZero();
      Forces s = part.completeOrthogonalDecomposition().solve(b);
      double step = 1;
      for (int i = 0; i < kForces; ++i)
        if (free[static_cast<std::size_t>(i)] && s(i) <= 0)
          step = std::min(step, x(i) / std::max(x(i) - s(i), 1e-300));
      x += step * (s - x);
      if (step >= 1) break;
      for (int i = 0; i < kForces; ++i)
        if (free[static_cast<std::size_t>(i)] && x(i) <= 1e-12) {
          free[static_cast<std::size_t>(i)] = false;
          x(i) = 0;
        }
    }
    x = x.cwiseMax(0);
  }
  return x;
}

}  // namespace

GroundReaction React(const BodyCourse& course, double cutoff_hz) {
  const double rate = course.rate_hz, m = course.mass_kg;
  const Eigen::Index n = course.frames();
  Eigen::MatrixXd both(6, n);
  both.topRows<3>() = Derivative(Derivative(course.com_m, rate), rate);
  both.bottomRows<3>() = Derivative(course.angular_momentum, rate);
  both = motion::LowPass(both, rate, cutoff_hz);
  GroundReaction out;
  out.force_n = m * both.topRows<3>();
  out.force_n.row(2).array() += m * kStandardGravityMps2;
  out.cop_m = course.com_m.topRows<2>();
  out.supported.assign(static_cast<std::size_t>(n), false);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d f = out.force_n.col(i), c = course.com_m.col(i),
                          l = both.col(i).tail<3>();
    if (f.z() < kFlightShare * m * kStandardGravityMps2) continue;
    out.supported[static_cast<std::size_t>(i)] = true;
    // L'_x = (p - c)_y F_z + c_z F_y,  L'_y = -c_z F_x - (p - c)_x F_z, with p_z = 0.
    out.cop_m.col(i) << c.x() - (l.y() + c.z() * f.x()) / f.z(),
        c.y() + (l.x() - c.z() * f.y()) / f.z();
  }
  return out;
}

std::array<FootForce, kFeet> ShareBetweenFeet(const BodyCourse& course,
                                              const GroundReaction& reaction, Eigen::Index frame) {
  std::array<FootForce, kFeet> feet;
  Forces height;
  Eigen::Matrix<double, 2, kForces> place;
  for (int f = 0; f < kFeet; ++f) {
    for (int i = 0; i < kFootPoints; ++i) {
      const Eigen::Vector3d p =
          course.sole_m[static_cast<std::size_t>(f)][static_cast<std::size_t>(i)].col(frame);
      place.col(f * kFootPoints + i) = p.head<2>();
      height(f * kFootPoints + i) = std::max(p.z(), 0.0);
      feet[static_cast<std::size_t>(f)].cop_m += p.head<2>() / kFootPoints;
    }
  }
  const double total = reaction.force_n(2, frame);
  if (!reaction.supported[static_cast<std::size_t>(frame)]) {
    // What is left of the force in flight goes to the lower foot, at its middle.
    const bool right = height.head<kFootPoints>().sum() > height.tail<kFootPoints>().sum();
    feet[right ? 1 : 0].load_n = total;
    return feet;
  }
  // Near the lowest corner heights count as differences: somebody stands on a toe, too.
  const Forces will = (-(height.array() - height.minCoeff()) / kReluctanceM).exp();
  Eigen::Matrix<double, kEquations, kForces> a = Eigen::Matrix<double, kEquations, kForces>::Zero();
  Eigen::Matrix<double, kEquations, 1> b = Eigen::Matrix<double, kEquations, 1>::Zero();
  const Eigen::Vector2d cop = reaction.cop_m.col(frame);
  const Eigen::Vector2d middle = place.rowwise().mean();
  for (int i = 0; i < kForces; ++i) {
    a(0, i) = kEquality * will(i);
    a.block<2, 1>(1, i) = kEquality * will(i) * (place.col(i) - middle) / kMomentScaleM;
    a(3 + i, i) = 1;
  }
  b(0) = kEquality;
  b.segment<2>(1) = kEquality * (cop - middle) / kMomentScaleM;
  Forces x = SolveNonNegative(a, b).cwiseProduct(will);
  if (x.sum() <= 0) x = will;
  x *= total / x.sum();
  for (int f = 0; f < kFeet; ++f) {
    FootForce& foot = feet[static_cast<std::size_t>(f)];
    const auto part = x.segment<kFootPoints>(f * kFootPoints);
    foot.load_n = part.sum();
    if (foot.load_n > 1e-6)
      foot.cop_m = place.middleCols<kFootPoints>(f * kFootPoints) * part / foot.load_n;
  }
  return feet;
}

}  // namespace footing::virtual_sensors

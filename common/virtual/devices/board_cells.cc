#include "common/virtual/devices/board_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <Eigen/QR>

#include "common/base/low_pass.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/edit.h"

namespace footing::virtual_sensors {
namespace {

using body::Landmark;

constexpr double kHeelBehindM = 0.045;  // Distance of the heel behind the ankle.
constexpr double kHeelHalfWidthM = 0.03;
constexpr double kBallHalfWidthM = 0.04;
// Standing height of a corner: lower in few frames only.
constexpr double kLowShare = 0.03;

struct FootJoints {
  int ankle, toe;
};

FootJoints JointsOf(const body::Body& body, int foot) {
  const auto at = [&](Landmark left, Landmark right) {
    return body.landmarks[foot == 0 ? left : right];
  };
  const int ankle = at(Landmark::kLeftAnkle, Landmark::kRightAnkle);
  int toe = at(Landmark::kLeftToeEnd, Landmark::kRightToeEnd);
  if (toe < 0) toe = at(Landmark::kLeftToe, Landmark::kRightToe);
  return {ankle, toe < 0 ? ankle : toe};
}

void PlaceSole(const body::Kinematics& at, const FootJoints& joints, Eigen::Index frame,
               std::array<Eigen::Matrix3Xd, kFootPoints>& sole) {
  const Eigen::Vector3d ankle = at.p_WJ[static_cast<std::size_t>(joints.ankle)];
  const Eigen::Vector3d toe = at.p_WJ[static_cast<std::size_t>(joints.toe)];
  Eigen::Vector3d ahead = toe - ankle;
  ahead.z() = 0;
  ahead = ahead.norm() > 1e-6 ? Eigen::Vector3d(ahead.normalized()) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d side(-ahead.y(), ahead.x(), 0);
  const Eigen::Vector3d heel = ankle - kHeelBehindM * ahead;
  sole[0].col(frame) = heel + kHeelHalfWidthM * side;
  sole[1].col(frame) = heel - kHeelHalfWidthM * side;
  sole[2].col(frame) = toe + kBallHalfWidthM * side;
  sole[3].col(frame) = toe - kBallHalfWidthM * side;
}

}  // namespace

BodyCourse Follow(const body::Body& body, const motion::Motion& motion, double cutoff_hz) {
  BodyCourse course;
  course.rate_hz = motion.rate_hz;
  course.mass_kg = body.mass_kg;
  const Eigen::Index n = motion.frames();
  course.com_m.resize(3, n);
  course.angular_momentum.resize(3, n);
  for (auto& foot : course.sole_m)
    for (auto& point : foot) point.resize(3, n);
  if (n == 0) return course;

  const Eigen::MatrixXd q = motion::Smoothed(motion, cutoff_hz).q;
  const Eigen::MatrixXd q_dot = Derivative(q, motion.rate_hz);
  body::Kinematics at(body.skeleton);
  body::JointVelocities velocities(body.skeleton);
  const std::array<FootJoints, kFeet> feet{JointsOf(body, 0), JointsOf(body, 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    body::ComputeKinematics(body.skeleton, q.col(i), at);
    body::ComputeVelocities(body.skeleton, at, q_dot.col(i), velocities);
    const body::Momentum momentum = body::ComputeMomentum(body, at, velocities);
    course.com_m.col(i) = momentum.p_WC;
    course.angular_momentum.col(i) = momentum.angular_W;
    for (std::size_t f = 0; f < kFeet; ++f) PlaceSole(at, feet[f], i, course.sole_m[f]);
  }
  // Soles are flat on the floor in the T-pose. One that points into the floor in the motion stands
  // there all the same; one that never comes down so far stands where it does.
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  std::array<Eigen::Matrix3Xd, kFootPoints> flat;
  for (auto& point : flat) point.resize(3, 1);
  const double floor_m = motion::FloorHeight(motion, body.landmarks);
  for (std::size_t f = 0; f < kFeet; ++f) {
    PlaceSole(at, feet[f], 0, flat);
    for (std::size_t i = 0; i < kFootPoints; ++i) {
      auto height_m = course.sole_m[f][i].row(2).array();
      const double low_m = text::Quantile({height_m.begin(), height_m.end()}, kLowShare);
      height_m -= std::max(low_m, flat[i](2, 0) + floor_m);
    }
  }
  return course;
}

namespace {

constexpr double kFlightShare = 0.06;  // Largest vertical force in flight, share of the weight.
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
  both = LowPass(both, rate, cutoff_hz);
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
    // The rest of the force in flight goes to the lower foot, at its middle.
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

namespace {

// Chosen on two drop jumps, two walks and a rise from a chair of one person
// (docs/evaluation/momentum.md).
constexpr double kSmoothForceHz = 8;
constexpr double kHardPoseHz = 10, kHardForceHz = 12;
constexpr double kHardShare = 0.05;  // Difference of both forces at an impact, share of the weight.
constexpr double kHardHz = 4;        // Low-pass for the mean square of the difference.

}  // namespace

GroundReaction ReactToImpacts(const body::Body& body, const motion::Motion& motion,
                              const BodyCourse& smooth) {
  GroundReaction out = React(smooth, kSmoothForceHz);
  const GroundReaction hard = React(Follow(body, motion, kHardPoseHz), kHardForceHz);
  const Eigen::MatrixXd apart = hard.force_n - out.force_n;
  const Eigen::MatrixXd square = apart.colwise().squaredNorm();
  const Eigen::MatrixXd energy = LowPass(square, motion.rate_hz, kHardHz);
  const double known_n = kHardShare * smooth.mass_kg * kStandardGravityMps2;
  for (Eigen::Index i = 0; i < smooth.frames(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double here = std::max(energy(0, i), 0.0);
    const double share = here / (here + known_n * known_n);
    out.force_n.col(i) += share * apart.col(i);
    if (hard.supported[at] && out.supported[at]) {
      out.cop_m.col(i) += share * (hard.cop_m.col(i) - out.cop_m.col(i));
    } else if (share > 0.5) {
      out.cop_m.col(i) = hard.cop_m.col(i);
      out.supported[at] = hard.supported[at];
    }
  }
  return out;
}

namespace {

constexpr int kCellRows = 8;
constexpr double kHalfWidthM = 0.03;
constexpr double kInsideM = 0.005;
constexpr int kNewtonSteps = 30;

}  // namespace

SolePlace PlaceOfSole(const BodyCourse& course, std::size_t foot, Eigen::Index frame) {
  const auto& sole = course.sole_m[foot];
  const Eigen::Vector2d heel = 0.5 * (sole[0].col(frame) + sole[1].col(frame)).head<2>();
  const Eigen::Vector2d ball = 0.5 * (sole[2].col(frame) + sole[3].col(frame)).head<2>();
  const Eigen::Vector2d along = ball - heel;
  return {heel, std::atan2(along.y(), along.x()), along.norm()};
}

std::array<Eigen::Vector2d, kInsoleCells> InsolePlaces(double length_m) {
  std::array<Eigen::Vector2d, kInsoleCells> places;
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {length_m * static_cast<double>(i / 2) / (kCellRows - 1),
                 i % 2 == 0 ? kHalfWidthM : -kHalfWidthM};
  return places;
}

std::array<double, kInsoleCells> LoadInsole(
    const std::array<Eigen::Vector2d, kInsoleCells>& places_m, const SolePlace& sole,
    const FootForce& foot) {
  std::array<double, kInsoleCells> loads{};
  if (foot.load_n <= 0) return loads;
  const Eigen::Vector2d off = foot.cop_m - sole.heel_m;
  const double c = std::cos(sole.yaw_rad), s = std::sin(sole.yaw_rad);
  const Eigen::Vector2d cop_F(
      std::clamp(c * off.x() + s * off.y(), kInsideM, places_m.back().x() - kInsideM),
      std::clamp(-s * off.x() + c * off.y(), -kHalfWidthM + kInsideM, kHalfWidthM - kInsideM));
  // Newton on the dual: share_i = exp(k . p_i) / sum, with mean cop_F. The Jacobian of the mean is
  // the covariance of the shares.
  Eigen::Vector2d k = Eigen::Vector2d::Zero();
  std::array<double, kInsoleCells> shares{};
  for (int step = 0; step < kNewtonSteps; ++step) {
    double most = -1e300, sum = 0;
    for (const auto& p : places_m) most = std::max(most, k.dot(p - cop_F));
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < places_m.size(); ++i) {
      const Eigen::Vector2d p = places_m[i] - cop_F;
      shares[i] = std::exp(k.dot(p) - most);
      sum += shares[i];
      mean += shares[i] * p;
      square += shares[i] * p * p.transpose();
    }
    for (double& share : shares) share /= sum;
    mean /= sum;
    if (mean.norm() < 1e-9) break;
    const Eigen::Matrix2d covariance =
        square / sum - mean * mean.transpose() + 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d change = -covariance.inverse() * mean;
    // No step further than the shares change by e^3 over a sole.
    const double longest = 3 / std::max(0.01, places_m.back().x());
    if (change.norm() > longest) change *= longest / change.norm();
    k += change;
  }
  for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = foot.load_n * shares[i];
  return loads;
}

Eigen::MatrixXd Derivative(const Eigen::MatrixXd& values, double rate_hz) {
  const Eigen::Index n = values.cols();
  Eigen::MatrixXd out(values.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index low = std::max<Eigen::Index>(i - 1, 0), high = std::min(i + 1, n - 1);
    out.col(i) = (values.col(high) - values.col(low)) * (rate_hz / static_cast<double>(high - low));
  }
  return out;
}

namespace {

constexpr double kFullLoadN = 370;  // Half a person: the slow error is stated for this load.

// Axes of P in W.
Eigen::Vector2d Front(const BoardPlace& board) {
  return {std::cos(board.yaw_rad), std::sin(board.yaw_rad)};
}
Eigen::Vector2d Right(const BoardPlace& board) {
  return {std::sin(board.yaw_rad), -std::cos(board.yaw_rad)};
}

}  // namespace

std::array<BoardPlace, kFeet> SideBySide() {
  const double middle_m = 0.5 * board::kBalanceBoard.plate_y_m;
  return {BoardPlace{{0, middle_m}, 0.5 * kPi}, BoardPlace{{0, -middle_m}, 0.5 * kPi}};
}

std::array<BoardPlace, kFeet> OneFootEach(double gap_m) {
  const auto poses = board::OneFootEach(gap_m);
  const auto place = [](const stream::BoardPose& pose) {
    return BoardPlace{{pose.x_m, pose.y_m}, pose.yaw_rad};
  };
  return {place(poses[0]), place(poses[1])};
}

std::array<Eigen::Vector2d, board::kCorners> SensorPlaces(const BoardPlace& board) {
  return board::SensorPlaces({board.middle_m.x(), board.middle_m.y(), board.yaw_rad});
}

bool IsBeside(const BoardPlace& board, const FootForce& foot) {
  const Eigen::Vector2d p = foot.cop_m - board.middle_m;
  return std::abs(p.dot(Right(board))) > 0.5 * board::kBalanceBoard.plate_x_m ||
         std::abs(p.dot(Front(board))) > 0.5 * board::kBalanceBoard.plate_y_m;
}

BoardLoad LoadBoard(const BoardPlace& board, const FootForce& foot, bool limited) {
  const Eigen::Vector2d p = foot.cop_m - board.middle_m;
  const double x = p.dot(Right(board)) / (0.5 * board::kBalanceBoard.sensor_distance_x_m);
  const double y = p.dot(Front(board)) / (0.5 * board::kBalanceBoard.sensor_distance_y_m);
  double inside_x = std::clamp(x, -1.0, 1.0), inside_y = std::clamp(y, -1.0, 1.0);
  BoardLoad load;
  load.outside = inside_x != x || inside_y != y;
  if (!limited) {
    inside_x = x;
    inside_y = y;
  }
  for (std::size_t i = 0; i < load.corners_n.size(); ++i) {
    load.corners_n[i] = 0.25 * foot.load_n * (1 + board::kCornerRight[i] * inside_x) *
                        (1 + board::kCornerFront[i] * inside_y);
  }
  return load;
}

CellErrors::CellErrors(const CellErrorConfig& config) : config_(config), random_(config.seed) {
  for (double& gain : gains_) gain = 1 + config.gain_spread * random_.Normal();
  slow_n_ = config.slow_force_n * random_.Normal();
}

Corners CellErrors::Advance(const Corners& true_n, double step_s) {
  const double total = true_n[0] + true_n[1] + true_n[2] + true_n[3];
  const double keep = std::exp(-step_s / config_.slow_time_s);
  slow_n_ = keep * slow_n_ + std::sqrt(1 - keep * keep) * config_.slow_force_n * random_.Normal();
  const double slow = 0.25 * slow_n_ * std::clamp(total / kFullLoadN, 0.0, 1.5);
  Corners read;
  for (std::size_t i = 0; i < read.size(); ++i) {
    // The play operator: the reading follows once the force has crossed the play.
    if (!started_) play_n_[i] = true_n[i];
    play_n_[i] =
        std::clamp(play_n_[i], true_n[i] - config_.hysteresis_n, true_n[i] + config_.hysteresis_n);
    read[i] =
        gains_[i] * play_n_[i] + slow + KilogramsToNewtons(config_.noise_kg) * random_.Normal();
  }
  started_ = true;
  return read;
}

}  // namespace footing::virtual_sensors

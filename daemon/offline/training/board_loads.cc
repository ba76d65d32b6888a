#include "daemon/offline/training/board_loads.h"

#include <algorithm>
#include <cmath>

#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "common/synthetic/random.h"
#include "daemon/offline/training/alignment.h"

namespace footing::training {
namespace {

using body::Landmark;

constexpr double kGravityMps2 = 9.80665;
constexpr double kFlight = 0.06;      // Part of the weight under which the cells share as before.
constexpr double kFootReachM = 0.13;  // From a foot's middle to the end of what it can press on,
constexpr double kFootSideM = 0.05;   // and to its side.
constexpr double kLiftM = 0.025;  // A foot this high carries 1/e of what it would on the ground.

/// Each row smoothed by a Gaussian; the ends repeat.
Eigen::MatrixXd Smoothed(const Eigen::MatrixXd& q, double sd_frames) {
  const auto reach = static_cast<Eigen::Index>(std::ceil(3 * sd_frames));
  Eigen::MatrixXd smooth = Eigen::MatrixXd::Zero(q.rows(), q.cols());
  double total = 0;
  for (Eigen::Index k = -reach; k <= reach; ++k) {
    const double part = static_cast<double>(k) / std::max(sd_frames, 1e-9);
    const double weight = std::exp(-0.5 * part * part);
    total += weight;
    for (Eigen::Index t = 0; t < q.cols(); ++t) {
      smooth.col(t) += weight * q.col(std::clamp<Eigen::Index>(t + k, 0, q.cols() - 1));
    }
  }
  return smooth / total;
}

struct Foot {
  Eigen::Vector2d place_m{0, 0};  ///< Middle of ankle and toe.
  double lift_m = 0;
};

/// One frame of the motion, before it is shared by the cells.
struct Frame {
  Eigen::Vector2d c_m{0, 0}, cop_m{0, 0};
  double weight = 0;         ///< Vertical force over the body's weight.
  std::array<Foot, 2> feet;  ///< Left, right.
};

std::vector<Frame> Dynamics(const motion::Motion& motion, const body::Body& body,
                            double smoothing_s) {
  const body::Skeleton& skeleton = motion.skeleton;
  const Eigen::MatrixXd q = Smoothed(motion.q, smoothing_s * motion.rate_hz);
  body::Kinematics at(skeleton);
  body::JointVelocities velocities(skeleton);
  body::JointAccelerations accelerations(skeleton);
  std::vector<Frame> frames;
  for (Eigen::Index t = 1; t + 1 < q.cols(); ++t) {
    const Eigen::VectorXd q_dot = (q.col(t + 1) - q.col(t - 1)) * (motion.rate_hz / 2);
    const Eigen::VectorXd q_ddot =
        (q.col(t + 1) - 2 * q.col(t) + q.col(t - 1)) * (motion.rate_hz * motion.rate_hz);
    ComputeKinematics(skeleton, q.col(t), at);
    ComputeVelocities(skeleton, at, q_dot, velocities);
    ComputeAccelerations(skeleton, at, q_dot, q_ddot, velocities, accelerations);
    const body::MomentumRate rate = ComputeMomentumRate(body, at, velocities, accelerations);
    const Eigen::Vector3d c_m = CentreOfMass(body, at);
    const double weight_n = body.mass_kg * kGravityMps2;
    const Eigen::Vector3d force_n = rate.linear_W + Eigen::Vector3d(0, 0, weight_n);

    Frame& frame = frames.emplace_back();
    frame.c_m = c_m.head<2>();
    frame.weight = force_n.z() / weight_n;
    // (p - c) x F = dL/dt with p on the floor.
    const double lifting_n = std::max(force_n.z(), kFlight * weight_n);
    frame.cop_m = frame.c_m + Eigen::Vector2d(-rate.angular_W.y() - c_m.z() * force_n.x(),
                                              rate.angular_W.x() - c_m.z() * force_n.y()) /
                                  lifting_n;
    const std::array ankles = {Landmark::kLeftAnkle, Landmark::kRightAnkle};
    const std::array toes = {Landmark::kLeftToe, Landmark::kRightToe};
    for (std::size_t side = 0; side < 2; ++side) {
      const int ankle = body.landmarks[ankles[side]];
      const int toe = body.landmarks[toes[side]] >= 0 ? body.landmarks[toes[side]] : ankle;
      const Eigen::Vector3d middle_m =
          (at.p_WJ[static_cast<std::size_t>(ankle)] + at.p_WJ[static_cast<std::size_t>(toe)]) / 2;
      frame.feet[side] = {.place_m = middle_m.head<2>(), .lift_m = middle_m.z()};
    }
  }
  return frames;
}

/// The left foot's share of the force: by where the COP lies between the feet, less for a foot in
/// the air.
double LeftShare(const Frame& frame, const std::array<double, 2>& standing_m) {
  const Eigen::Vector2d across_m = frame.feet[0].place_m - frame.feet[1].place_m;
  const double part = std::clamp(
      (frame.cop_m - frame.feet[1].place_m).dot(across_m) / std::max(across_m.squaredNorm(), 1e-4),
      0.0, 1.0);
  const auto down = [&](std::size_t side) {
    return std::exp(-std::max(frame.feet[side].lift_m - standing_m[side], 0.0) / kLiftM);
  };
  const double left = part * down(0), right = (1 - part) * down(1);
  return left + right > 1e-6 ? left / (left + right) : part;
}

Eigen::VectorXd Column(const std::vector<Frame>& frames, const auto& value) {
  Eigen::VectorXd column(static_cast<Eigen::Index>(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    column(static_cast<Eigen::Index>(i)) = value(frames[i]);
  }
  return column;
}

LoadFrame Between(const LoadFrame& a, const LoadFrame& b, double part) {
  LoadFrame frame;
  for (std::size_t k = 0; k < kBoardCells; ++k) {
    frame.load[k] = a.load[k] + part * (b.load[k] - a.load[k]);
  }
  frame.c_W_m = a.c_W_m + part * (b.c_W_m - a.c_W_m);
  return frame;
}

}  // namespace

LoadClip BoardLoads(const motion::Motion& motion, const body::Body& body,
                    const BoardLoadSettings& settings, std::uint64_t seed) {
  const std::vector<Frame> frames = Dynamics(motion, body, settings.smoothing_s);
  if (frames.empty()) return {};
  std::array<double, 2> standing_m;
  std::array<Eigen::Vector2d, 2> board_W_m;
  for (std::size_t side = 0; side < 2; ++side) {
    standing_m[side] =
        Quantile(Column(frames, [&](const Frame& f) { return f.feet[side].lift_m; }), 0.03);
    for (int axis = 0; axis < 2; ++axis) {
      board_W_m[side](axis) =
          Quantile(Column(frames, [&](const Frame& f) { return f.feet[side].place_m(axis); }), 0.5);
    }
  }

  LoadClip clip;
  std::array<double, kBoardCells> parts{};  // Of the whole force, a cell each.
  parts.fill(1.0 / kBoardCells);
  for (const Frame& frame : frames) {
    if (frame.weight > kFlight) {
      const double left = LeftShare(frame, standing_m);
      // Both feet's COP is off their middle by what the whole COP is off the middle of their
      // shares, as far as feet reach.
      Eigen::Vector2d off_m =
          frame.cop_m - left * frame.feet[0].place_m - (1 - left) * frame.feet[1].place_m;
      off_m.x() = std::clamp(off_m.x(), -kFootReachM, kFootReachM);
      off_m.y() = std::clamp(off_m.y(), -kFootSideM, kFootSideM);
      for (std::size_t side = 0; side < 2; ++side) {
        ShareOut(side == 0 ? left : 1 - left, frame.feet[side].place_m + off_m - board_W_m[side],
                 parts.data() + 4 * side);
      }
    }
    LoadFrame& out = clip.emplace_back();
    out.c_W_m = frame.c_m;
    for (std::size_t k = 0; k < kBoardCells; ++k) out.load[k] = frame.weight * parts[k];
  }

  synthetic::Random random(seed);
  LoadClip resampled;
  const double step = motion.rate_hz / settings.rate_hz;
  for (double at = 0; at < static_cast<double>(clip.size() - 1); at += step) {
    const auto first = static_cast<std::size_t>(at);
    LoadFrame& frame = resampled.emplace_back(
        Between(clip[first], clip[first + 1], at - static_cast<double>(first)));
    frame.board_W_m = board_W_m;
    for (double& load : frame.load) load += settings.noise_sd * random.Normal();
  }
  return resampled;
}

}  // namespace footing::training

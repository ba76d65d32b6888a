#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "common/clock/clock.h"
#include "common/text/quantile.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/noise/random.h"
#include "common/virtual/sensors/board_cells.h"
#include "common/virtual/sensors/ground_reaction.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/timing/momentum_cost.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::bench {
namespace {

using reconstruction::Features;
using reconstruction::Inputs;

constexpr int kPosePairs = 15;
constexpr double kHeightM = 1.75, kRateHz = 60;
constexpr double kStandS = 6, kMoveS = 20;
constexpr int kWays = 12;      // Independent ways to move,
constexpr double kWay = 0.06;  // and how far, rad.
constexpr int kWaves = 500;    // As many as a trained model has.

/// A T-pose, then all joints move to and fro, each way with its own frequency.
motion::Motion Moving(const body::Body& body) {
  noise::Random random(1);
  Eigen::MatrixXd ways(body.skeleton.dof, kWays);
  for (double& value : ways.reshaped()) value = kWay * random.Normal();
  ways.topRows<3>() *= 0.2;
  motion::Motion motion;
  motion.skeleton = body.skeleton;
  motion.rate_hz = kRateHz;
  motion.q.resize(body.skeleton.dof, static_cast<Eigen::Index>((kStandS + kMoveS) * kRateHz));
  const Eigen::VectorXd t_pose = body::TPose(body.skeleton, body.landmarks);
  for (Eigen::Index i = 0; i < motion.q.cols(); ++i) {
    const double t = std::max(0.0, static_cast<double>(i) / kRateHz - kStandS);
    motion.q.col(i) = t_pose;
    for (int way = 0; way < kWays; ++way) {
      motion.q.col(i) += (1 - std::cos((1 + 0.3 * way) * t)) / 2 * ways.col(way);
    }
  }
  return motion;
}

std::vector<Inputs> Measured(const body::Body& body, const motion::Motion& motion) {
  const virtual_sensors::BodyCourse course = virtual_sensors::Follow(body, motion);
  const virtual_sensors::GroundReaction reaction = virtual_sensors::React(course);
  auto boards = virtual_sensors::SideBySide();
  for (std::size_t f = 0; f < boards.size(); ++f) {
    boards[f].middle_m = course.sole_m[f][0].col(0).head<2>();
  }
  body::Kinematics at(body.skeleton);
  std::vector<Inputs> all(static_cast<std::size_t>(motion.frames()));
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    Inputs& inputs = all[static_cast<std::size_t>(i)];
    inputs.loads.time_s = static_cast<double>(i) / kRateHz;
    const auto feet = virtual_sensors::ShareBetweenFeet(course, reaction, i);
    for (std::size_t f = 0; f < boards.size(); ++f) {
      const auto places = virtual_sensors::SensorPlaces(boards[f]);
      const auto load = virtual_sensors::LoadBoard(boards[f], feet[f]);
      inputs.loads.feet[f].valid = true;
      inputs.loads.feet[f].count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k) {
        inputs.loads.feet[f].cells[k] = {{places[k].x(), places[k].y(), 0}, load.corners_n[k]};
      }
    }
    body::ComputeKinematics(body.skeleton, motion.q.col(i), at);
    for (int side = 0; side < 2; ++side) {
      reconstruction::HandInput& hand = inputs.hands[static_cast<std::size_t>(side)];
      hand.valid = true;
      hand.p_W_m = body::Place(body::Fist(body, side), at);
    }
  }
  return all;
}

/// Of a trained model's sizes; it outputs the T-pose and trembles a little about it.
reconstruction::Models Trained(const body::Body& body, const motion::Motion& motion) {
  const int dof = body.skeleton.dof;
  noise::Random random(2);
  const auto noise = [&](Eigen::Index rows, Eigen::Index columns, double sd) {
    Eigen::MatrixXd m(rows, columns);
    for (double& value : m.reshaped()) value = sd * random.Normal();
    return m;
  };
  reconstruction::Models models;
  models.dofs = body::DofNames(body.skeleton);
  models.origin = "made";
  models.basis = pose::FitBasis(motion.q + noise(dof, motion.q.cols(), 0.02), {});
  models.rest = models.basis;
  const Eigen::VectorXd t_pose = body::TPose(body.skeleton, body.landmarks);
  models.root_height_m = t_pose(2);
  models.regression.mean = Eigen::VectorXd::Zero(Features::kCount);
  models.regression.scale = Eigen::VectorXd::Ones(Features::kCount);
  models.regression.weights = noise(dof, Features::kCount, 1e-3);
  models.regression.offset = t_pose;
  models.regression.offset.head<3>().setZero();
  const Eigen::MatrixXf waves = noise(kWaves, Features::kCount, 0.1).cast<float>();
  models.regression.waves = reconstruction::StripMatrix(waves);
  models.regression.phases = noise(kWaves, 1, 1).cast<float>();
  const Eigen::MatrixXf wave_weights = noise(dof, kWaves, 1e-3).cast<float>();
  models.regression.wave_weights = reconstruction::StripMatrix(wave_weights);
  return models;
}

}  // namespace

Result<Rows> PoseFrame() {
  body::PersonParameters person;
  person.height_m = kHeightM;
  const auto body = body::MakeBody(body::StandardPerson(kHeightM), person);
  if (!body) return body.error();
  const motion::Motion motion = Moving(*body);
  const std::vector<Inputs> all = Measured(*body, motion);
  reconstruction::Options options;
  options.rate_hz = kRateHz;
  auto standing = reconstruction::Reconstruction::Create(*body, Trained(*body, motion), options);
  if (!standing) return standing.error();
  const auto moves_from = static_cast<std::size_t>(kStandS * kRateHz);
  for (std::size_t i = 0; i < moves_from; ++i) standing->Advance(all[i]);
  if (!standing->output().calibrated) return InvalidData("the made T-pose did not stand still");
  const auto frame_us = [&](double quantile) {
    return [&, quantile] {
      reconstruction::Reconstruction moving = *standing;
      std::vector<double> spent_us;
      for (std::size_t i = moves_from; i < all.size(); ++i) {
        const std::int64_t begin_ns = clock::ThreadCpuNs();
        moving.Advance(all[i]);
        spent_us.push_back(static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e3);
      }
      return text::Quantile(std::move(spent_us), quantile);
    };
  };
  const auto unit_us = [&] {
    return timing::MomentumCostUs(*body, motion.q.col(motion.frames() - 1));
  };
  const char* const unit = "us (baseline: forward kinematics, centre of mass and momentum once)";
  return Rows{RunPairs("pose_frame_p50_us", unit, kPosePairs, frame_us(0.5), unit_us),
              RunPairs("pose_frame_p99_us", unit, kPosePairs, frame_us(0.99), unit_us)};
}

}  // namespace footing::bench

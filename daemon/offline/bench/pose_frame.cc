#include <Eigen/Core>
#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/ground_reaction.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/learning/horizontal_com.h"
#include "daemon/offline/compute/momentum_cost.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::bench {
namespace {

using reconstruction::Features;
using reconstruction::Inputs;

constexpr int kPosePairs = 15, kPaperPairs = 5;
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

/// Poses about the T-pose of which as many components hold 99 % of the variance as of recorded
/// ones (docs/models.md): the search of paper mode costs by their number.
pose::PoseBasis FallingBasis(const body::Body& body) {
  constexpr int kHold99Percent = 27, kPoses = 2000;
  const int dof = body.skeleton.dof;
  noise::Random random(3);
  Eigen::MatrixXd directions(dof, dof), poses(dof, kPoses);
  for (double& value : directions.reshaped()) value = random.Normal();
  directions = Eigen::HouseholderQR<Eigen::MatrixXd>(directions).householderQ();
  for (double& value : poses.reshaped()) value = random.Normal();
  // Variances fall evenly by such a factor that the 27 first hold all but 1 %.
  for (int i = 0; i < dof; ++i) poses.row(i) *= 0.3 * std::pow(0.01, 0.5 * i / kHold99Percent);
  pose::BasisOptions options;
  options.translation_weight = 1;
  poses = directions * poses;
  poses.colwise() += body::TPose(body.skeleton, body.landmarks);
  return pose::FitBasis(poses, options);
}

/// The same with the networks of the horizontal COM and without the regression.
reconstruction::Models OfPaper(const body::Body& body, const motion::Motion& motion) {
  reconstruction::Models models = Trained(body, motion);
  models.basis = FallingBasis(body);
  const std::vector<learning::LoadClip> clips{learning::MakeSway({.seconds = 20}, 1)};
  learning::CascadeOptions options;
  options.hidden_max = options.hidden_min = 0;
  const auto network = [&](int axis) {
    const learning::Examples examples = learning::HorizontalExamples(clips, axis);
    return learning::TrainCascade(examples, examples, options, 1).network;
  };
  models.horizontal = {network(0), network(1)};
  return models;
}

/// What a mode's frames cost, once its T-pose is over.
struct Bench {
  body::Body body;
  motion::Motion motion;
  std::vector<Inputs> all;

  static std::size_t MovesFrom() { return static_cast<std::size_t>(kStandS * kRateHz); }

  Result<reconstruction::Reconstruction> Standing(reconstruction::Mode mode,
                                                  const reconstruction::Models& models) const {
    reconstruction::Options options;
    options.rate_hz = kRateHz;
    options.mode = mode;
    auto standing = reconstruction::Reconstruction::Create(body, models, options);
    if (!standing) return standing;
    for (std::size_t i = 0; i < MovesFrom(); ++i) standing->Advance(all[i]);
    if (!standing->output().calibrated) return InvalidData("the made T-pose did not stand still");
    return standing;
  }

  double FrameUs(const reconstruction::Reconstruction& standing, double quantile) const {
    reconstruction::Reconstruction moving = standing;
    std::vector<double> spent_us;
    for (std::size_t i = MovesFrom(); i < all.size(); ++i) {
      const std::int64_t begin_ns = clock::ThreadCpuNs();
      moving.Advance(all[i]);
      spent_us.push_back(static_cast<double>(clock::ThreadCpuNs() - begin_ns) / 1e3);
    }
    return text::Quantile(std::move(spent_us), quantile);
  }

  Rows Measure(const std::string& name, const reconstruction::Reconstruction& standing,
               int pairs) const {
    const auto unit_us = [&] {
      return timing::MomentumCostUs(body, motion.q.col(motion.frames() - 1));
    };
    const char* const unit = "us (baseline: forward kinematics, centre of mass and momentum once)";
    const auto row = [&](const char* ending, double quantile) {
      return RunPairs(
          name + ending, unit, pairs, [&] { return FrameUs(standing, quantile); }, unit_us);
    };
    return {row("_p50_us", 0.5), row("_p99_us", 0.99)};
  }
};

}  // namespace

Result<Rows> PoseFrame() {
  body::PersonParameters person;
  person.height_m = kHeightM;
  auto body = body::MakeBody(body::StandardPerson(kHeightM), person);
  if (!body) return body.error();
  const motion::Motion motion = Moving(*body);
  const Bench bench{*body, motion, Measured(*body, motion)};
  const auto best = bench.Standing(reconstruction::Mode::kBest, Trained(*body, motion));
  if (!best) return best.error();
  const auto paper = bench.Standing(reconstruction::Mode::kPaper, OfPaper(*body, motion));
  if (!paper) return paper.error();
  Rows rows = bench.Measure("pose_frame", *best, kPosePairs);
  const Rows of_paper = bench.Measure("pose_frame_paper", *paper, kPaperPairs);
  rows.insert(rows.end(), of_paper.begin(), of_paper.end());
  return rows;
}

}  // namespace footing::bench

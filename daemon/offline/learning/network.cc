#include "daemon/offline/learning/network.h"

#include <cmath>
#include <optional>
#include <utility>

#include "common/base/result.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/learning/cascade.h"

namespace footing::arm_network {
namespace {

constexpr double kTrainShare = 0.8;
constexpr double kBentRad = 0.4;  // Less shows no axis.
constexpr double kPieceS = 2;     // For which the network is left alone, or taught.

Eigen::Vector3d ElbowAxis(const std::vector<Sequence>& sequences) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sequence& sequence : sequences) {
    for (std::size_t i = 0; i < sequence.truth.size(); ++i) {
      const ArmPose& pose = sequence.truth[i];
      if (pose.elbow_rad < kBentRad) continue;
      const Eigen::Vector3d forearm_U = pose.R_WU.transpose() * sequence.forearm[i];
      sum += Eigen::Vector3d::UnitY().cross(forearm_U).normalized();
    }
  }
  FOOTING_CHECK(sum.norm() > 0);
  return sum.normalized();
}

ArmPose Disturbed(const ArmPose& pose, const Eigen::Vector4d& by) {
  return Applied(Kind::kResidual, pose, by);
}

class Rows {
 public:
  void Add(const Eigen::VectorXd& inputs, const Eigen::Vector4d& target) {
    inputs_.push_back(inputs);
    targets_.push_back(target);
  }
  learning::Examples Take() const {
    const auto count = static_cast<Eigen::Index>(inputs_.size());
    learning::Examples all{.inputs = Eigen::MatrixXd(count, inputs_.front().size()),
                           .targets = Eigen::MatrixXd(count, static_cast<Eigen::Index>(kOutputs))};
    for (Eigen::Index i = 0; i < count; ++i) {
      all.inputs.row(i) = inputs_[static_cast<std::size_t>(i)].transpose();
      all.targets.row(i) = targets_[static_cast<std::size_t>(i)].transpose();
    }
    return all;
  }
  std::size_t size() const { return inputs_.size(); }

 private:
  std::vector<Eigen::VectorXd> inputs_;
  std::vector<Eigen::Vector4d> targets_;
};

/// One pass over a sequence: the rows of what the network would receive. `taught`: probability
/// that a piece begins at the true pose and stays there.
class Pass {
 public:
  Pass(Kind kind, const Eigen::Vector3d& axis, int every, double noise_rad, double taught,
       const std::optional<ArmNetwork>& network, noise::Random& random)
      : kind_(kind),
        axis_(axis),
        every_(every),
        noise_rad_(noise_rad),
        taught_(taught),
        network_(network),
        random_(random) {}

  void Run(const Sequence& sequence, Rows& train, Rows& validation) {
    const auto piece = static_cast<std::size_t>(std::lround(kPieceS / sequence.step_s));
    const auto trains =
        static_cast<std::size_t>(kTrainShare * static_cast<double>(sequence.truth.size()));
    ArmPose own = sequence.truth.front();
    bool taught = true;
    Eigen::Vector4d noise = Eigen::Vector4d::Zero();
    for (std::size_t i = 1; i < sequence.truth.size(); ++i) {
      if (i % piece == 1) {
        taught = !network_ || random_.Uniform(0, 1) < taught_;
        for (double& value : noise) value = noise_rad_ * random_.Normal();
      }
      const FrameInput& frame = sequence.inputs[i];
      const ArmPose last = taught ? Disturbed(sequence.truth[i - 1], noise) : own;
      if (i % static_cast<std::size_t>(every_) == 0) {
        const ArmPose from =
            kind_ == Kind::kResidual
                ? Predicted(last, axis_, frame.angular_velocity_W_radps, sequence.step_s)
                : last;
        (i < trains ? train : validation)
            .Add(NetworkInputs(kind_, from, axis_, frame),
                 NetworkTarget(kind_, from, sequence.truth[i]));
      }
      if (network_) own = network_->Next(last, frame, sequence.step_s);
    }
  }

 private:
  Kind kind_;
  Eigen::Vector3d axis_;
  int every_;
  double noise_rad_;
  double taught_;
  const std::optional<ArmNetwork>& network_;
  noise::Random& random_;
};

/// RMS of the three directions' errors on the last fifths, the network left alone from the start.
double ClosedLoopError(const ArmNetwork& network, const std::vector<Sequence>& sequences) {
  double squares = 0;
  std::size_t count = 0;
  for (const Sequence& sequence : sequences) {
    const auto trains =
        static_cast<std::size_t>(kTrainShare * static_cast<double>(sequence.truth.size()));
    ArmPose pose = sequence.truth.front();
    for (std::size_t i = 1; i < sequence.truth.size(); ++i) {
      pose = network.Next(pose, sequence.inputs[i], sequence.step_s);
      if (i < trains) continue;
      const auto estimate = ToDirections(pose, network.elbow_axis_U);
      const auto truth = ToDirections(sequence.truth[i], network.elbow_axis_U);
      squares += (estimate.upper - truth.upper).squaredNorm() +
                 (estimate.hinge - truth.hinge).squaredNorm() +
                 (estimate.forearm - truth.forearm).squaredNorm();
      ++count;
    }
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
}

}  // namespace

TrainingOptions PaperOptions() {
  TrainingOptions options;
  options.rounds = 4;
  options.noises_rad = {0.1, 0.3};
  options.hidden_min = {0, 8};
  options.hidden_max = 12;
  return options;
}

namespace {

/// The rounds with one noise and one least number of hidden units: the best in closed loop.
Trained TrainRounds(Kind kind, const std::vector<Sequence>& sequences,
                    const TrainingOptions& options, double noise_rad, int hidden_min,
                    std::uint64_t seed) {
  const Eigen::Vector3d axis = ElbowAxis(sequences);
  noise::Random random(seed);
  Rows train, validation;
  std::optional<ArmNetwork> network;
  std::optional<Trained> best;
  learning::CascadeOptions cascade_options;
  cascade_options.hidden_min = hidden_min;
  cascade_options.hidden_max = options.hidden_max;
  for (int round = 0; round < options.rounds; ++round) {
    const double taught = options.rounds > 1 ? 1 - round / (options.rounds - 1.0) : 1;
    Pass pass(kind, axis, options.every, noise_rad, taught, network, random);
    for (const Sequence& sequence : sequences) pass.Run(sequence, train, validation);
    auto result = learning::TrainCascade(train.Take(), validation.Take(), cascade_options, seed);
    network = ArmNetwork{kind, axis, result.network};
    Trained trained{
        *network,    result.hidden_units, round, noise_rad, ClosedLoopError(*network, sequences),
        train.size()};
    if (!best || trained.closed_loop < best->closed_loop) best = std::move(trained);
  }
  return *best;
}

}  // namespace

Trained Train(Kind kind, const std::vector<Sequence>& sequences, const TrainingOptions& options,
              std::uint64_t seed) {
  FOOTING_CHECK(!sequences.empty() && options.rounds >= 1);
  FOOTING_CHECK(!options.noises_rad.empty() && !options.hidden_min.empty());
  std::optional<Trained> best;
  for (const double noise_rad : options.noises_rad) {
    for (const int hidden_min : options.hidden_min) {
      auto trained = TrainRounds(kind, sequences, options, noise_rad, hidden_min, seed);
      if (!best || trained.closed_loop < best->closed_loop) best = std::move(trained);
    }
  }
  return *best;
}

}  // namespace footing::arm_network

#include "common/runtime/clock.h"
#include "common/base/units.h"
#include "daemon/offline/bench/fann_network.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/row.h"
#include "daemon/offline/eval/spirals_trials.h"
#include "daemon/offline/learning/spirals.h"

namespace footing::bench {
namespace {

constexpr int kPairs = 31;  // FANN draws its weights unseeded: its times vary by a factor of 3.
constexpr int kRuns = kPairs + 1;  // The first of each warms up.
constexpr int kDenser = 4;
constexpr unsigned kMostHidden = 40;
constexpr float kGoal = 0.0005f;  // Mean squared error of targets of +-1: every point is right.

struct SpiralTraining {
  double seconds = 0;
  double wrong = 0;  ///< Part of spirals four times as dense.
};

/// Cascade2 of FANN as it comes, with an output that reaches the targets.
SpiralTraining Fann() {
  const learning::Examples spirals = learning::TwoSpirals();
  const FannData train = ToFann(spirals.inputs, 2 * spirals.targets);
  const FannNetwork network(fann_create_shortcut(2, 2, 1), &fann_destroy);
  fann_set_activation_function_output(network.get(), FANN_SIGMOID_SYMMETRIC);
  fann_set_training_algorithm(network.get(), FANN_TRAIN_RPROP);
  const std::int64_t start_ns = clock::ThreadCpuNs();
  fann_cascadetrain_on_data(network.get(), train.get(), kMostHidden, 0, kGoal);
  SpiralTraining result{.seconds = NanosecondsToSeconds(clock::ThreadCpuNs() - start_ns)};

  const learning::Examples dense = learning::TwoSpirals(kDenser);
  const FannData between = ToFann(dense.inputs, dense.targets);
  for (Eigen::Index row = 0; row < dense.rows(); ++row) {
    const float output = *fann_run(network.get(), between->input[row]);
    result.wrong += output * *between->output[row] > 0 ? 0 : 1;
  }
  result.wrong /= static_cast<double>(dense.rows());
  return result;
}

}  // namespace

Result<Rows> SpiralsTraining() {
  std::uint64_t seed = 0;
  double wrong = 0, baseline_wrong = 0;
  const auto ours = [&] {
    const eval::SpiralTrial trial = eval::RunSpiralTrial(eval::SpiralOptions(), ++seed);
    wrong += trial.wrong_between / kRuns;
    return trial.seconds;
  };
  const auto baseline = [&] {
    const SpiralTraining fann = Fann();
    baseline_wrong += fann.wrong / kRuns;
    return fann.seconds;
  };
  const Row cost = RunPairs("spirals_training", "s", kPairs, ours, baseline);
  return Rows{cost, {"spirals_error", wrong, baseline_wrong, wrong / baseline_wrong, ""}};
}

}  // namespace footing::bench

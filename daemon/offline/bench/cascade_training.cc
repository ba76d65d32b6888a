#include <cmath>

#include "common/runtime/clock.h"
#include "common/base/units.h"
#include "daemon/offline/bench/fann_network.h"
#include "daemon/offline/bench/row.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/learning/horizontal_com.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/learning/scaling.h"

namespace footing::bench {
namespace {

using learning::Examples;

constexpr int kAxes = 2;
constexpr int kHidden = 20;       // Of FANN's network, and at most of ours.
constexpr double kNoiseM = 0.01;  // On the fed-back COM, without which the closed loop diverges.

/// One axis: 84 s at 60 Hz to train on, as much to choose by, as much to test with.
struct Axis {
  Examples train, validation, fresh;
};

Axis MakeAxis(int axis) {
  const learning::FeedbackNoise noise{.groups = learning::FeedbackColumns(),
                                      .common_sd = kNoiseM,
                                      .own_sd = kNoiseM / 10,
                                      .copies = 1};
  const auto examples = [&](std::uint64_t seed) {
    const learning::LoadClip clip = learning::MakeSway({}, seed);
    return learning::WithFeedbackNoise(learning::HorizontalExamples({&clip, 1}, axis), noise, seed);
  };
  return {.train = examples(1), .validation = examples(2), .fresh = examples(3)};
}

/// CPU seconds, and the mean squared error on the fresh rows.
struct TrainingCost {
  double seconds = 0;
  double mse = 0;
};

double SecondsSince(std::int64_t start_ns) {
  return NanosecondsToSeconds(clock::ThreadCpuNs() - start_ns);
}

TrainingCost Ours(const Axis& axis, int patience, double* validation_mse) {
  learning::CascadeOptions options;
  options.hidden_max = kHidden;
  options.patience = patience;
  const std::int64_t start_ns = clock::ThreadCpuNs();
  const auto result = learning::TrainCascade(axis.train, axis.validation, options, 1);
  *validation_mse = result.validation_mse;
  return {SecondsSince(start_ns), MeanSquaredError(result.network, axis.fresh)};
}

/// Back-propagation until its error of validation equals the cascade's; at most 1000 epochs.
TrainingCost Perceptron(const Axis& axis, double validation_mse) {
  learning::MlpOptions options;
  options.hidden = kHidden;
  options.epochs_max = options.patience = 1000;
  options.mse_goal = validation_mse;
  const std::int64_t start_ns = clock::ThreadCpuNs();
  const auto result = learning::TrainMlp(axis.train, axis.validation, options, 1);
  return {SecondsSince(start_ns), MeanSquaredError(result.network, axis.fresh)};
}

/// FANN's Cascade2 as it comes, with linear outputs, on inputs and targets scaled as ours are.
TrainingCost Fann(const Axis& axis) {
  const auto in = learning::Scaling::Of(axis.train.inputs);
  const auto out = learning::Scaling::Of(axis.train.targets);
  const FannData train = ToFann(in.Apply(axis.train.inputs), out.Apply(axis.train.targets));
  const FannNetwork network(
      fann_create_shortcut(2, static_cast<unsigned>(axis.train.inputs.cols()), 1), &fann_destroy);
  fann_set_activation_function_hidden(network.get(), FANN_SIGMOID_SYMMETRIC);
  fann_set_activation_function_output(network.get(), FANN_LINEAR);
  fann_set_train_error_function(network.get(), FANN_ERRORFUNC_LINEAR);
  fann_set_training_algorithm(network.get(), FANN_TRAIN_RPROP);
  const std::int64_t start_ns = clock::ThreadCpuNs();
  fann_cascadetrain_on_data(network.get(), train.get(), kHidden, 0, 1e-7f);
  TrainingCost measured{SecondsSince(start_ns), 0};

  const FannData fresh = ToFann(in.Apply(axis.fresh.inputs), out.Apply(axis.fresh.targets));
  for (Eigen::Index row = 0; row < axis.fresh.rows(); ++row) {
    const double error = *fann_run(network.get(), fresh->input[row]) - *fresh->output[row];
    measured.mse += error * error / (out.scale(0) * out.scale(0));
  }
  measured.mse /= static_cast<double>(axis.fresh.rows());
  return measured;
}

Row MakeRow(const std::string& name, double ours, double baseline, const std::string& unit) {
  return {.name = name, .ours = ours, .baseline = baseline, .ratio = ours / baseline, .unit = unit};
}

double Rms(double mse_sum_m2) { return 1e3 * std::sqrt(mse_sum_m2 / kAxes); }

}  // namespace

Result<Rows> CascadeTraining() {
  TrainingCost ours, all_units, perceptron, baseline;
  const auto add = [](TrainingCost& sum, const TrainingCost& one) {
    sum.seconds += one.seconds;
    sum.mse += one.mse;
  };
  for (int axis = 0; axis < kAxes; ++axis) {
    const Axis data = MakeAxis(axis);
    double validation_mse = 0;
    add(all_units, Ours(data, kHidden + 1, &validation_mse));
    add(ours, Ours(data, learning::CascadeOptions{}.patience, &validation_mse));
    add(perceptron, Perceptron(data, validation_mse));
    add(baseline, Fann(data));
  }
  return Rows{
      MakeRow("cascade_training", ours.seconds, baseline.seconds, "s"),
      MakeRow("cascade_training_20_units", all_units.seconds, baseline.seconds, "s"),
      MakeRow("cascade_error", Rms(ours.mse), Rms(baseline.mse), "mm"),
      MakeRow("cascade_error_20_units", Rms(all_units.mse), Rms(baseline.mse), "mm"),
      MakeRow("cascade_training_and_perceptron", ours.seconds, perceptron.seconds, "s"),
      MakeRow("cascade_error_and_perceptron", Rms(ours.mse), Rms(perceptron.mse), "mm"),
  };
}

}  // namespace footing::bench

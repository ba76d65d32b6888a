#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/json_text.h"
#include "common/base/units.h"
#include "daemon/offline/learning/cascade.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/training_data.h"
#include "daemon/simulation/cascade/model.h"

namespace footing::train {
namespace {

struct CascadeOptions {
  DataOptions data;
  learning::CascadeOptions cascade;
  bool sigmoid = false;
  bool covariance = false;
};

int Run(const CascadeOptions& options, const Shared& shared) {
  const Result<TrainingData> data = Load(options.data);
  if (!data) return cli::Report(data.error());
  learning::CascadeOptions cascade = options.cascade;
  if (options.sigmoid) cascade.outputs = learning::Outputs::kSigmoid;
  if (options.covariance) cascade.objective = learning::Objective::kCovariance;

  const learning::Split& split = data->split;
  if (options.sigmoid && split.train.targets.cwiseAbs().maxCoeff() > 0.5) {
    return cli::Report(InvalidData(options.data.data + ": --sigmoid outputs lie within +-0.5"));
  }
  const std::int64_t start_ns = clock::MonotonicNs();
  const learning::CascadeResult result =
      learning::TrainCascade(split.train, split.validation, cascade, options.data.model.seed);
  const double seconds = NanosecondsToSeconds(clock::MonotonicNs() - start_ns);

  model::Model model =
      NewModel("cascade", shared, options.data.model, {data->file}, options.data.subjects);
  cascade::AppendTensors(result.network, "", model);
  if (auto written = WriteModel(model, options.data.model); !written) {
    return cli::Report(written.error());
  }
  const nlohmann::ordered_json report = {{"hidden_units", result.hidden_units},
                                         {"epochs", result.epochs},
                                         {"train_mse", result.train_mse},
                                         {"validation_mse", result.validation_mse},
                                         {"seconds", seconds}};
  if (shared.json) {
    std::cout << text::ToText(report) << std::endl;
  } else {
    std::cout << options.data.model.out << ": " << result.hidden_units << " hidden units after "
              << result.epochs << " epochs, mean squared error " << result.train_mse
              << " in training, " << result.validation_mse << " in validation, " << seconds << " s"
              << std::endl;
  }
  return 0;
}

}  // namespace

void AddCascadeCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<CascadeOptions>();
  learning::CascadeOptions& cascade = options->cascade;
  CLI::App* command =
      app.add_subcommand("cascade", "Cascade-correlation network for any table of numbers");
  AddDataOptions(*command, options->data);
  command->add_option("--hidden-max", cascade.hidden_max, "Maximum number of hidden units")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--patience", cascade.patience,
                   "Number of hidden units without a lower validation error before training stops")
      ->check(CLI::Range(1, 256));
  command
      ->add_option("--mse-goal", cascade.mse_goal,
                   "Training error at which training stops, mean square")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--pool", cascade.candidates.pool, "Number of candidates for each hidden unit")
      ->check(CLI::Range(1, 256));
  command
      ->add_option("--epochs-max", cascade.candidates.epochs_max,
                   "Maximum number of epochs for a pool of candidates")
      ->check(CLI::Range(1, 100000));
  command->add_flag("--sigmoid", options->sigmoid,
                    "Use sigmoid outputs of +-0.5, trained by Quickprop");
  command->add_flag("--covariance", options->covariance,
                    "Train candidates by covariance (1990) in place of error reduction");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/json_text.h"
#include "common/base/units.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/offline/train/command.h"
#include "daemon/offline/train/model_output.h"
#include "daemon/offline/train/training_data.h"

namespace footing::train {
namespace {

struct MlpOptions {
  DataOptions data;
  learning::MlpOptions mlp;
};

int Run(const MlpOptions& options, const Shared& shared) {
  const Result<TrainingData> data = Load(options.data);
  if (!data) return cli::Report(data.error());
  const std::int64_t start_ns = clock::MonotonicNs();
  const learning::MlpResult result = learning::TrainMlp(data->split.train, data->split.validation,
                                                        options.mlp, options.data.model.seed);
  const double seconds = NanosecondsToSeconds(clock::MonotonicNs() - start_ns);

  model::Model model =
      NewModel("mlp", shared, options.data.model, {data->file}, options.data.subjects);
  learning::AppendTensors(result.network, model);
  if (auto written = WriteModel(model, options.data.model); !written) {
    return cli::Report(written.error());
  }
  const nlohmann::ordered_json report = {{"hidden_units", options.mlp.hidden},
                                         {"epochs", result.epochs},
                                         {"train_mse", result.train_mse},
                                         {"validation_mse", result.validation_mse},
                                         {"seconds", seconds},
                                         {"goal_reached", result.goal_reached}};
  if (shared.json) {
    std::cout << text::ToText(report) << std::endl;
  } else {
    std::cout << options.data.model.out << ": " << options.mlp.hidden << " hidden units after "
              << result.epochs << " epochs, mean squared error " << result.train_mse
              << " in training, " << result.validation_mse << " in validation, " << seconds << " s"
              << (result.goal_reached ? ", goal reached" : "") << std::endl;
  }
  return 0;
}

}  // namespace

void AddMlpCommand(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<MlpOptions>();
  learning::MlpOptions& mlp = options->mlp;
  CLI::App* command = app.add_subcommand(
      "mlp", "Multilayer perceptron trained by back-propagation on the same table, for comparison");
  AddDataOptions(*command, options->data);
  command->add_option("--hidden", mlp.hidden, "Number of hidden units")->check(CLI::Range(1, 256));
  command->add_option("--rate", mlp.rate, "Learning rate")->check(CLI::Range(1e-6, 10.0));
  command
      ->add_option("--momentum", mlp.momentum, "Momentum: share of the previous step, 0 to 0.999")
      ->check(CLI::Range(0.0, 0.999));
  command->add_option("--batch", mlp.batch, "Number of rows in a batch")
      ->check(CLI::Range(1, 100000));
  command->add_option("--epochs-max", mlp.epochs_max, "Maximum number of passes over the data")
      ->check(CLI::Range(1, 1000000));
  command
      ->add_option("--patience", mlp.patience,
                   "Number of epochs without a lower error before training stops")
      ->check(CLI::Range(1, 1000000));
  command
      ->add_option("--mse-goal", mlp.mse_goal,
                   "Validation error at which training stops, mean square")
      ->check(CLI::NonNegativeNumber);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared); });
}

}  // namespace footing::train

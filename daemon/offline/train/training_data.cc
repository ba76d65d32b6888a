#include "daemon/offline/train/training_data.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "common/runtime/data_file.h"
#include "daemon/offline/train/table.h"

namespace footing::train {
namespace {

constexpr std::size_t kMostBytes = 256u << 20;
constexpr Eigen::Index kFewestRows = 10;

Result<std::vector<std::vector<Eigen::Index>>> FeedbackColumns(const DataOptions& options,
                                                               const Table& table) {
  std::vector<std::vector<Eigen::Index>> groups;
  for (const std::string& group : options.feedback) {
    std::vector<Eigen::Index>& columns = groups.emplace_back();
    std::istringstream names(group);
    for (std::string name; std::getline(names, name, ',');) {
      const auto end = table.columns.begin() + options.inputs;
      const auto found = std::find(table.columns.begin(), end, name);
      if (found == end) {
        return UsageError("--feedback " + group + ": " + name + " is none of the first " +
                          std::to_string(options.inputs) + " columns of " + options.data);
      }
      columns.push_back(found - table.columns.begin());
    }
  }
  return groups;
}

}  // namespace

void AddDataOptions(CLI::App& command, DataOptions& options) {
  command
      .add_option("--data", options.data,
                  "Training data, CSV: a row of column names, then one row per example")
      ->required();
  command
      .add_option("--inputs", options.inputs,
                  "Number of input columns, counted from the left; the other columns are outputs")
      ->required()
      ->check(CLI::Range(1, 256));
  command
      .add_option("--validation", options.validation,
                  "Share of the rows used for validation, taken from the end")
      ->check(CLI::Range(0.0, 0.9));
  command.add_option(
      "--feedback", options.feedback,
      "Input columns A,B,... that are earlier outputs of one signal; may be repeated");
  command
      .add_option("--noise", options.noise_sd,
                  "Noise of the feedback columns, in their unit: shared by a group, plus a tenth "
                  "of it per column")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--copies", options.copies,
                  "Number of copies of each row, each with its own noise")
      ->check(CLI::Range(1, 100));
  command.add_option("--subject", options.subjects,
                     "Subject of the data; the model is never evaluated on it; may be repeated");
  AddModelOptions(command, options.model);
}

Result<TrainingData> Load(const DataOptions& options) {
  if (auto free = CheckFree(options.model); !free) return free.error();
  const Result<std::string> text = config::ReadTextFile(options.data, kMostBytes);
  if (!text) return text.error();
  const Result<Table> table = ParseTable(*text, options.data);
  if (!table) return table.error();
  const Eigen::Index outputs = table->values.cols() - options.inputs;
  if (outputs < 1 || outputs > 64) {
    return UsageError("--inputs " + std::to_string(options.inputs) + " leaves " +
                      std::to_string(outputs) + " of the " + std::to_string(table->values.cols()) +
                      " columns of " + options.data + " as outputs; 1 to 64 are possible");
  }
  const Result<std::vector<std::vector<Eigen::Index>>> groups = FeedbackColumns(options, *table);
  if (!groups) return groups.error();

  TrainingData data;
  data.file = {.name = std::filesystem::path(options.data).filename().string(),
               .sha256 = model::Sha256(*text)};
  data.split = learning::SplitInTime({.inputs = table->values.leftCols(options.inputs),
                                      .targets = table->values.rightCols(outputs)},
                                     options.validation);
  if (data.split.train.rows() < kFewestRows) {
    return InvalidData(options.data + ": " + std::to_string(data.split.train.rows()) +
                       " rows are left for training, at least " + std::to_string(kFewestRows) +
                       " are needed");
  }
  learning::FeedbackNoise noise{.groups = *groups,
                                .common_sd = options.noise_sd,
                                .own_sd = options.noise_sd / 10,
                                .copies = options.copies};
  if (options.noise_sd > 0) {
    data.split.train = learning::WithFeedbackNoise(data.split.train, noise, options.model.seed);
    noise.copies = 1;
    data.split.validation =
        learning::WithFeedbackNoise(data.split.validation, noise, options.model.seed + 1);
  }
  return data;
}

}  // namespace footing::train

#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/offline/learning/examples.h"
#include "daemon/offline/train/model_output.h"

namespace footing::train {

/// What the subcommands that train on a table share on the command line.
struct DataOptions {
  std::string data;
  int inputs = 0;
  double validation = 0.2;
  std::vector<std::string> feedback;  ///< Names of columns, comma between; a group an option.
  double noise_sd = 0;
  int copies = 1;
  std::vector<std::string> subjects;
  ModelOptions model;
};

void AddDataOptions(CLI::App& command, DataOptions& options);

struct TrainingData {
  learning::Split split;
  model::DataFile file;
};

/// Reads, checks and splits the table and puts noise on what is fed back, in validation too.
/// Refuses an existing model before anything is trained.
Result<TrainingData> Load(const DataOptions& options);

}  // namespace footing::train

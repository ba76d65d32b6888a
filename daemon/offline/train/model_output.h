#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/offline/train/command.h"

namespace footing::train {

/// What every subcommand that writes a model takes.
struct ModelOptions {
  std::string out;
  bool force = false;
  std::uint64_t seed = 1;
  std::vector<std::string> licences;  ///< Kept by the command line, in the provenance.
};

void AddModelOptions(CLI::App& command, ModelOptions& options);

/// Refuses an `out` that exists, before anything is trained.
Result<void> CheckFree(const ModelOptions& options);

/// A model without tensors, with all that is known of where it comes from.
model::Model NewModel(const std::string& kind, const Shared& shared, const ModelOptions& options,
                      std::vector<model::DataFile> data, std::vector<std::string> subjects);

Result<void> WriteModel(const model::Model& model, const ModelOptions& options);

/// Writes the model, then the report of it to standard output; the program's exit code.
int Deliver(const model::Model& model, const ModelOptions& options,
            const nlohmann::ordered_json& report, const Shared& shared);

}  // namespace footing::train

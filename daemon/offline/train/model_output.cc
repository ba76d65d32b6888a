#include "daemon/offline/train/model_output.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/cli/cli.h"
#include "common/recording/output_file.h"
#include "common/base/json_text.h"
#include "common/wire/model_file.h"

namespace footing::train {

void AddModelOptions(CLI::App& command, ModelOptions& options) {
  command.add_option("--out", options.out, "Output model, NAME.fmodel")->required();
  command.add_option("--seed", options.seed,
                     "Seed of initial weights and noise; equal seeds give equal models");
  command.add_flag("--force", options.force, "Overwrite an existing model");
  command.add_option("--licence", options.licences,
                     "Owner and terms of the motion data, stored in the model; may be repeated");
}

Result<void> CheckFree(const ModelOptions& options) {
  return recording::CheckCreatable(options.out, options.force);
}

model::Model NewModel(const std::string& kind, const Shared& shared, const ModelOptions& options,
                      std::vector<model::DataFile> data, std::vector<std::string> subjects) {
  return {.kind = kind,
          .provenance = {.program_version = cli::Version(),
                         .command = shared.command_line,
                         .seed = options.seed,
                         .data = std::move(data),
                         .subjects = std::move(subjects)},
          .tensors = {}};
}

Result<void> WriteModel(const model::Model& model, const ModelOptions& options) {
  const Result<std::string> bytes = wire::ToModelFile(model);
  if (!bytes) return bytes.error();
  Result<recording::OutputFile> file = recording::OutputFile::Create(options.out, options.force);
  if (!file) return file.error();
  if (auto written = file->Write(*bytes); !written) return written;
  return file->Sync();
}

int Deliver(const model::Model& model, const ModelOptions& options,
            const nlohmann::ordered_json& report, const Shared& shared) {
  if (auto written = WriteModel(model, options); !written) return cli::Report(written.error());
  if (!shared.json) std::cout << options.out << ": ";
  std::cout << text::ToText(report) << std::endl;
  return 0;
}

}  // namespace footing::train

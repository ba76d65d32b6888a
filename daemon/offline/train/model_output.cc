#include "daemon/offline/train/model_output.h"

#include "common/recording/output_file.h"
#include "common/wire/model_file.h"

namespace footing::train {

Result<void> WriteModel(const model::Model& model, const std::string& path, bool force) {
  const Result<std::string> bytes = wire::ToModelFile(model);
  if (!bytes) return bytes.error();
  Result<recording::OutputFile> file = recording::OutputFile::Create(path, force);
  if (!file) return file.error();
  if (auto written = file->Write(*bytes); !written) return written;
  return file->Sync();
}

}  // namespace footing::train

#include "daemon/offline/eval/write_text.h"

#include "common/recording/output_file.h"

namespace footing::eval {

Result<void> WriteText(const std::string& path, const std::string& text) {
  auto file = recording::OutputFile::Create(path, true);
  if (!file) return file.error();
  if (auto written = file->Write(text); !written) return written;
  return file->Sync();
}

}  // namespace footing::eval

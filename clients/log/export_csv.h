#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::log_client {

struct ExportedFile {
  std::string topic;
  std::string path;
  std::uint64_t rows = 0;
};

/// Writes one CSV file a topic into `folder` (made if it is not there): log_time_ns,
/// publish_time_ns, sequence, then the columns of CsvTable. A recording that is cut short or
/// damaged is InvalidData that names the repair, and nothing is written; an existing file is a
/// usage error, unless `replace`.
Result<std::vector<ExportedFile>> ExportCsv(const std::string& recording, const std::string& folder,
                                            bool replace);

}  // namespace footing::log_client

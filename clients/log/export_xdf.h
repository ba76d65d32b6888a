#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::log_client {

/// One stream of an exported file.
struct ExportedStream {
  std::string name;
  std::uint64_t channels = 0;
  std::uint64_t samples = 0;
};

struct ExportedXdf {
  std::string path;
  std::vector<ExportedStream> streams;
};

/// Writes `folder`/NAME.xdf of the recording NAME.mcap, for readers of the Lab Streaming Layer: a
/// stream for each topic and each device (or entry of a list) in it, with the columns of CsvTable
/// that hold numbers, flags and enums; of the topic "events" a stream of texts. A sample's time is
/// when the device took it, else that of its tick: seconds of the server host's monotonic clock.
/// Errors as of ExportCsv().
Result<ExportedXdf> ExportXdf(const std::string& recording, const std::string& folder,
                              bool replace);

}  // namespace footing::log_client

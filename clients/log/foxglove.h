#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::log_client {

/// A topic of Foxglove's that was added to a recording.
struct FoxgloveTopic {
  std::string topic, schema;
  std::uint64_t messages = 0;
};

/// The file of an export with Foxglove's messages.
struct ExportedFoxglove {
  std::string path;
  std::vector<FoxgloveTopic> topics;
};

/// Writes "NAME_foxglove.mcap" into `folder`: the whole recording, and beside its own topics those
/// of foxglove_scene::Scene. InvalidData where it is cut short or damaged, or has nothing to be
/// drawn; a file that exists is a usage error, unless `replace`.
Result<ExportedFoxglove> ExportFoxglove(const std::string& recording, const std::string& folder,
                                        const std::string& library, bool replace);

}  // namespace footing::log_client

#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "common/recording/records.h"
#include "common/base/result.h"

namespace footing::mcap {

/// The index at the end of a complete file.
struct Summary {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;
};

/// Reads the index through the footer. InvalidData with the byte offset when the file is cut short,
/// has none, or it is damaged or longer than `most_bytes`.
Result<Summary> ReadSummary(std::string_view file,
                            std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

/// Visits the messages with start_ns <= log time < end_ns through the index, chunk after chunk in
/// the order of the file. InvalidData with the byte offset at the first damaged chunk.
Result<void> VisitMessages(std::string_view file, const Summary& summary, std::uint64_t start_ns,
                           std::uint64_t end_ns,
                           const std::function<void(const Message&)>& handler);

}  // namespace footing::mcap

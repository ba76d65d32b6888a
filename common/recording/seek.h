#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include "common/recording/summary.h"

/// Reading a file from any place. What is not read is not touched.
namespace footing::mcap {

/// Checks one chunk: its CRC, and that every record in it is complete. InvalidData with the byte
/// offset when it is damaged or compressed.
Result<void> CheckChunk(std::string_view file, const ChunkIndex& index);

/// Visits the messages of one chunk that CheckChunk accepts, in its order; its CRC is not checked
/// again. InvalidData with the byte offset, and no message, when its records are damaged.
Result<void> VisitChunk(std::string_view file, const ChunkIndex& index,
                        const std::function<void(const Message&)>& handler);

/// The same for the messages of one channel, found through the chunk's message index. Where the
/// file has no such index or it is wrong, the whole chunk is read.
Result<void> VisitChannel(std::string_view file, const ChunkIndex& index, std::uint16_t channel,
                          const std::function<void(const Message&)>& handler);

/// The index of a file that has none.
struct RebuiltIndex {
  Summary summary;               ///< Of `chunks`, each with its channels; their offsets are 0.
  std::uint64_t end_offset = 0;  ///< Behind the last complete record.
  std::string problem;           ///< Why the file ends there, or what was left out; empty: nothing.
};

/// Reads every record's head, from the file's start to its end or to the first record that is cut.
/// Damaged chunks and messages outside chunks are left out. InvalidData when the file is not MCAP,
/// has more than `most_chunks` chunks, or its chunks, schemas, channels and metadata would take
/// more than `most_bytes` in an index.
Result<RebuiltIndex> RebuildIndex(
    std::string_view file, std::size_t most_chunks,
    std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

}  // namespace footing::mcap

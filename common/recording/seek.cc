#include "common/recording/seek.h"

#include <optional>

#include "common/recording/crc.h"
#include "common/recording/decode.h"
#include "common/recording/found_record.h"

namespace footing::mcap {
namespace {

constexpr const char* kDamagedRecord = "a chunk with a damaged record";

Error DamagedAt(std::uint64_t offset, const std::string& what) {
  return InvalidData("byte " + std::to_string(offset) + ": " + what);
}

bool IsWhole(const Chunk& chunk) {
  return chunk.compression.empty() &&
         (chunk.uncompressed_crc == 0 || chunk.uncompressed_crc == Crc32(0, chunk.records));
}

std::optional<Chunk> ChunkAt(std::string_view file, std::uint64_t offset) {
  const std::optional<FoundRecord> record = RecordAt(file, offset);
  if (!record || record->opcode != Opcode::kChunk) return std::nullopt;
  return DecodeChunk(record->body);
}

/// Calls `take` with every record; false when one does not fit, or `take` gives false.
template <typename Taker>
bool ForEachRecord(std::string_view records, Taker take) {
  while (!records.empty()) {
    const std::optional<FoundRecord> record = FirstRecord(records);
    if (!record || !take(*record)) return false;
    records.remove_prefix(kRecordHeadBytes + record->body.size());
  }
  return true;
}

/// Every record fits, and every message has its fields.
bool RecordsAreWhole(const Chunk& chunk) {
  return ForEachRecord(chunk.records, [](const FoundRecord& record) {
    return record.opcode != Opcode::kMessage || DecodeMessage(record.body).has_value();
  });
}

/// The message of this channel at `offset` within a chunk's records.
std::optional<Message> MessageAt(std::string_view records, std::uint64_t offset,
                                 std::uint16_t channel) {
  const std::optional<FoundRecord> record = RecordAt(records, offset);
  if (!record || record->opcode != Opcode::kMessage) return std::nullopt;
  const std::optional<Message> message = DecodeMessage(record->body);
  if (!message || message->channel_id != channel) return std::nullopt;
  return message;
}

/// The channel's message index at `offset` of the file; nothing when an entry names anything but a
/// message of the channel.
std::optional<MessageIndex> IndexAt(std::string_view file, std::uint64_t offset,
                                    std::uint16_t channel, std::string_view records) {
  const std::optional<FoundRecord> record = RecordAt(file, offset);
  if (!record || record->opcode != Opcode::kMessageIndex) return std::nullopt;
  std::optional<MessageIndex> index = DecodeMessageIndex(record->body);
  if (!index || index->channel_id != channel) return std::nullopt;
  for (const MessageIndex::Entry& entry : index->entries) {
    if (!MessageAt(records, entry.offset, channel)) return std::nullopt;
  }
  return index;
}

/// Bytes that an index may still take.
struct Budget {
  std::uint64_t left = 0;
  bool exceeded = false;

  bool Take(std::uint64_t bytes) {
    if (bytes > left) exceeded = true;
    if (!exceeded) left -= bytes;
    return !exceeded;
  }
};

/// Of one chunk, and of one of its channels, in an index that stands in a file.
constexpr std::uint64_t kChunkEntryBytes = 64, kChannelEntryBytes = 10, kMetadataEntryBytes = 32;

/// Keeps the first record of an id; false when it is damaged or the budget is exceeded.
template <typename T>
bool TakeOnce(std::string_view body, std::optional<T> (*decode)(std::string_view),
              std::map<std::uint16_t, T>& kept, Budget& budget) {
  const std::uint16_t id = Cursor(body).U16();
  if (kept.count(id) > 0) return true;
  if (!budget.Take(body.size())) return false;
  std::optional<T> decoded = decode(body);
  if (!decoded) return false;
  kept.emplace(id, *std::move(decoded));
  return true;
}

bool TakeRecord(const FoundRecord& record, Summary& summary, ChunkIndex& index, Budget& budget) {
  if (record.opcode == Opcode::kSchema) {
    return TakeOnce(record.body, DecodeSchema, summary.schemas, budget);
  }
  if (record.opcode == Opcode::kChannel) {
    return TakeOnce(record.body, DecodeChannel, summary.channels, budget);
  }
  if (record.opcode != Opcode::kMessage) return true;
  const std::optional<Message> message = DecodeMessage(record.body);
  if (!message) return false;
  const bool fresh = index.message_index_offsets.emplace(message->channel_id, 0).second;
  return !fresh || budget.Take(kChannelEntryBytes);
}

/// The chunk's index entry; nothing when the chunk is damaged or compressed, or the budget is
/// exceeded.
std::optional<ChunkIndex> IndexOf(std::string_view body, std::uint64_t offset, Summary& summary,
                                  Budget& budget) {
  const std::optional<Chunk> chunk = DecodeChunk(body);
  if (!chunk || !IsWhole(*chunk) || !budget.Take(kChunkEntryBytes)) return std::nullopt;
  ChunkIndex index;
  index.start_time_ns = chunk->start_time_ns;
  index.end_time_ns = chunk->end_time_ns;
  index.chunk_offset = offset;
  index.chunk_length = kRecordHeadBytes + body.size();
  const bool whole = ForEachRecord(chunk->records, [&](const FoundRecord& record) {
    return TakeRecord(record, summary, index, budget);
  });
  if (!whole) return std::nullopt;
  return index;
}

void TakeMetadata(std::string_view body, std::uint64_t offset, Summary& summary, Budget& budget) {
  const std::string_view name = Cursor(body).Text();
  if (!budget.Take(kMetadataEntryBytes + name.size())) return;
  if (!DecodeMetadata(body)) return;
  summary.metadata.push_back({offset, kRecordHeadBytes + body.size(), std::string(name)});
}

}  // namespace

Result<void> CheckChunk(std::string_view file, const ChunkIndex& index) {
  const std::optional<Chunk> chunk = ChunkAt(file, index.chunk_offset);
  if (!chunk || !IsWhole(*chunk)) {
    return DamagedAt(index.chunk_offset, "a damaged chunk, or a compressed one");
  }
  if (!RecordsAreWhole(*chunk)) return DamagedAt(index.chunk_offset, kDamagedRecord);
  return {};
}

Result<void> VisitChunk(std::string_view file, const ChunkIndex& index,
                        const std::function<void(const Message&)>& handler) {
  const std::optional<Chunk> chunk = ChunkAt(file, index.chunk_offset);
  // Checked ahead: of a damaged chunk nothing is delivered.
  if (!chunk || !chunk->compression.empty() || !RecordsAreWhole(*chunk)) {
    return DamagedAt(index.chunk_offset, kDamagedRecord);
  }
  ForEachRecord(chunk->records, [&](const FoundRecord& record) {
    if (record.opcode == Opcode::kMessage) handler(*DecodeMessage(record.body));
    return true;
  });
  return {};
}

Result<void> VisitChannel(std::string_view file, const ChunkIndex& index, std::uint16_t channel,
                          const std::function<void(const Message&)>& handler) {
  const auto found = index.message_index_offsets.find(channel);
  if (found == index.message_index_offsets.end()) return {};
  const std::optional<Chunk> chunk = ChunkAt(file, index.chunk_offset);
  const auto entries = chunk && chunk->compression.empty() && found->second != 0
                           ? IndexAt(file, found->second, channel, chunk->records)
                           : std::nullopt;
  if (!entries) {
    return VisitChunk(file, index, [&](const Message& message) {
      if (message.channel_id == channel) handler(message);
    });
  }
  for (const MessageIndex::Entry& entry : entries->entries) {
    handler(*MessageAt(chunk->records, entry.offset, channel));
  }
  return {};
}

Result<RebuiltIndex> RebuildIndex(std::string_view file, std::size_t most_chunks,
                                  std::uint64_t most_bytes) {
  if (file.substr(0, kMagic.size()) != kMagic) return DamagedAt(0, "this is not an MCAP file");
  RebuiltIndex rebuilt;
  std::uint64_t damaged = 0, outside = 0;
  rebuilt.end_offset = kMagic.size();
  Budget budget{most_bytes};
  bool ended = false;
  while (!ended) {
    const std::optional<FoundRecord> record = RecordAt(file, rebuilt.end_offset);
    if (!record) {
      rebuilt.problem = "it is cut at byte " + std::to_string(rebuilt.end_offset);
      break;
    }
    if (record->opcode == Opcode::kChunk) {
      if (rebuilt.summary.chunks.size() >= most_chunks) {
        return DamagedAt(rebuilt.end_offset,
                         "more than " + std::to_string(most_chunks) + " chunks");
      }
      const auto index = IndexOf(record->body, rebuilt.end_offset, rebuilt.summary, budget);
      if (index) rebuilt.summary.chunks.push_back(*index);
      damaged += index ? 0 : 1;
    } else if (record->opcode == Opcode::kMetadata) {
      TakeMetadata(record->body, rebuilt.end_offset, rebuilt.summary, budget);
    }
    if (budget.exceeded) {
      return DamagedAt(rebuilt.end_offset,
                       "an index of more than " + std::to_string(most_bytes) + " bytes");
    }
    outside += record->opcode == Opcode::kMessage ? 1 : 0;
    ended = record->opcode == Opcode::kDataEnd;
    rebuilt.end_offset += kRecordHeadBytes + record->body.size();
  }
  const auto left_out = [&rebuilt](std::uint64_t count, const char* what) {
    if (count == 0) return;
    rebuilt.problem += (rebuilt.problem.empty() ? "" : ", ") + std::to_string(count) + what;
  };
  left_out(damaged, " damaged chunks are left out");
  left_out(outside, " messages outside chunks are left out");
  return rebuilt;
}

}  // namespace footing::mcap

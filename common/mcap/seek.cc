#include "common/mcap/seek.h"

#include <optional>

#include "common/mcap/crc.h"
#include "common/mcap/decode.h"

namespace footing::mcap {
namespace {

constexpr const char* kDamagedRecord = "a chunk with a damaged record";

Error DamagedAt(std::uint64_t offset, const std::string& what) {
  return InvalidData("byte " + std::to_string(offset) + ": " + what);
}

struct FoundRecord {
  Opcode opcode{};
  std::string_view body;
};

/// The record at the start of the bytes; nothing when it does not fit.
std::optional<FoundRecord> FirstRecord(std::string_view bytes) {
  Cursor head(bytes);
  const auto opcode = static_cast<Opcode>(head.U8());
  const std::string_view body = head.Take(head.U64());
  if (!head.ok()) return std::nullopt;
  return FoundRecord{opcode, body};
}

std::optional<FoundRecord> RecordAt(std::string_view bytes, std::uint64_t offset) {
  if (offset > bytes.size()) return std::nullopt;
  return FirstRecord(bytes.substr(offset));
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

/// Takes a schema or channel into the summary; false when it is damaged.
bool TakeDefinition(const FoundRecord& record, Summary& summary) {
  if (record.opcode == Opcode::kSchema) {
    const std::optional<Schema> schema = DecodeSchema(record.body);
    if (schema) summary.schemas[schema->id] = *schema;
    return schema.has_value();
  }
  if (record.opcode == Opcode::kChannel) {
    const std::optional<Channel> channel = DecodeChannel(record.body);
    if (channel) summary.channels[channel->id] = *channel;
    return channel.has_value();
  }
  return true;
}

/// The chunk's index entry; nothing when the chunk is damaged or compressed.
std::optional<ChunkIndex> IndexOf(std::string_view body, std::uint64_t offset, Summary& summary) {
  const std::optional<Chunk> chunk = DecodeChunk(body);
  if (!chunk || !IsWhole(*chunk)) return std::nullopt;
  ChunkIndex index;
  index.start_time_ns = chunk->start_time_ns;
  index.end_time_ns = chunk->end_time_ns;
  index.chunk_offset = offset;
  index.chunk_length = kRecordHeadBytes + body.size();
  const bool whole = ForEachRecord(chunk->records, [&](const FoundRecord& record) {
    if (record.opcode != Opcode::kMessage) return TakeDefinition(record, summary);
    const std::optional<Message> message = DecodeMessage(record.body);
    if (message) index.message_index_offsets[message->channel_id] = 0;
    return message.has_value();
  });
  if (!whole) return std::nullopt;
  return index;
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

Result<RebuiltIndex> RebuildIndex(std::string_view file, std::size_t most_chunks) {
  if (file.substr(0, kMagic.size()) != kMagic) return DamagedAt(0, "this is not an MCAP file");
  RebuiltIndex rebuilt;
  std::uint64_t damaged = 0, outside = 0;
  rebuilt.end_offset = kMagic.size();
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
      const auto index = IndexOf(record->body, rebuilt.end_offset, rebuilt.summary);
      if (index) rebuilt.summary.chunks.push_back(*index);
      damaged += index ? 0 : 1;
    } else if (record->opcode == Opcode::kMetadata) {
      const std::optional<Metadata> metadata = DecodeMetadata(record->body);
      const std::uint64_t length = kRecordHeadBytes + record->body.size();
      if (metadata) {
        rebuilt.summary.metadata.push_back({rebuilt.end_offset, length, metadata->name});
      }
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

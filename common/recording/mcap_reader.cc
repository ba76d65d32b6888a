#include "common/recording/mcap_reader.h"

#include <map>
#include <optional>
#include <utility>

#include "common/base/result.h"
#include "common/recording/mcap_records.h"

namespace footing::mcap {
namespace {

struct RawRecord {
  std::uint8_t opcode = 0;
  std::string_view body;
  std::uint64_t offset = 0;  ///< Place of its head, in the file.
};

/// The state of one walk.
class Walker {
 public:
  Walker(std::string_view file, const Visitor& visitor, WalkMode mode)
      : file_(file), visitor_(visitor), mode_(mode), resync_(file) {}

  WalkEnd Run() {
    if (!OpeningMagic()) return end_;
    std::uint64_t offset = kMagic.size();
    end_.end_offset = offset;
    if (mode_ == WalkMode::kSalvage) TakeChannelsFromSummary();
    while (!stopped_) {
      if (const auto on = WayOn(offset)) {
        offset = *on;
        continue;
      }
      const std::optional<RawRecord> record = Next(file_, 0, offset);
      if (!record) break;
      const std::uint64_t damaged = end_.damaged_chunks;
      Visit(*record);
      if (stopped_) break;
      if (end_.damaged_chunks > damaged) suspect_ = offset;
      offset += kRecordHeadBytes + record->body.size();
      end_.end_offset = offset;
      if (record->opcode == static_cast<std::uint8_t>(Opcode::kFooter)) {
        ClosingMagic(offset);
        break;
      }
    }
    end_.complete = end_.problem.empty();
    return end_;
  }

 private:
  /// Start of the next whole chunk, for a salvage whose next record is damaged. Behind a damaged
  /// chunk it may begin before the end that the chunk claims.
  std::optional<std::uint64_t> WayOn(std::uint64_t offset) {
    if (mode_ != WalkMode::kSalvage) return std::nullopt;
    const std::optional<std::uint64_t> suspect = std::exchange(suspect_, std::nullopt);
    const auto on = resync_.WayOn(offset, suspect);
    if (!on) return std::nullopt;
    if (!suspect) Damaged(offset, "bytes where a record should begin");
    end_.skipped_bytes += *on > offset ? *on - offset : 0;
    return on;
  }

  bool OpeningMagic() {
    if (file_.substr(0, kMagic.size()) == kMagic) return true;
    end_.cut = kMagic.substr(0, file_.size()) == file_;
    Problem(0, end_.cut ? "the file ends within its first 8 bytes" : "this is not an MCAP file");
    return false;
  }

  /// A damaged chunk may hold the channels of all that follow; the summary repeats them.
  void TakeChannelsFromSummary() {
    const Result<Summary> summary = ReadSummary(file_);
    if (!summary) return;
    for (const auto& [id, schema] : summary->schemas) {
      if (id == 0) continue;
      schemas_.emplace(id, schema);
      if (visitor_.schema) visitor_.schema(schema);
    }
    for (const auto& [id, channel] : summary->channels) {
      if (channel.schema_id != 0 && schemas_.count(channel.schema_id) == 0) continue;
      channels_.emplace(id, channel);
      if (visitor_.channel) visitor_.channel(channel);
    }
  }

  void ClosingMagic(std::uint64_t offset) {
    const std::string_view rest = file_.substr(offset);
    if (rest == kMagic) return;
    end_.cut = kMagic.substr(0, rest.size()) == rest;
    Problem(offset, end_.cut ? "the file ends within its last 8 bytes"
                             : "other bytes than MCAP's magic at the end");
  }

  void Problem(std::uint64_t offset, const std::string& what) {
    if (end_.problem.empty()) {
      end_.problem = what;
      end_.problem_offset = offset;
    }
    if (mode_ == WalkMode::kStrict) stopped_ = true;
  }

  void Damaged(std::uint64_t offset, const std::string& what) {
    ++end_.damaged_records;
    if (visitor_.damage) visitor_.damage();
    Problem(offset, what);
  }

  /// The record at `offset` of `bytes`, which begin at `base` of the file. Without a complete one
  /// the walk over `bytes` is over, and the file's cut chunk is looked into.
  std::optional<RawRecord> Next(std::string_view bytes, std::uint64_t base, std::uint64_t offset) {
    const bool outer = base == 0;
    Cursor head(bytes.substr(offset));
    const std::uint8_t opcode = head.U8();
    const std::uint64_t length = head.U64();
    if (head.ok() && length <= head.rest().size()) {
      return RawRecord{opcode, head.rest().substr(0, length), base + offset};
    }
    end_.cut = true;
    if (!head.ok()) {
      Problem(base + offset, offset == bytes.size()
                                 ? std::string("the file ends here, without its end")
                                 : std::string("the file ends within a record's head"));
    } else {
      Problem(base + offset, "a record of " + std::to_string(length) + " bytes, but only " +
                                 std::to_string(head.rest().size()) + " follow");
      if (outer && opcode == static_cast<std::uint8_t>(Opcode::kChunk)) {
        VisitCutChunk(head.rest(), base + offset + kRecordHeadBytes);
      }
    }
    return std::nullopt;
  }

  void VisitCutChunk(std::string_view body, std::uint64_t body_offset) {
    const std::optional<Chunk> chunk = DecodeChunk(body, true);
    if (!chunk || !chunk->compression.empty() || stopped_) return;
    VisitRecords(chunk->records, body_offset + body.size() - chunk->records.size());
  }

  void VisitRecords(std::string_view records, std::uint64_t base) {
    std::uint64_t offset = 0;
    while (!stopped_ && offset < records.size()) {
      const std::optional<RawRecord> record = Next(records, base, offset);
      if (!record) return;
      switch (static_cast<Opcode>(record->opcode)) {
        case Opcode::kSchema:
          VisitSchema(*record);
          break;
        case Opcode::kChannel:
          VisitChannel(*record);
          break;
        case Opcode::kMessage:
          VisitMessage(*record);
          break;
        default:
          Damaged(record->offset, "a record that may not stand in a chunk");
          break;
      }
      offset += kRecordHeadBytes + record->body.size();
    }
  }

  void Visit(const RawRecord& record) {
    switch (static_cast<Opcode>(record.opcode)) {
      case Opcode::kHeader:
        Call(visitor_.header, DecodeHeader(record.body), record, "header");
        break;
      case Opcode::kSchema:
        VisitSchema(record);
        break;
      case Opcode::kChannel:
        VisitChannel(record);
        break;
      case Opcode::kMessage:
        if (chunked_) return Damaged(record.offset, "a message outside the chunks");
        VisitMessage(record);
        break;
      case Opcode::kChunk:
        VisitChunk(record);
        break;
      case Opcode::kAttachment:
        Call(visitor_.attachment, DecodeAttachment(record.body), record, "attachment");
        break;
      case Opcode::kMetadata:
        Call(visitor_.metadata, DecodeMetadata(record.body), record, "metadata");
        break;
      case Opcode::kDataEnd:
        VisitDataEnd(record);
        break;
      case Opcode::kFooter:
        VisitFooter(record);
        break;
      case Opcode::kMessageIndex:
      case Opcode::kChunkIndex:
      case Opcode::kAttachmentIndex:
      case Opcode::kStatistics:
      case Opcode::kMetadataIndex:
      case Opcode::kSummaryOffset:
        break;
      default:
        // 0x80 and above are the applications' own; the rest may come with later versions.
        if (record.opcode == 0) Damaged(record.offset, "a record of unknown kind 0");
        break;
    }
  }

  template <typename T>
  void Call(const std::function<void(const T&)>& handler, const std::optional<T>& value,
            const RawRecord& record, const char* name) {
    if (!value) return Damaged(record.offset, std::string("a damaged ") + name);
    if (handler) handler(*value);
  }

  void VisitSchema(const RawRecord& record) {
    const std::optional<Schema> schema = DecodeSchema(record.body);
    if (!schema || schema->id == 0) return Damaged(record.offset, "a damaged schema");
    const auto [known, fresh] = schemas_.emplace(schema->id, *schema);
    if (!fresh && known->second != *schema) {
      return Damaged(record.offset, "a second, other schema of id " + std::to_string(schema->id));
    }
    if (fresh && visitor_.schema) visitor_.schema(*schema);
  }

  void VisitChannel(const RawRecord& record) {
    const std::optional<Channel> channel = DecodeChannel(record.body);
    if (!channel) return Damaged(record.offset, "a damaged channel");
    if (channel->schema_id != 0 && schemas_.count(channel->schema_id) == 0) {
      return Damaged(record.offset, "channel " + channel->topic + " without its schema");
    }
    const auto [known, fresh] = channels_.emplace(channel->id, *channel);
    if (!fresh && known->second != *channel) {
      return Damaged(record.offset, "a second, other channel of id " + std::to_string(channel->id));
    }
    if (fresh && visitor_.channel) visitor_.channel(*channel);
  }

  void VisitMessage(const RawRecord& record) {
    const std::optional<Message> message = DecodeMessage(record.body);
    if (!message) return Damaged(record.offset, "a damaged message");
    if (channels_.count(message->channel_id) == 0) {
      return Damaged(record.offset,
                     "a message of the unknown channel " + std::to_string(message->channel_id));
    }
    if (visitor_.message) visitor_.message(*message);
  }

  void VisitChunk(const RawRecord& record) {
    chunked_ = true;
    const std::optional<Chunk> packed = DecodeChunk(record.body);
    std::string own;
    std::string& unpacked = visitor_.unpacked != nullptr && packed && !packed->compression.empty()
                                ? visitor_.unpacked->emplace_back()
                                : own;
    const std::optional<Chunk> chunk = packed ? Unpack(*packed, unpacked) : std::nullopt;
    const std::string what = ProblemOf(chunk);
    if (!what.empty()) {
      ++end_.damaged_chunks;
      if (visitor_.damage) visitor_.damage();
      return Problem(record.offset, what);
    }
    if (visitor_.chunk) visitor_.chunk(*packed);
    // A record of a compressed chunk has no place of its own in the file.
    const bool is_packed = !packed->compression.empty();
    VisitRecords(chunk->records,
                 is_packed ? record.offset
                           : static_cast<std::uint64_t>(chunk->records.data() - file_.data()));
  }

  void VisitDataEnd(const RawRecord& record) {
    const Closing closing = CheckDataEnd(file_, record.body, record.offset);
    data_ended_ = data_ended_ || closing.damage.empty();
    Report(closing, record);
  }

  void VisitFooter(const RawRecord& record) {
    Report(CheckFooter(file_, record.body, record.offset, data_ended_), record);
  }

  void Report(const Closing& closing, const RawRecord& record) {
    if (!closing.damage.empty()) return Damaged(record.offset, closing.damage);
    if (!closing.problem.empty()) Problem(record.offset, closing.problem);
  }

  std::string_view file_;
  const Visitor& visitor_;
  WalkMode mode_;
  WalkEnd end_;
  Resync resync_;
  std::optional<std::uint64_t> suspect_;  ///< The chunk just left out, whose length may be wrong.
  bool stopped_ = false;
  bool chunked_ = false;
  bool data_ended_ = false;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

WalkEnd Walk(std::string_view file, const Visitor& visitor, WalkMode mode) {
  return Walker(file, visitor, mode).Run();
}

namespace {

constexpr std::size_t kFooterBytes = kRecordHeadBytes + 20;

Error At(std::uint64_t offset, const std::string& what) {
  return InvalidData("byte " + std::to_string(offset) + ": " + what);
}

/// The record at `offset`, or nothing when it does not fit into the bytes.
std::optional<std::string_view> Body(std::string_view bytes, std::uint64_t offset, Opcode opcode) {
  if (offset > bytes.size()) return std::nullopt;
  Cursor head(bytes.substr(offset));
  const std::uint8_t found = head.U8();
  const std::string_view body = head.Bytes(head.U64());
  if (!head.ok() || found != static_cast<std::uint8_t>(opcode)) return std::nullopt;
  return body;
}

template <typename T, typename Store>
bool Keep(const std::optional<T>& record, Store store) {
  if (record) store(*record);
  return record.has_value();
}

bool Take(std::uint8_t opcode, std::string_view body, Summary& summary) {
  switch (static_cast<Opcode>(opcode)) {
    case Opcode::kSchema:
      return Keep(DecodeSchema(body), [&](const auto& r) { summary.schemas[r.id] = r; });
    case Opcode::kChannel:
      return Keep(DecodeChannel(body), [&](const auto& r) { summary.channels[r.id] = r; });
    case Opcode::kStatistics:
      return Keep(DecodeStatistics(body), [&](const auto& r) { summary.statistics = r; });
    case Opcode::kChunkIndex:
      return Keep(DecodeChunkIndex(body), [&](const auto& r) { summary.chunks.push_back(r); });
    case Opcode::kAttachmentIndex:
      return Keep(DecodeAttachmentIndex(body),
                  [&](const auto& r) { summary.attachments.push_back(r); });
    case Opcode::kMetadataIndex:
      return Keep(DecodeMetadataIndex(body), [&](const auto& r) { summary.metadata.push_back(r); });
    default:
      return true;  // Summary offsets, and what later versions may add.
  }
}

}  // namespace

Result<Summary> ReadSummary(std::string_view file, std::uint64_t most_bytes) {
  const std::size_t tail = kFooterBytes + kMagic.size();
  if (file.size() < kMagic.size() + tail || file.substr(0, kMagic.size()) != kMagic) {
    return At(0, "this is not a complete MCAP file");
  }
  const std::uint64_t footer_offset = file.size() - tail;
  const auto body = Body(file, footer_offset, Opcode::kFooter);
  if (!body || file.substr(file.size() - kMagic.size()) != kMagic) {
    return At(file.size(), "the file ends without a footer: it is cut short");
  }
  const std::optional<Footer> footer = DecodeFooter(*body);
  if (!footer || footer->summary_start == 0 || footer->summary_start > footer_offset) {
    return At(footer_offset, "the footer names no summary");
  }
  const std::uint64_t start = footer->summary_start;
  if (footer_offset - start > most_bytes) {
    return At(start, "an index of " + std::to_string(footer_offset - start) + " bytes; at most " +
                         std::to_string(most_bytes) + " are read");
  }
  const std::uint64_t covered = footer_offset + kRecordHeadBytes + 16 - start;
  if (footer->summary_crc != 0 && footer->summary_crc != Crc32(0, file.substr(start, covered))) {
    return At(start, "the CRC of the summary is wrong");
  }
  Summary summary;
  const std::string_view records = file.substr(start, footer_offset - start);
  for (std::uint64_t offset = 0; offset < records.size();) {
    Cursor head(records.substr(offset));
    const std::uint8_t opcode = head.U8();
    const std::string_view record = head.Bytes(head.U64());
    if (!head.ok() || !Take(opcode, record, summary)) {
      return At(start + offset, "a damaged record of the summary");
    }
    offset += kRecordHeadBytes + record.size();
  }
  return summary;
}

namespace {

constexpr const char* kDamagedRecord = "a chunk with a damaged record";

Error DamagedAt(std::uint64_t offset, const std::string& what) {
  return InvalidData("byte " + std::to_string(offset) + ": " + what);
}

bool IsWhole(const Chunk& chunk) {
  return chunk.compression.empty() &&
         (chunk.uncompressed_crc == 0 || chunk.uncompressed_crc == Crc32(0, chunk.records));
}

/// The chunk of these bytes, unpacked.
std::optional<Chunk> ReadChunk(std::string_view body, std::string& unpacked) {
  std::optional<Chunk> chunk = DecodeChunk(body);
  return chunk ? Unpack(*std::move(chunk), unpacked) : std::nullopt;
}

std::optional<Chunk> ChunkAt(std::string_view file, std::uint64_t offset, std::string& unpacked) {
  const std::optional<FoundRecord> record = RecordAt(file, offset);
  if (!record || record->opcode != Opcode::kChunk) return std::nullopt;
  return ReadChunk(record->body, unpacked);
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

  bool Spend(std::uint64_t bytes) {
    if (bytes > left) exceeded = true;
    if (!exceeded) left -= bytes;
    return !exceeded;
  }
};

/// Bytes that one chunk, channel or metadata entry takes of the budget for an index in a file.
constexpr std::uint64_t kChunkEntryBytes = 64, kChannelEntryBytes = 10, kMetadataEntryBytes = 32;

/// Keeps the first record of an id; false when it is damaged or the budget is exceeded.
template <typename T>
bool TakeOnce(std::string_view body, std::optional<T> (*decode)(std::string_view),
              std::map<std::uint16_t, T>& kept, Budget& budget) {
  const std::uint16_t id = Cursor(body).U16();
  if (kept.count(id) > 0) return true;
  if (!budget.Spend(body.size())) return false;
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
  return !fresh || budget.Spend(kChannelEntryBytes);
}

/// The chunk's index entry; nothing when the chunk is damaged or of an unknown compression, or the
/// budget is exceeded.
std::optional<ChunkIndex> IndexOf(std::string_view body, std::uint64_t offset, Summary& summary,
                                  Budget& budget) {
  std::string unpacked;
  const std::optional<Chunk> chunk = ReadChunk(body, unpacked);
  if (!chunk || !IsWhole(*chunk) || !budget.Spend(kChunkEntryBytes)) return std::nullopt;
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
  if (!budget.Spend(kMetadataEntryBytes + name.size())) return;
  if (!DecodeMetadata(body)) return;
  summary.metadata.push_back({offset, kRecordHeadBytes + body.size(), std::string(name)});
}

}  // namespace

Result<void> CheckChunk(std::string_view file, const ChunkIndex& index) {
  std::string unpacked;
  const std::optional<Chunk> chunk = ChunkAt(file, index.chunk_offset, unpacked);
  if (!chunk || !IsWhole(*chunk)) {
    return DamagedAt(index.chunk_offset, "a damaged chunk, or one of an unknown compression");
  }
  if (!RecordsAreWhole(*chunk)) return DamagedAt(index.chunk_offset, kDamagedRecord);
  return {};
}

Result<void> VisitChunk(std::string_view file, const ChunkIndex& index,
                        const std::function<void(const Message&)>& handler) {
  std::string unpacked;
  const std::optional<Chunk> chunk = ChunkAt(file, index.chunk_offset, unpacked);
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
  std::string unpacked;
  const std::optional<Chunk> chunk = ChunkAt(file, index.chunk_offset, unpacked);
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

namespace {

constexpr std::uint64_t kBudgetPerByte = 8;

}  // namespace

Resync::Resync(std::string_view file) : file_(file), budget_(kBudgetPerByte * file.size()) {}

std::optional<std::uint64_t> Resync::WayOn(std::uint64_t offset,
                                           std::optional<std::uint64_t> suspect) {
  if (CanBeRecord(offset) && (!suspect || IsRecord(offset))) return std::nullopt;
  return NextChunk(suspect.value_or(offset) + 1);
}

bool Resync::CanBeRecord(std::uint64_t offset) const {
  const auto record = RecordAt(file_, offset);
  return record && record->opcode != Opcode{};
}

bool Resync::IsRecord(std::uint64_t offset) const {
  const auto record = RecordAt(file_, offset);
  if (!record) return false;
  switch (record->opcode) {
    case Opcode::kChunk:
      return DecodeChunk(record->body).has_value();
    case Opcode::kMessageIndex:
      return DecodeMessageIndex(record->body).has_value();
    case Opcode::kMetadata:
      return DecodeMetadata(record->body).has_value();
    case Opcode::kAttachment:
      return DecodeAttachment(record->body).has_value();
    case Opcode::kDataEnd:
      return record->body.size() >= sizeof(std::uint32_t);
    default:
      return false;
  }
}

std::optional<std::uint64_t> Resync::NextChunk(std::uint64_t from) {
  constexpr char kChunk = static_cast<char>(Opcode::kChunk);
  for (std::size_t at = file_.find(kChunk, from); at != std::string_view::npos;
       at = file_.find(kChunk, at + 1)) {
    const auto record = RecordAt(file_, at);
    const auto packed = record ? DecodeChunk(record->body) : std::nullopt;
    // Without a CRC nothing distinguishes a chunk from other bytes.
    if (!packed || packed->uncompressed_crc == 0 || packed->records.empty()) continue;
    std::string unpacked;
    const auto chunk = Unpack(*packed, unpacked);
    if (!chunk || chunk->uncompressed_size != chunk->records.size()) continue;
    if (chunk->records.size() > budget_) return std::nullopt;
    budget_ -= chunk->records.size();
    if (ProblemOf(chunk).empty()) return at;
  }
  return std::nullopt;
}

}  // namespace footing::mcap

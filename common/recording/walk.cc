#include "common/recording/walk.h"

#include <map>
#include <optional>
#include <utility>

#include "common/recording/checks.h"
#include "common/recording/decode.h"
#include "common/recording/resync.h"
#include "common/recording/summary.h"
#include "common/base/result.h"

namespace footing::mcap {
namespace {

struct RawRecord {
  std::uint8_t opcode = 0;
  std::string_view body;
  std::uint64_t offset = 0;  ///< Of its head, in the file.
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
  /// Of a salvage whose next record cannot be one: where the next whole chunk begins. Behind a
  /// damaged chunk it may begin before the end that the chunk claims.
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
    const std::optional<Chunk> chunk = DecodeChunk(record.body);
    const std::string what = ProblemOf(chunk);
    if (!what.empty()) {
      ++end_.damaged_chunks;
      if (visitor_.damage) visitor_.damage();
      return Problem(record.offset, what);
    }
    VisitRecords(chunk->records, static_cast<std::uint64_t>(chunk->records.data() - file_.data()));
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

}  // namespace footing::mcap

#include "common/mcap/walk.h"

#include <map>
#include <optional>

#include "common/mcap/crc.h"
#include "common/mcap/decode.h"
#include "common/mcap/summary.h"
#include "common/result/result.h"

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
      : file_(file), visitor_(visitor), mode_(mode) {}

  WalkEnd Run() {
    if (!OpeningMagic()) return end_;
    std::uint64_t offset = kMagic.size();
    end_.end_offset = offset;
    if (mode_ == WalkMode::kSalvage) TakeChannelsFromSummary();
    while (!stopped_) {
      const std::optional<RawRecord> record = Next(file_, 0, offset);
      if (!record) break;
      Visit(*record);
      if (stopped_) break;
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
        if (record.opcode == 0) Damaged(record.offset, "a record of kind 0, which there is not");
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
    std::string what;
    if (!chunk) {
      what = "a damaged chunk";
    } else if (!chunk->compression.empty()) {
      what = "a chunk compressed by " + chunk->compression + ", which is not read here";
    } else if (chunk->uncompressed_size != chunk->records.size()) {
      what = "a chunk whose two sizes differ";
    } else if (chunk->uncompressed_crc != 0 &&
               chunk->uncompressed_crc != Crc32(0, chunk->records)) {
      what = "a chunk whose CRC is wrong";
    }
    if (!what.empty()) {
      ++end_.damaged_chunks;
      return Problem(record.offset, what);
    }
    VisitRecords(chunk->records, static_cast<std::uint64_t>(chunk->records.data() - file_.data()));
  }

  void VisitDataEnd(const RawRecord& record) {
    Cursor in(record.body);
    const std::uint32_t crc = in.U32();
    if (!in.ok()) return Damaged(record.offset, "a damaged end of the data");
    data_ended_ = true;
    if (crc != 0 && crc != Crc32(0, file_.substr(0, record.offset))) {
      Problem(record.offset, "the CRC of the data is wrong");
    }
  }

  void VisitFooter(const RawRecord& record) {
    const std::optional<Footer> footer = DecodeFooter(record.body);
    if (!footer || footer->summary_start > record.offset) {
      return Damaged(record.offset, "a damaged footer");
    }
    if (!data_ended_) Problem(record.offset, "the mark at the end of the data is missing");
    if (footer->summary_crc == 0) return;
    // From the summary's start, or from the footer when there is none, to before the CRC.
    const std::uint64_t start = footer->summary_start == 0 ? record.offset : footer->summary_start;
    const std::uint64_t stop = record.offset + kRecordHeadBytes + 16;
    if (footer->summary_crc != Crc32(0, file_.substr(start, stop - start))) {
      Problem(record.offset, "the CRC of the summary is wrong");
    }
  }

  std::string_view file_;
  const Visitor& visitor_;
  WalkMode mode_;
  WalkEnd end_;
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

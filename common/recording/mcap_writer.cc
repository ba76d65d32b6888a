#include "common/recording/mcap_writer.h"

#include <algorithm>
#include <utility>

#include "common/base/result.h"
#include "common/recording/mcap_records.h"

namespace footing::mcap {
namespace {

constexpr std::size_t kMostIds = 65'535;

/// Appends one group of the summary and notes where it lies.
template <typename Records, typename Get>
void AppendGroup(Opcode opcode, std::uint64_t base, const Records& records, Get get,
                 std::string& summary, std::vector<SummaryOffset>& offsets) {
  const std::size_t start = summary.size();
  for (const auto& record : records) Encode(get(record), summary);
  if (summary.size() == start) return;
  offsets.push_back({static_cast<std::uint8_t>(opcode), base + start, summary.size() - start});
}

}  // namespace

Writer::Writer(const Header& header, WriterOptions options) : options_(options) {
  Emit(std::string(kMagic));
  std::string record;
  Encode(header, record);
  Emit(record);
}

std::uint16_t Writer::AddSchema(const std::string& name, const std::string& encoding,
                                const std::string& data) {
  FOOTING_CHECK(schemas_.size() < kMostIds);
  const auto id = static_cast<std::uint16_t>(schemas_.empty() ? 1 : schemas_.rbegin()->first + 1);
  CopySchema({id, name, encoding, data});
  return id;
}

std::uint16_t Writer::AddChannel(std::uint16_t schema_id, const std::string& topic,
                                 const std::string& message_encoding, const TextMap& metadata) {
  FOOTING_CHECK(channels_.size() < kMostIds);
  const auto id = static_cast<std::uint16_t>(channels_.empty() ? 1 : channels_.rbegin()->first + 1);
  CopyChannel({id, schema_id, topic, message_encoding, metadata});
  return id;
}

void Writer::CopySchema(const Schema& schema) {
  FOOTING_CHECK(schema.id != 0);
  if (!schemas_.emplace(schema.id, schema).second) return;
  Encode(schema, chunk_);
}

void Writer::CopyChannel(const Channel& channel) {
  FOOTING_CHECK(channel.schema_id == 0 || schemas_.count(channel.schema_id) == 1);
  if (!channels_.emplace(channel.id, channel).second) return;
  Encode(channel, chunk_);
}

void Writer::Add(const Message& message) {
  FOOTING_CHECK(!finished_ && channels_.count(message.channel_id) == 1);
  const std::uint64_t time = message.log_time_ns;
  if (chunk_messages_ == 0) chunk_start_ns_ = chunk_end_ns_ = time;
  MessageIndex& index = chunk_index_[message.channel_id];
  index.channel_id = message.channel_id;
  index.entries.push_back({time, chunk_.size()});
  Encode(message, chunk_);
  ++chunk_messages_;
  chunk_start_ns_ = std::min(chunk_start_ns_, time);
  chunk_end_ns_ = std::max(chunk_end_ns_, time);

  if (statistics_.message_count == 0) statistics_.message_start_time_ns = time;
  statistics_.message_start_time_ns = std::min(statistics_.message_start_time_ns, time);
  statistics_.message_end_time_ns = std::max(statistics_.message_end_time_ns, time);
  ++statistics_.message_count;
  ++statistics_.channel_message_counts[message.channel_id];
  if (chunk_.size() >= options_.chunk_bytes ||
      chunk_end_ns_ - chunk_start_ns_ >= options_.chunk_span_ns) {
    FlushChunk();
  }
}

void Writer::Add(const Attachment& attachment) {
  FOOTING_CHECK(!finished_);
  std::string record;
  Encode(attachment, record);
  attachments_.push_back({offset_, record.size(), attachment.log_time_ns, attachment.create_time_ns,
                          attachment.data.size(), attachment.name, attachment.media_type});
  Emit(record);
}

void Writer::Add(const Metadata& metadata) {
  FOOTING_CHECK(!finished_);
  std::string record;
  Encode(metadata, record);
  metadata_.push_back({offset_, record.size(), metadata.name});
  Emit(record);
}

void Writer::FlushChunk() {
  if (chunk_messages_ == 0) return;
  const std::string records = std::exchange(chunk_, {});
  const std::string packed = options_.compress ? Compress(records) : std::string();
  const std::string_view stored = options_.compress ? std::string_view(packed) : records;
  const std::string compression(options_.compress ? kZstd : "");
  ChunkIndex index{chunk_start_ns_, chunk_end_ns_, offset_,       0, {}, 0,
                   compression,     stored.size(), records.size()};
  std::string bytes;
  Encode(
      Chunk{chunk_start_ns_, chunk_end_ns_, records.size(), Crc32(0, records), compression, stored},
      bytes);
  index.chunk_length = bytes.size();
  for (const auto& [channel, messages] : chunk_index_) {
    index.message_index_offsets[channel] = offset_ + bytes.size();
    Encode(messages, bytes);
  }
  index.message_index_length = bytes.size() - index.chunk_length;
  Emit(bytes);
  chunks_.push_back(std::move(index));
  chunk_index_.clear();
  chunk_messages_ = 0;
}

void Writer::Finish() {
  FOOTING_CHECK(!finished_);
  FlushChunk();
  std::string record;
  EncodeDataEnd(data_crc_, record);
  Emit(record);
  EmitSummary();
  finished_ = true;
}

void Writer::EmitSummary() {
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
  statistics_.attachment_count = static_cast<std::uint32_t>(attachments_.size());
  statistics_.metadata_count = static_cast<std::uint32_t>(metadata_.size());
  statistics_.chunk_count = static_cast<std::uint32_t>(chunks_.size());

  std::string summary;
  std::vector<SummaryOffset> offsets;
  const auto value = [](const auto& entry) -> const auto& { return entry.second; };
  const auto same = [](const auto& entry) -> const auto& { return entry; };
  AppendGroup(Opcode::kSchema, offset_, schemas_, value, summary, offsets);
  AppendGroup(Opcode::kChannel, offset_, channels_, value, summary, offsets);
  AppendGroup(Opcode::kStatistics, offset_, std::vector{statistics_}, same, summary, offsets);
  AppendGroup(Opcode::kChunkIndex, offset_, chunks_, same, summary, offsets);
  AppendGroup(Opcode::kAttachmentIndex, offset_, attachments_, same, summary, offsets);
  AppendGroup(Opcode::kMetadataIndex, offset_, metadata_, same, summary, offsets);

  const Footer footer{offset_, offset_ + summary.size(), 0};
  for (const SummaryOffset& offset : offsets) Encode(offset, summary);
  std::string end;
  EncodeFooter(footer, summary, end);
  Emit(summary + end + std::string(kMagic));
}

void Writer::Emit(const std::string& record) {
  data_crc_ = Crc32(data_crc_, record);
  offset_ += record.size();
  out_ += record;
}

std::string Writer::Take() { return std::exchange(out_, {}); }

}  // namespace footing::mcap

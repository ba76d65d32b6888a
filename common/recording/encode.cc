#include "common/recording/encode.h"

#include <concepts>

#include "common/recording/crc.h"

namespace footing::mcap {
namespace {

template <std::unsigned_integral T>
void Put(T value, std::string& out) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out.push_back(static_cast<char>((value >> (8 * i)) & 0xFF));
  }
}

void PutText(std::string_view text, std::string& out) {
  Put(static_cast<std::uint32_t>(text.size()), out);
  out.append(text);
}

/// Overwrites the length field of `bytes` at `at` with the number of bytes behind it.
template <std::unsigned_integral T>
void CloseLength(std::size_t at, std::string& out) {
  const auto length = static_cast<T>(out.size() - at - sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    out[at + i] = static_cast<char>((length >> (8 * i)) & 0xFF);
  }
}

void PutMap(const TextMap& map, std::string& out) {
  const std::size_t at = out.size();
  Put(std::uint32_t{0}, out);
  for (const auto& [key, value] : map) {
    PutText(key, out);
    PutText(value, out);
  }
  CloseLength<std::uint32_t>(at, out);
}

void PutMap(const std::map<std::uint16_t, std::uint64_t>& map, std::string& out) {
  Put(static_cast<std::uint32_t>(map.size() * 10), out);
  for (const auto& [key, value] : map) {
    Put(key, out);
    Put(value, out);
  }
}

/// The head of a record whose length is filled in when this goes out of scope.
class Record {
 public:
  Record(Opcode opcode, std::string& out) : out_(out), at_(out.size() + 1) {
    Put(static_cast<std::uint8_t>(opcode), out);
    Put(std::uint64_t{0}, out);
  }
  ~Record() { CloseLength<std::uint64_t>(at_, out_); }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;

 private:
  std::string& out_;
  std::size_t at_;
};

}  // namespace

void Encode(const Header& record, std::string& out) {
  const Record head(Opcode::kHeader, out);
  PutText(record.profile, out);
  PutText(record.library, out);
}

void Encode(const Schema& record, std::string& out) {
  const Record head(Opcode::kSchema, out);
  Put(record.id, out);
  PutText(record.name, out);
  PutText(record.encoding, out);
  PutText(record.data, out);
}

void Encode(const Channel& record, std::string& out) {
  const Record head(Opcode::kChannel, out);
  Put(record.id, out);
  Put(record.schema_id, out);
  PutText(record.topic, out);
  PutText(record.message_encoding, out);
  PutMap(record.metadata, out);
}

void Encode(const Message& record, std::string& out) {
  const Record head(Opcode::kMessage, out);
  Put(record.channel_id, out);
  Put(record.sequence, out);
  Put(record.log_time_ns, out);
  Put(record.publish_time_ns, out);
  out.append(record.data);
}

void Encode(const Chunk& record, std::string& out) {
  const Record head(Opcode::kChunk, out);
  Put(record.start_time_ns, out);
  Put(record.end_time_ns, out);
  Put(record.uncompressed_size, out);
  Put(record.uncompressed_crc, out);
  PutText(record.compression, out);
  Put(static_cast<std::uint64_t>(record.records.size()), out);
  out.append(record.records);
}

void Encode(const MessageIndex& record, std::string& out) {
  const Record head(Opcode::kMessageIndex, out);
  Put(record.channel_id, out);
  Put(static_cast<std::uint32_t>(record.entries.size() * 16), out);
  for (const MessageIndex::Entry& entry : record.entries) {
    Put(entry.log_time_ns, out);
    Put(entry.offset, out);
  }
}

void Encode(const ChunkIndex& record, std::string& out) {
  const Record head(Opcode::kChunkIndex, out);
  Put(record.start_time_ns, out);
  Put(record.end_time_ns, out);
  Put(record.chunk_offset, out);
  Put(record.chunk_length, out);
  PutMap(record.message_index_offsets, out);
  Put(record.message_index_length, out);
  PutText(record.compression, out);
  Put(record.compressed_size, out);
  Put(record.uncompressed_size, out);
}

void Encode(const Attachment& record, std::string& out) {
  const Record head(Opcode::kAttachment, out);
  const std::size_t body = out.size();
  Put(record.log_time_ns, out);
  Put(record.create_time_ns, out);
  PutText(record.name, out);
  PutText(record.media_type, out);
  Put(static_cast<std::uint64_t>(record.data.size()), out);
  out.append(record.data);
  Put(Crc32(0, std::string_view(out).substr(body)), out);
}

void Encode(const AttachmentIndex& record, std::string& out) {
  const Record head(Opcode::kAttachmentIndex, out);
  Put(record.offset, out);
  Put(record.length, out);
  Put(record.log_time_ns, out);
  Put(record.create_time_ns, out);
  Put(record.data_size, out);
  PutText(record.name, out);
  PutText(record.media_type, out);
}

void Encode(const Metadata& record, std::string& out) {
  const Record head(Opcode::kMetadata, out);
  PutText(record.name, out);
  PutMap(record.values, out);
}

void Encode(const MetadataIndex& record, std::string& out) {
  const Record head(Opcode::kMetadataIndex, out);
  Put(record.offset, out);
  Put(record.length, out);
  PutText(record.name, out);
}

void Encode(const Statistics& record, std::string& out) {
  const Record head(Opcode::kStatistics, out);
  Put(record.message_count, out);
  Put(record.schema_count, out);
  Put(record.channel_count, out);
  Put(record.attachment_count, out);
  Put(record.metadata_count, out);
  Put(record.chunk_count, out);
  Put(record.message_start_time_ns, out);
  Put(record.message_end_time_ns, out);
  PutMap(record.channel_message_counts, out);
}

void Encode(const SummaryOffset& record, std::string& out) {
  const Record head(Opcode::kSummaryOffset, out);
  Put(record.group_opcode, out);
  Put(record.group_start, out);
  Put(record.group_length, out);
}

void EncodeFooter(const Footer& record, std::string_view summary, std::string& out) {
  std::string covered;  // Opcode, length and the two offsets stand under the CRC too.
  Put(static_cast<std::uint8_t>(Opcode::kFooter), covered);
  Put(std::uint64_t{20}, covered);
  Put(record.summary_start, covered);
  Put(record.summary_offset_start, covered);
  const std::uint32_t crc = Crc32(Crc32(0, summary), covered);
  out.append(covered);
  Put(crc, out);
}

void EncodeDataEnd(std::uint32_t data_section_crc, std::string& out) {
  const Record head(Opcode::kDataEnd, out);
  Put(data_section_crc, out);
}

}  // namespace footing::mcap

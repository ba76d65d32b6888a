#include "common/recording/mcap_records.h"

#include <concepts>
#include <optional>

#include <zlib.h>
#include <zstd.h>

#include "common/base/result.h"

namespace footing::mcap {

std::string TextOf(const TextMap& values, const std::string& key) {
  const auto found = values.find(key);
  return found == values.end() ? "" : found->second;
}

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

namespace {

template <typename T>
std::optional<T> IfOk(const Cursor& cursor, T record) {
  if (!cursor.ok()) return std::nullopt;
  return record;
}

}  // namespace

std::uint64_t Cursor::Little(std::size_t count) {
  const std::string_view bytes = Bytes(count);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
  }
  return value;
}

std::string_view Cursor::Bytes(std::uint64_t count) {
  if (!ok_ || count > bytes_.size()) {
    ok_ = false;
    return {};
  }
  const std::string_view taken = bytes_.substr(0, count);
  bytes_.remove_prefix(count);
  return taken;
}

TextMap Cursor::Map() {
  Cursor entries(Text());
  TextMap map;
  while (ok_ && !entries.bytes_.empty()) {
    std::string key(entries.Text());
    std::string value(entries.Text());
    ok_ = entries.ok_;
    if (ok_) map.emplace(std::move(key), std::move(value));
  }
  return map;
}

std::map<std::uint16_t, std::uint64_t> Cursor::CountMap() {
  Cursor entries(Text());
  std::map<std::uint16_t, std::uint64_t> map;
  while (ok_ && !entries.bytes_.empty()) {
    const std::uint16_t key = entries.U16();
    const std::uint64_t value = entries.U64();
    ok_ = entries.ok_;
    if (ok_) map.emplace(key, value);
  }
  return map;
}

// Braced initialisation evaluates from left to right, in the order of the fields in the file.

std::optional<Header> DecodeHeader(std::string_view body) {
  Cursor in(body);
  return IfOk(in, Header{std::string(in.Text()), std::string(in.Text())});
}

std::optional<Schema> DecodeSchema(std::string_view body) {
  Cursor in(body);
  return IfOk(
      in, Schema{in.U16(), std::string(in.Text()), std::string(in.Text()), std::string(in.Text())});
}

std::optional<Channel> DecodeChannel(std::string_view body) {
  Cursor in(body);
  return IfOk(
      in, Channel{in.U16(), in.U16(), std::string(in.Text()), std::string(in.Text()), in.Map()});
}

std::optional<Message> DecodeMessage(std::string_view body) {
  Cursor in(body);
  Message message{in.U16(), in.U32(), in.U64(), in.U64(), {}};
  message.data = in.rest();
  return IfOk(in, message);
}

std::optional<Chunk> DecodeChunk(std::string_view body, bool cut) {
  Cursor in(body);
  Chunk chunk{in.U64(), in.U64(), in.U64(), in.U32(), std::string(in.Text()), {}};
  const std::uint64_t size = in.U64();
  if (!in.ok()) return std::nullopt;
  chunk.records = cut && size > in.rest().size() ? in.rest() : in.Bytes(size);
  return IfOk(in, std::move(chunk));
}

std::optional<MessageIndex> DecodeMessageIndex(std::string_view body) {
  Cursor in(body);
  MessageIndex index{in.U16(), {}};
  Cursor entries(in.Text());
  while (in.ok() && !entries.rest().empty()) {
    const MessageIndex::Entry entry{entries.U64(), entries.U64()};
    if (!entries.ok()) return std::nullopt;
    index.entries.push_back(entry);
  }
  return IfOk(in, std::move(index));
}

std::optional<ChunkIndex> DecodeChunkIndex(std::string_view body) {
  Cursor in(body);
  return IfOk(in, ChunkIndex{in.U64(), in.U64(), in.U64(), in.U64(), in.CountMap(), in.U64(),
                             std::string(in.Text()), in.U64(), in.U64()});
}

std::optional<Attachment> DecodeAttachment(std::string_view body) {
  Cursor in(body);
  Attachment attachment{in.U64(), in.U64(), std::string(in.Text()), std::string(in.Text()),
                        in.Bytes(in.U64())};
  const std::string_view covered = body.substr(0, body.size() - in.rest().size());
  const std::uint32_t crc = in.U32();
  if (!in.ok() || (crc != 0 && crc != Crc32(0, covered))) return std::nullopt;
  return attachment;
}

std::optional<AttachmentIndex> DecodeAttachmentIndex(std::string_view body) {
  Cursor in(body);
  return IfOk(in, AttachmentIndex{in.U64(), in.U64(), in.U64(), in.U64(), in.U64(),
                                  std::string(in.Text()), std::string(in.Text())});
}

std::optional<Metadata> DecodeMetadata(std::string_view body) {
  Cursor in(body);
  return IfOk(in, Metadata{std::string(in.Text()), in.Map()});
}

std::optional<MetadataIndex> DecodeMetadataIndex(std::string_view body) {
  Cursor in(body);
  return IfOk(in, MetadataIndex{in.U64(), in.U64(), std::string(in.Text())});
}

std::optional<Statistics> DecodeStatistics(std::string_view body) {
  Cursor in(body);
  return IfOk(in, Statistics{in.U64(), in.U16(), in.U32(), in.U32(), in.U32(), in.U32(), in.U64(),
                             in.U64(), in.CountMap()});
}

std::optional<Footer> DecodeFooter(std::string_view body) {
  Cursor in(body);
  return IfOk(in, Footer{in.U64(), in.U64(), in.U32()});
}

std::uint32_t Crc32(std::uint32_t so_far, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::optional<Chunk> Unpack(Chunk chunk, std::string& unpacked) {
  if (chunk.compression != kZstd) return chunk;
  // A frame that states another size is refused before memory is taken by what the chunk says.
  const std::uint64_t size = chunk.uncompressed_size;
  if (size > kMostUnpackedBytes ||
      ZSTD_getFrameContentSize(chunk.records.data(), chunk.records.size()) != size) {
    return std::nullopt;
  }
  unpacked.resize(size);
  const std::size_t made =
      ZSTD_decompress(unpacked.data(), size, chunk.records.data(), chunk.records.size());
  if (ZSTD_isError(made) != 0 || made != size) return std::nullopt;
  chunk.records = unpacked;
  chunk.compression.clear();
  return chunk;
}

std::string Compress(std::string_view records) {
  constexpr int kLevel = 1;  // A higher one costs more time than it saves bytes.
  std::string packed(ZSTD_compressBound(records.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), kLevel);
  FOOTING_CHECK(ZSTD_isError(size) == 0);
  packed.resize(size);
  return packed;
}

std::string ProblemOf(const std::optional<Chunk>& chunk) {
  if (!chunk) return "a damaged chunk";
  if (!chunk->compression.empty()) {
    return "a chunk compressed by " + chunk->compression + ", which is not read here";
  }
  if (chunk->uncompressed_size != chunk->records.size()) return "a chunk whose two sizes differ";
  const bool wrong =
      chunk->uncompressed_crc != 0 && chunk->uncompressed_crc != Crc32(0, chunk->records);
  return wrong ? "a chunk whose CRC is wrong" : "";
}

Closing CheckDataEnd(std::string_view file, std::string_view body, std::uint64_t offset) {
  Cursor in(body);
  const std::uint32_t crc = in.U32();
  if (!in.ok()) return {"a damaged end of the data", ""};
  const bool wrong = crc != 0 && crc != Crc32(0, file.substr(0, offset));
  return {"", wrong ? "the CRC of the data is wrong" : ""};
}

Closing CheckFooter(std::string_view file, std::string_view body, std::uint64_t offset,
                    bool data_ended) {
  const std::optional<Footer> footer = DecodeFooter(body);
  if (!footer || footer->summary_start > offset) return {"a damaged footer", ""};
  if (!data_ended) return {"", "the mark at the end of the data is missing"};
  if (footer->summary_crc == 0) return {};
  // From the summary's start, or from the footer when there is none, to before the CRC.
  const std::uint64_t start = footer->summary_start == 0 ? offset : footer->summary_start;
  const std::uint64_t stop = offset + kRecordHeadBytes + 16;
  const bool wrong = footer->summary_crc != Crc32(0, file.substr(start, stop - start));
  return {"", wrong ? "the CRC of the summary is wrong" : ""};
}

std::optional<FoundRecord> FirstRecord(std::string_view bytes) {
  Cursor head(bytes);
  const auto opcode = static_cast<Opcode>(head.U8());
  const std::string_view body = head.Bytes(head.U64());
  if (!head.ok()) return std::nullopt;
  return FoundRecord{opcode, body};
}

std::optional<FoundRecord> RecordAt(std::string_view bytes, std::uint64_t offset) {
  if (offset > bytes.size()) return std::nullopt;
  return FirstRecord(bytes.substr(offset));
}

}  // namespace footing::mcap

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The records of an MCAP file (https://mcap.dev/spec, version 0), as plain values.
///
/// Bytes are std::string and std::string_view, as protobuf holds them. Times are nanoseconds; in a
/// Footing recording they are CLOCK_MONOTONIC of the server's host. Offsets count from the start of
/// the file unless a comment says otherwise.
namespace footing::mcap {

/// The eight bytes at both ends of a file.
inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

/// True for a file that may be cut anywhere but begins as an MCAP file does.
constexpr bool BeginsAsMcap(std::string_view file) {
  const std::string_view begin = file.substr(0, kMagic.size());
  return !begin.empty() && begin == kMagic.substr(0, begin.size());
}

/// Opcode (u8) and length (u64) before every record's body.
inline constexpr std::size_t kRecordHeadBytes = 9;

/// Kind of a record, the first byte of its head.
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

using TextMap = std::map<std::string, std::string>;
/// The value of a key; empty where there is none.
std::string TextOf(const TextMap& values, const std::string& key);

/// First record of a file.
struct Header {
  std::string profile;
  std::string library;  ///< Name and version of the writer.
};

/// Definition of a message type.
struct Schema {
  std::uint16_t id = 0;  ///< From 1.
  std::string name;      ///< Full name of the message, e.g. "footing.v1.MotionSamples".
  std::string encoding;  ///< "protobuf".
  std::string data;      ///< A serialised FileDescriptorSet with all imports.
  bool operator==(const Schema&) const = default;
};

/// A stream of messages of one type under one topic.
struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic;
  std::string message_encoding;  ///< "protobuf".
  TextMap metadata;
  bool operator==(const Channel&) const = default;
};

/// One message of a channel.
struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  std::string_view data;  ///< Borrowed.
};

/// A file within the file.
struct Attachment {
  std::uint64_t log_time_ns = 0;
  std::uint64_t create_time_ns = 0;
  std::string name;
  std::string media_type;
  std::string_view data;  ///< Borrowed.
};

/// Named texts.
struct Metadata {
  std::string name;
  TextMap values;
};

/// Messages, schemas and channels that are packed together.
struct Chunk {
  std::uint64_t start_time_ns = 0;
  std::uint64_t end_time_ns = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: not given.
  std::string compression;             ///< Empty: none; kZstd; others are not read here.
  std::string_view records;            ///< Borrowed.
};

/// Compression of a chunk by zstd, as one frame.
inline constexpr std::string_view kZstd = "zstd";
/// A chunk that would take more bytes unpacked is damaged.
inline constexpr std::uint64_t kMostUnpackedBytes = std::uint64_t{256} << 20;

/// Where the messages of one channel lie within the records of the chunk before it.
struct MessageIndex {
  struct Entry {
    std::uint64_t log_time_ns = 0;
    std::uint64_t offset = 0;
  };
  std::uint16_t channel_id = 0;
  std::vector<Entry> entries;
};

/// Place and times of a chunk, in the summary.
struct ChunkIndex {
  std::uint64_t start_time_ns = 0;
  std::uint64_t end_time_ns = 0;
  std::uint64_t chunk_offset = 0;
  std::uint64_t chunk_length = 0;  ///< With its head.
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

/// Place of an attachment, in the summary.
struct AttachmentIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t create_time_ns = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

/// Place of a metadata record, in the summary.
struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::string name;
};

/// Counts and times of the whole file, in the summary.
struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint64_t message_start_time_ns = 0;
  std::uint64_t message_end_time_ns = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};

/// Where the summary's records of one kind lie.
struct SummaryOffset {
  std::uint8_t group_opcode = 0;
  std::uint64_t group_start = 0;
  std::uint64_t group_length = 0;
};

/// Last record of a file: the place of the summary.
struct Footer {
  std::uint64_t summary_start = 0;         ///< 0: there is no summary.
  std::uint64_t summary_offset_start = 0;  ///< 0: there are no summary offsets.
  std::uint32_t summary_crc = 0;           ///< 0: not given.
};

/// Values to record bytes. Each appends one whole record, head included.
void Encode(const Header& record, std::string& out);
void Encode(const Schema& record, std::string& out);
void Encode(const Channel& record, std::string& out);
void Encode(const Message& record, std::string& out);
void Encode(const Chunk& record, std::string& out);
void Encode(const MessageIndex& record, std::string& out);
void Encode(const ChunkIndex& record, std::string& out);
/// Appends the CRC-32 of its fields too.
void Encode(const Attachment& record, std::string& out);
void Encode(const AttachmentIndex& record, std::string& out);
void Encode(const Metadata& record, std::string& out);
void Encode(const MetadataIndex& record, std::string& out);
void Encode(const Statistics& record, std::string& out);
void Encode(const SummaryOffset& record, std::string& out);
/// `summary` is the file's bytes from the summary's start to here: the footer's CRC covers them and
/// its own first fields, so the record's own summary_crc is not looked at.
void EncodeFooter(const Footer& record, std::string_view summary, std::string& out);
void EncodeDataEnd(std::uint32_t data_section_crc, std::string& out);

// Record bodies to values. Every length is checked against the bytes that are there before
// anything is made of it; nothing when a body is too short for what it says. Bytes behind the
// known fields are allowed, as the specification asks.

/// Reads little-endian fields; once something goes past the end it stays not ok and gives zeros.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t U8() { return static_cast<std::uint8_t>(Little(1)); }
  std::uint16_t U16() { return static_cast<std::uint16_t>(Little(2)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Little(4)); }
  std::uint64_t U64() { return Little(8); }
  /// u32 length and that many bytes.
  std::string_view Text() { return Bytes(U32()); }
  std::string_view Bytes(std::uint64_t count);
  TextMap Map();
  std::map<std::uint16_t, std::uint64_t> CountMap();

  std::string_view rest() const { return bytes_; }
  bool ok() const { return ok_; }

 private:
  std::uint64_t Little(std::size_t count);

  std::string_view bytes_;
  bool ok_ = true;
};

/// Record bytes, without the head, to values; nothing when they are damaged.
std::optional<Header> DecodeHeader(std::string_view body);
std::optional<Schema> DecodeSchema(std::string_view body);
std::optional<Channel> DecodeChannel(std::string_view body);
std::optional<Message> DecodeMessage(std::string_view body);
/// `cut`: a chunk at the file's end may hold fewer records than it says.
std::optional<Chunk> DecodeChunk(std::string_view body, bool cut = false);
/// The chunk as it was before it was compressed by zstd: its records are put into `unpacked`, which
/// it borrows, and it has no compression. Any other chunk is as it was. Nothing where its bytes are
/// damaged or do not have the size that it says.
std::optional<Chunk> Unpack(Chunk chunk, std::string& unpacked);
/// The records compressed by zstd.
std::string Compress(std::string_view records);
std::optional<MessageIndex> DecodeMessageIndex(std::string_view body);
std::optional<ChunkIndex> DecodeChunkIndex(std::string_view body);
/// Nothing also when its CRC is wrong.
std::optional<Attachment> DecodeAttachment(std::string_view body);
std::optional<AttachmentIndex> DecodeAttachmentIndex(std::string_view body);
std::optional<Metadata> DecodeMetadata(std::string_view body);
std::optional<MetadataIndex> DecodeMetadataIndex(std::string_view body);
std::optional<Statistics> DecodeStatistics(std::string_view body);
std::optional<Footer> DecodeFooter(std::string_view body);

/// CRC-32 (IEEE 802.3, as zlib's) of the bytes so far and `bytes` behind them; start with 0.
std::uint32_t Crc32(std::uint32_t so_far, std::string_view bytes);

/// Problem of a chunk as it was decoded; empty when its records can be read.
std::string ProblemOf(const std::optional<Chunk>& chunk);

/// Problem of a record at the end of a file: of the record itself, or what it says of the file.
struct Closing {
  std::string damage;
  std::string problem;
};

/// The end of the data and the footer, whose bodies are `body` and whose heads stand at `offset`.
Closing CheckDataEnd(std::string_view file, std::string_view body, std::uint64_t offset);
Closing CheckFooter(std::string_view file, std::string_view body, std::uint64_t offset,
                    bool data_ended);

/// A record found in the bytes of a file.
struct FoundRecord {
  Opcode opcode{};
  std::string_view body;  ///< Borrowed.
};

/// The record at the start of the bytes, or at an offset of them; nothing when it does not fit.
std::optional<FoundRecord> FirstRecord(std::string_view bytes);
std::optional<FoundRecord> RecordAt(std::string_view bytes, std::uint64_t offset);

}  // namespace footing::mcap

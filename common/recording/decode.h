#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/recording/records.h"

/// Record bodies to values. Every length is checked against the bytes that are there before
/// anything is made of it; nothing when a body is too short for what it says. Bytes behind the
/// known fields are allowed, as the specification asks.
namespace footing::mcap {

/// Reads little-endian fields; once something goes past the end it stays not ok and gives zeros.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t U8() { return static_cast<std::uint8_t>(Little(1)); }
  std::uint16_t U16() { return static_cast<std::uint16_t>(Little(2)); }
  std::uint32_t U32() { return static_cast<std::uint32_t>(Little(4)); }
  std::uint64_t U64() { return Little(8); }
  /// u32 length and that many bytes.
  std::string_view Text() { return Take(U32()); }
  std::string_view Take(std::uint64_t count);
  TextMap Map();
  std::map<std::uint16_t, std::uint64_t> CountMap();

  std::string_view rest() const { return bytes_; }
  bool ok() const { return ok_; }

 private:
  std::uint64_t Little(std::size_t count);

  std::string_view bytes_;
  bool ok_ = true;
};

std::optional<Header> DecodeHeader(std::string_view body);
std::optional<Schema> DecodeSchema(std::string_view body);
std::optional<Channel> DecodeChannel(std::string_view body);
std::optional<Message> DecodeMessage(std::string_view body);
/// `cut`: a chunk at the file's end may hold fewer records than it says.
std::optional<Chunk> DecodeChunk(std::string_view body, bool cut = false);
std::optional<MessageIndex> DecodeMessageIndex(std::string_view body);
std::optional<ChunkIndex> DecodeChunkIndex(std::string_view body);
/// Nothing also when its CRC is wrong.
std::optional<Attachment> DecodeAttachment(std::string_view body);
std::optional<AttachmentIndex> DecodeAttachmentIndex(std::string_view body);
std::optional<Metadata> DecodeMetadata(std::string_view body);
std::optional<MetadataIndex> DecodeMetadataIndex(std::string_view body);
std::optional<Statistics> DecodeStatistics(std::string_view body);
std::optional<Footer> DecodeFooter(std::string_view body);

}  // namespace footing::mcap

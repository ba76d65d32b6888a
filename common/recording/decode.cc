#include "common/recording/decode.h"

#include "common/recording/crc.h"

namespace footing::mcap {
namespace {

template <typename T>
std::optional<T> IfOk(const Cursor& cursor, T record) {
  if (!cursor.ok()) return std::nullopt;
  return record;
}

}  // namespace

std::uint64_t Cursor::Little(std::size_t count) {
  const std::string_view bytes = Take(count);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
  }
  return value;
}

std::string_view Cursor::Take(std::uint64_t count) {
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
  chunk.records = cut && size > in.rest().size() ? in.rest() : in.Take(size);
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
                        in.Take(in.U64())};
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

}  // namespace footing::mcap

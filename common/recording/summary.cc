#include "common/recording/summary.h"

#include <optional>

#include "common/recording/crc.h"
#include "common/recording/decode.h"
#include "common/recording/seek.h"

namespace footing::mcap {
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
  const std::string_view body = head.Take(head.U64());
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
    const std::string_view record = head.Take(head.U64());
    if (!head.ok() || !Take(opcode, record, summary)) {
      return At(start + offset, "a damaged record of the summary");
    }
    offset += kRecordHeadBytes + record.size();
  }
  return summary;
}

Result<void> VisitMessages(std::string_view file, const Summary& summary, std::uint64_t start_ns,
                           std::uint64_t end_ns,
                           const std::function<void(const Message&)>& handler) {
  for (const ChunkIndex& index : summary.chunks) {
    if (index.end_time_ns < start_ns || index.start_time_ns >= end_ns) continue;
    if (Result<void> checked = CheckChunk(file, index); !checked) return checked;
    const Result<void> visited = VisitChunk(file, index, [&](const Message& message) {
      if (message.log_time_ns >= start_ns && message.log_time_ns < end_ns) handler(message);
    });
    if (!visited) return visited;
  }
  return {};
}

}  // namespace footing::mcap

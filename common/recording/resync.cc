#include "common/recording/resync.h"

#include "common/recording/checks.h"
#include "common/recording/decode.h"
#include "common/recording/found_record.h"

namespace footing::mcap {
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
    const auto chunk = record ? DecodeChunk(record->body) : std::nullopt;
    // Without a CRC nothing distinguishes a chunk from other bytes.
    if (!chunk || chunk->uncompressed_crc == 0 || chunk->records.empty() ||
        chunk->uncompressed_size != chunk->records.size()) {
      continue;
    }
    if (chunk->records.size() > budget_) return std::nullopt;
    budget_ -= chunk->records.size();
    if (ProblemOf(chunk).empty()) return at;
  }
  return std::nullopt;
}

}  // namespace footing::mcap

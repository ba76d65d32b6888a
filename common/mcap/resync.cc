#include "common/mcap/resync.h"

#include "common/mcap/crc.h"
#include "common/mcap/decode.h"
#include "common/mcap/records.h"

namespace footing::mcap {
namespace {

constexpr std::uint64_t kBudgetPerByte = 8;

std::optional<std::string_view> BodyAt(std::string_view file, std::uint64_t offset,
                                       std::uint8_t& opcode) {
  if (offset > file.size()) return std::nullopt;
  Cursor head(file.substr(offset));
  opcode = head.U8();
  const std::uint64_t length = head.U64();
  if (!head.ok() || length > head.rest().size()) return std::nullopt;
  return head.rest().substr(0, length);
}

}  // namespace

Resync::Resync(std::string_view file) : file_(file), budget_(kBudgetPerByte * file.size()) {}

std::optional<std::uint64_t> Resync::WayOn(std::uint64_t offset,
                                           std::optional<std::uint64_t> suspect) {
  if (CanBeRecord(offset) && (!suspect || IsRecord(offset))) return std::nullopt;
  return NextChunk(suspect.value_or(offset) + 1);
}

bool Resync::CanBeRecord(std::uint64_t offset) const {
  std::uint8_t opcode = 0;
  return BodyAt(file_, offset, opcode).has_value() && opcode != 0;
}

bool Resync::IsRecord(std::uint64_t offset) const {
  std::uint8_t opcode = 0;
  const auto body = BodyAt(file_, offset, opcode);
  if (!body) return false;
  switch (static_cast<Opcode>(opcode)) {
    case Opcode::kChunk:
      return DecodeChunk(*body).has_value();
    case Opcode::kMessageIndex:
      return DecodeMessageIndex(*body).has_value();
    case Opcode::kMetadata:
      return DecodeMetadata(*body).has_value();
    case Opcode::kAttachment:
      return DecodeAttachment(*body).has_value();
    case Opcode::kDataEnd:
      return body->size() >= sizeof(std::uint32_t);
    default:
      return false;
  }
}

std::optional<std::uint64_t> Resync::NextChunk(std::uint64_t from) {
  constexpr char kChunk = static_cast<char>(Opcode::kChunk);
  for (std::size_t at = file_.find(kChunk, from); at != std::string_view::npos;
       at = file_.find(kChunk, at + 1)) {
    std::uint8_t opcode = 0;
    const auto body = BodyAt(file_, at, opcode);
    const auto chunk = body ? DecodeChunk(*body) : std::nullopt;
    if (!chunk || !chunk->compression.empty() || chunk->uncompressed_crc == 0 ||
        chunk->uncompressed_size != chunk->records.size() || chunk->records.empty()) {
      continue;
    }
    if (chunk->records.size() > budget_) return std::nullopt;
    budget_ -= chunk->records.size();
    if (chunk->uncompressed_crc == Crc32(0, chunk->records)) return at;
  }
  return std::nullopt;
}

}  // namespace footing::mcap

#include "common/recording/found_record.h"

#include "common/recording/decode.h"

namespace footing::mcap {

std::optional<FoundRecord> FirstRecord(std::string_view bytes) {
  Cursor head(bytes);
  const auto opcode = static_cast<Opcode>(head.U8());
  const std::string_view body = head.Take(head.U64());
  if (!head.ok()) return std::nullopt;
  return FoundRecord{opcode, body};
}

std::optional<FoundRecord> RecordAt(std::string_view bytes, std::uint64_t offset) {
  if (offset > bytes.size()) return std::nullopt;
  return FirstRecord(bytes.substr(offset));
}

}  // namespace footing::mcap

#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/recording/records.h"

namespace footing::mcap {

struct FoundRecord {
  Opcode opcode{};
  std::string_view body;  ///< Borrowed.
};

/// The record at the start of the bytes, or at an offset of them; nothing when it does not fit.
std::optional<FoundRecord> FirstRecord(std::string_view bytes);
std::optional<FoundRecord> RecordAt(std::string_view bytes, std::uint64_t offset);

}  // namespace footing::mcap

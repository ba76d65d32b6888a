#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/recording/records.h"

namespace footing::mcap {

/// What is wrong with a chunk as it was decoded; empty when its records can be read.
std::string ProblemOf(const std::optional<Chunk>& chunk);

/// What is wrong with a record at the end of a file: the record itself, or what it says of the
/// file.
struct Closing {
  std::string damage;
  std::string problem;
};

/// The end of the data and the footer, whose bodies are `body` and whose heads stand at `offset`.
Closing CheckDataEnd(std::string_view file, std::string_view body, std::uint64_t offset);
Closing CheckFooter(std::string_view file, std::string_view body, std::uint64_t offset,
                    bool data_ended);

}  // namespace footing::mcap

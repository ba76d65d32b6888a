#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "common/recording/records.h"

namespace footing::mcap {

/// Called for each record, in the order of the file. Empty ones are left out.
struct Visitor {
  std::function<void(const Header&)> header;
  std::function<void(const Schema&)> schema;    ///< Once an id.
  std::function<void(const Channel&)> channel;  ///< Once an id, after its schema.
  std::function<void(const Message&)> message;  ///< After its channel.
  std::function<void(const Attachment&)> attachment;
  std::function<void(const Metadata&)> metadata;
  std::function<void()> damage;  ///< Something is left out here, by its CRC or its form.
};

enum class WalkMode {
  kStrict,   ///< Ends at the first thing wrong.
  kSalvage,  ///< Leaves out what is damaged and takes every complete record of a cut file.
};

/// How a walk ended.
struct WalkEnd {
  bool complete = false;  ///< Closing magic reached, and nothing wrong.
  std::string problem;    ///< The first thing wrong, for a person; empty when nothing is.
  std::uint64_t problem_offset = 0;
  std::uint64_t end_offset = 0;  ///< Behind the last complete record of the outermost level.
  std::uint64_t damaged_chunks = 0;
  std::uint64_t damaged_records = 0;  ///< Left out, not counting those in damaged chunks.
  /// Between records that are lost and the chunk from which the walk went on.
  std::uint64_t skipped_bytes = 0;
  bool cut = false;  ///< The file ends within or before a record it needs.
};

/// Visits everything in the file that `file` holds, from its start, without trusting its index. All
/// lengths, references and CRCs are checked; nothing is allocated by a length read from the file.
WalkEnd Walk(std::string_view file, const Visitor& visitor, WalkMode mode);

}  // namespace footing::mcap

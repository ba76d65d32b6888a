#pragma once

#include <cstddef>
#include <string_view>

namespace footing::text {

/// Bytes of the UTF-8 sequence that begins at `at` (RFC 3629, section 4); 0 if it is not valid.
std::size_t SequenceLength(std::string_view text, std::size_t at);

bool IsUtf8(std::string_view text);

/// UTF-8 without control characters (below U+0020, and U+007F to U+009F): a terminal or a log shows
/// it as it is, in one line.
bool IsPrintable(std::string_view text);

/// Code points of a text, which a terminal shows in as many columns for most scripts; a byte that
/// is not UTF-8 counts as one.
std::size_t Characters(std::string_view text);

}  // namespace footing::text

#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"

/// Lines, words and fields of text files.
namespace footing::text {

/// The lines of a text, one after the other, without their ends (LF or CR LF).
class Lines {
 public:
  /// Without a byte order mark at its beginning, as spreadsheets and editors of Windows write it.
  Lines(std::string_view text, std::string file);

  /// The next line, or nothing at the end.
  std::optional<std::string_view> Next();
  /// The next line that is not blank.
  std::optional<std::string_view> NextFull();
  /// The next line that is not blank and no comment: the first character of a comment is #.
  std::optional<std::string_view> NextRow();

  std::size_t bytes_left() const { return rest_.size(); }
  const std::string& file() const { return file_; }
  /// Number of the line that Next returned last, from 1; 0 before the first.
  std::size_t number() const { return number_; }
  /// "FILE, line N: MESSAGE", of the line that Next returned last.
  Error Fault(const std::string& message) const;

 private:
  std::string_view rest_;
  std::string file_;
  std::size_t number_ = 0;
};

/// Without the blanks around it.
std::string_view Trim(std::string_view text);

/// Words between blanks; fields between separators, trimmed, empty ones included.
std::vector<std::string_view> SplitAtBlanks(std::string_view line);
std::vector<std::string_view> Fields(std::string_view line, char separator);

/// Takes the next word off the front of `line`; empty at its end.
std::string_view PopWord(std::string_view& line);

/// With its ASCII letters in lower case.
std::string Lower(std::string text);

/// Whether both are equal but for the case of ASCII letters.
bool EqualsIgnoringCase(std::string_view a, std::string_view b);

/// `word` in quotes for a message: shortened, controls and what is not UTF-8 as ?.
std::string Quoted(std::string_view word);

/// The texts with `separator` between them: "walk, run, jump". Empty for none.
template <typename Texts>
std::string Joined(const Texts& texts, std::string_view separator = ", ") {
  std::string all;
  bool first = true;
  for (const auto& one : texts) {
    if (!first) all += separator;
    first = false;
    all += one;
  }
  return all;
}

// Numbers from and to text, the same under every locale.

/// A number of this type that is the whole of `word`, as std::from_chars reads it, or nothing. A
/// real one may be infinite or NaN.
template <typename Number>
std::optional<Number> As(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = error == std::errc() && end == word.data() + word.size();
  return whole ? std::optional(number) : std::nullopt;
}

/// A finite number that is the whole of `word`, or nothing.
std::optional<double> ToNumber(std::string_view word);
/// A whole number, not negative, or nothing.
std::optional<std::size_t> ToCount(std::string_view word);

/// With this many decimals; minus zero is zero. `value` must be finite.
std::string Fixed(double value, int decimals);
void AppendFixed(std::string& text, double value, int decimals);

/// The shortest text that reads back as the same number.
std::string Shortest(double value);
void AppendShortest(std::string& text, double value);

/// Bytes of the UTF-8 sequence that begins at `at` (RFC 3629, section 4); 0 if it is not valid.
std::size_t SequenceLength(std::string_view text, std::size_t at);

/// Whether all of the text is well-formed UTF-8.
bool IsUtf8(std::string_view text);

/// UTF-8 without control characters (below U+0020, and U+007F to U+009F): a terminal or a log shows
/// it as it is, in one line.
bool IsPrintable(std::string_view text);

/// Code points of a text, which a terminal shows in as many columns for most scripts; a byte that
/// is not UTF-8 counts as one.
std::size_t Characters(std::string_view text);

/// Message of a JSON library for a person: without the tag "[json.exception.NAME.NUMBER] ".
constexpr std::string_view WithoutTag(std::string_view message) {
  const std::size_t end = message.starts_with('[') ? message.find("] ") : std::string_view::npos;
  return end == std::string_view::npos ? message : message.substr(end + 2);
}

/// The cells of a line of comma-separated values, trimmed. Quotes have no meaning.
std::vector<std::string_view> Cells(std::string_view line);

/// The numbers of a line of comma-separated values: `columns` of them, each within +-1e9, which is
/// beyond any unit here and keeps squares and sums finite. An error says what is wrong, not where.
Result<std::vector<double>> NumberRow(std::string_view line, std::size_t columns);

/// FNV-1a over 64-bit words instead of bytes: a fingerprint of a state. Starts at the basis and
/// takes one word after the other; the same bits give the same hash.
inline constexpr std::uint64_t kFnvBasis = 14695981039346656037u;
constexpr std::uint64_t AddFnv(std::uint64_t hash, std::uint64_t word) {
  return (hash ^ word) * 1099511628211u;
}

/// Nanoseconds of UNIX time as UTC, ISO 8601: 2026-11-22T13:38:48Z; with `decimals` of a second, at
/// most 9: 2026-11-22T13:38:48.123456Z.
std::string Utc(std::int64_t unix_ns, int decimals = 0);

/// The value of this rank, 0 the least; of the greatest rank if there are fewer. There must be one
/// value.
template <typename T>
T OfRank(std::vector<T> values, std::size_t rank) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The value below which this share of the values lies, one of them: rank floor(share * n), so that
/// Quantile(x, 1) is the greatest. 0 if there are none. `share` is in [0, 1].
inline double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return OfRank(std::move(values), rank);
}

/// The greater of the two middle values of an even number of them. 0 if there are none.
inline double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

}  // namespace footing::text

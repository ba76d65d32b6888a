#include "common/base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>

#include "common/base/result.h"

namespace footing::text {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

}  // namespace

Lines::Lines(std::string_view text, std::string file) : rest_(text), file_(std::move(file)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

std::optional<std::string_view> Lines::Next() {
  if (rest_.empty()) return std::nullopt;
  const auto end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return line;
}

std::optional<std::string_view> Lines::NextFull() {
  for (auto line = Next(); line; line = Next()) {
    if (!Trim(*line).empty()) return line;
  }
  return std::nullopt;
}

std::optional<std::string_view> Lines::NextRow() {
  for (auto line = NextFull(); line; line = NextFull()) {
    if (Trim(*line).front() != '#') return line;
  }
  return std::nullopt;
}

Error Lines::Fault(const std::string& message) const {
  return InvalidData(file_ + ", line " + std::to_string(number_) + ": " + message);
}

std::string_view Trim(std::string_view text) {
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string_view PopWord(std::string_view& line) {
  const auto begin = line.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    line = {};
    return {};
  }
  line.remove_prefix(begin);
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> SplitAtBlanks(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = PopWord(line); !word.empty(); word = PopWord(line)) words.push_back(word);
  return words;
}

std::vector<std::string_view> Fields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto end = line.find(separator);
    fields.push_back(Trim(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::tolower(static_cast<unsigned char>(a[i])) !=
        std::tolower(static_cast<unsigned char>(b[i]))) {
      return false;
    }
  }
  return true;
}

std::string Quoted(std::string_view word) {
  constexpr std::size_t kMostCharacters = 40;
  std::string text = "'";
  std::size_t at = 0;
  for (std::size_t n = 0; n < kMostCharacters && at < word.size(); ++n) {
    const std::string_view one = word.substr(at, SequenceLength(word, at));
    // U+0080 to U+009F are controls, which terminals may follow.
    const bool control = one.size() == 2 && one < "\u00a0";
    const bool shown = one.size() == 1 ? std::isprint(static_cast<unsigned char>(one[0])) != 0
                                       : !one.empty() && !control;
    text += shown ? one : "?";
    at += std::max<std::size_t>(1, one.size());
  }
  return text + (at < word.size() ? "...'" : "'");
}

std::optional<double> ToNumber(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  // Smaller than the smallest double: zero, as strtod has it.
  if (code == std::errc::result_out_of_range && word.find("e-") != std::string_view::npos) return 0;
  if (code != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::size_t> ToCount(std::string_view word) { return As<std::size_t>(word); }

void AppendFixed(std::string& text, double value, int decimals) {
  std::array<char, 400> digits;
  const auto [end, code] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                         std::chars_format::fixed, decimals);
  FOOTING_CHECK(code == std::errc());
  std::string_view number(digits.data(), static_cast<std::size_t>(end - digits.data()));
  if (number[0] == '-' && number.find_first_not_of("-0.") == std::string_view::npos) {
    number.remove_prefix(1);
  }
  text += number;
}

std::string Fixed(double value, int decimals) {
  std::string text;
  AppendFixed(text, value, decimals);
  return text;
}

void AppendShortest(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto [end, code] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  FOOTING_CHECK(code == std::errc());
  text.append(digits.data(), end);
}

std::string Shortest(double value) {
  std::string text;
  AppendShortest(text, value);
  return text;
}

std::size_t SequenceLength(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t index) -> std::uint32_t {
    return at + index < text.size() ? static_cast<unsigned char>(text[at + index]) : 0u;
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  std::uint32_t code = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return 0;
    code = (code << 6) | (byte(i) & 0x3fu);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return overlong || surrogate || code > 0x10ffff ? 0 : length;
}

bool IsUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = SequenceLength(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

bool IsPrintable(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = SequenceLength(text, at);
    const std::string_view one = text.substr(at, length);
    const bool control =
        one < " " || (one >= "\x7f" && length == 1) || (length == 2 && one < "\u00a0");
    if (length == 0 || control) return false;
    at += length;
  }
  return true;
}

std::size_t Characters(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); ++count) {
    at += std::max<std::size_t>(1, SequenceLength(text, at));
  }
  return count;
}

namespace {

constexpr double kGreatestInCsv = 1e9;

}  // namespace

std::vector<std::string_view> Cells(std::string_view line) { return Fields(line, ','); }

Result<std::vector<double>> NumberRow(std::string_view line, std::size_t columns) {
  const std::vector<std::string_view> cells = Cells(line);
  std::vector<double> numbers;
  for (const std::string_view cell : cells) {
    const auto number = ToNumber(cell);
    if (!number || !(std::abs(*number) <= kGreatestInCsv)) {
      return InvalidData("not a number within +-1e9: " + Quoted(cell));
    }
    numbers.push_back(*number);
  }
  if (numbers.size() != columns) {
    return InvalidData(std::to_string(cells.size()) + " cells where " + std::to_string(columns) +
                       " belong");
  }
  return numbers;
}

namespace {

constexpr std::size_t kMostDecimals = 9;

/// With zeros in front.
std::string Digits(std::int64_t value, std::size_t count) {
  const std::string digits = std::to_string(value);
  return digits.size() < count ? std::string(count - digits.size(), '0') + digits : digits;
}

}  // namespace

std::string Utc(std::int64_t unix_ns, int decimals) {
  using std::chrono::floor;
  const std::chrono::sys_time<std::chrono::nanoseconds> instant{std::chrono::nanoseconds(unix_ns)};
  const auto day = floor<std::chrono::days>(instant);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(instant - day);
  std::string utc = Digits(static_cast<int>(date.year()), 4) + "-" +
                    Digits(static_cast<unsigned>(date.month()), 2) + "-" +
                    Digits(static_cast<unsigned>(date.day()), 2) + "T" +
                    Digits(time.hours().count(), 2) + ":" + Digits(time.minutes().count(), 2) +
                    ":" + Digits(time.seconds().count(), 2);
  if (decimals > 0) {
    utc += "." + Digits(time.subseconds().count(), kMostDecimals)
                     .substr(0, std::min(static_cast<std::size_t>(decimals), kMostDecimals));
  }
  return utc + "Z";
}

}  // namespace footing::text

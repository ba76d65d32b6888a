#include "common/virtual/motion/text.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

namespace footing::motion {
namespace {

constexpr std::string_view kBlanks = " \t\r\f\v";

}  // namespace

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

Error Lines::Fault(const std::string& message) const {
  return InvalidData(file_ + ", line " + std::to_string(number_) + ": " + message);
}

std::string_view Trim(std::string_view text) {
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::string_view TakeWord(std::string_view& line) {
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

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  for (auto word = TakeWord(line); !word.empty(); word = TakeWord(line)) words.push_back(word);
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

std::optional<std::size_t> ToCount(std::string_view word) {
  std::size_t value = 0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty() || code != std::errc()) return std::nullopt;
  return value;
}

std::string Quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) {
    text += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  }
  return text + (word.size() > 40 ? "...'" : "'");
}

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

}  // namespace footing::motion

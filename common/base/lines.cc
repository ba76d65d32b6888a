#include "common/base/lines.h"

#include <algorithm>
#include <cctype>

#include "common/base/utf8.h"

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

std::vector<std::string_view> SplitAtBlanks(std::string_view line) {
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

}  // namespace footing::text

#include "common/base/number.h"

#include <array>
#include <charconv>
#include <cmath>

#include "common/base/result.h"

namespace footing::text {

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

}  // namespace footing::text

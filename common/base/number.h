#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Numbers from and to text, the same under every locale.
namespace footing::text {

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

}  // namespace footing::text

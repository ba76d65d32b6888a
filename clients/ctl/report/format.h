#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// Small pieces of text for a terminal. No locale.
namespace footing::ctl::display {

/// "1.5"; decimals 0 to 9. What is not finite is "-".
std::string Fixed(double value, int decimals);

/// UNIX time as "2026-11-21 10:15 UTC"; "-" for 0.
std::string Date(std::int64_t wall_time_ns);

/// The first row is the heading. Columns stand two spaces apart, numbers to the right; no blanks at
/// the end of a line.
std::string Table(const std::vector<std::vector<std::string>>& rows);

/// `value` of `full` as `cells` characters of '#' and '.'; clipped to the bar.
std::string Bar(double value, double full, int cells);

/// Bits 0 to 3 as "1010", first lamp first.
std::string Lamps(std::uint32_t leds);

}  // namespace footing::ctl::display

#include "clients/ctl/report/format.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include "common/base/number.h"

namespace footing::ctl::display {
namespace {

std::string TwoDigits(unsigned value) {
  return std::string(value < 10 ? "0" : "") + std::to_string(value);
}

bool IsNumber(const std::string& cell) {
  return cell.find_first_of("0123456789") != std::string::npos &&
         cell.find_first_not_of("0123456789.-% ") == std::string::npos;
}

}  // namespace

std::string Fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  return text::Fixed(value, decimals);
}

std::string Date(std::int64_t wall_time_ns) {
  if (wall_time_ns == 0) return "-";
  const std::chrono::sys_time<std::chrono::nanoseconds> time{
      std::chrono::nanoseconds(wall_time_ns)};
  const auto day = std::chrono::floor<std::chrono::days>(time);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(std::chrono::floor<std::chrono::minutes>(time - day));
  return std::to_string(static_cast<int>(date.year())) + "-" +
         TwoDigits(static_cast<unsigned>(date.month())) + "-" +
         TwoDigits(static_cast<unsigned>(date.day())) + " " +
         TwoDigits(static_cast<unsigned>(clock.hours().count())) + ":" +
         TwoDigits(static_cast<unsigned>(clock.minutes().count())) + " UTC";
}

std::string Table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string blanks(widths[i] - row[i].size(), ' ');
      if (i > 0) line += "  ";
      line += IsNumber(row[i]) ? blanks + row[i] : row[i] + blanks;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string Bar(double value, double full, int cells) {
  const double share = std::isfinite(value) ? std::clamp(value / full, 0.0, 1.0) : 0.0;
  const auto filled = static_cast<std::size_t>(std::lround(share * cells));
  return std::string(filled, '#') + std::string(static_cast<std::size_t>(cells) - filled, '.');
}

std::string Lamps(std::uint32_t leds) {
  std::string text;
  for (unsigned bit = 0; bit < 4; ++bit) text += (leds >> bit & 1u) != 0 ? '1' : '0';
  return text;
}

}  // namespace footing::ctl::display

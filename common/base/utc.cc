#include "common/base/utc.h"

#include <algorithm>
#include <chrono>

namespace footing::text {
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

#include "common/base/csv.h"

#include <cmath>
#include <string>

#include "common/base/lines.h"
#include "common/base/number.h"

namespace footing::text {
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

}  // namespace footing::text

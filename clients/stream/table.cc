#include "clients/stream/table.h"

#include "common/base/csv.h"
#include "common/base/lines.h"
#include "common/base/number.h"

namespace footing::stream_client {

Result<Table> ParseTable(const std::string& text, std::size_t columns, const std::string& origin) {
  Table table;
  text::Lines lines(text, origin);
  bool first = true;
  while (const auto line = lines.NextFull()) {
    const bool header = first && !text::ToNumber(text::Cells(*line)[0]);
    first = false;
    if (header) continue;
    auto row = text::NumberRow(*line, columns);
    if (!row) return lines.Fault(row.error().message);
    table.rows.push_back(std::move(row).value());
  }
  if (table.rows.empty()) return InvalidData(origin + " holds no rows");
  return table;
}

}  // namespace footing::stream_client

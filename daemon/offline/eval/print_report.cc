#include "daemon/offline/eval/print_report.h"

#include <cstdio>

#include "common/cli/cli.h"
#include "common/base/json_text.h"

namespace footing::eval {

void PrintReport(const nlohmann::ordered_json& report, bool json) {
  if (json) {
    std::printf("%s\n", text::ToText(report).c_str());
    return;
  }
  for (const auto& [name, value] : report.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : text::ToText(value);
    std::printf("%-26s %s\n", name.c_str(), text.c_str());
  }
}

int PrintResult(const Result<nlohmann::ordered_json>& report, bool json) {
  if (!report) return cli::Report(report.error());
  PrintReport(*report, json);
  return 0;
}

}  // namespace footing::eval

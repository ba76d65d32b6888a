#include "daemon/offline/eval/report/print_report.h"

#include <cstdio>

namespace footing::eval {

void PrintReport(const nlohmann::ordered_json& report, bool json) {
  if (json) {
    std::printf("%s\n", report.dump().c_str());
    return;
  }
  for (const auto& [name, value] : report.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    std::printf("%-26s %s\n", name.c_str(), text.c_str());
  }
}

}  // namespace footing::eval

#include "common/net/avahi.h"

#include <algorithm>
#include <string_view>

namespace footing::discovery {

std::vector<std::string> TextRecord(const Service& service) {
  std::vector<std::string> record{"program=" + service.program};
  if (service.tls) record.push_back("tls=1");
  if (!service.fingerprint.empty()) record.push_back("fingerprint=" + service.fingerprint);
  return record;
}

void ReadTextRecord(const std::vector<std::string>& record, Service& service) {
  constexpr std::size_t kMostBytes = 80;  // A fingerprint has 71.
  for (const std::string& entry : record) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = entry.substr(0, equals);
    const std::string value = Printable(entry.substr(equals + 1), kMostBytes);
    if (key == "program") service.program = value;
    if (key == "tls") service.tls = value == "1";
    if (key == "fingerprint") service.fingerprint = value;
  }
}

std::string Printable(const std::string& text, std::size_t most_bytes) {
  std::string printable = text.substr(0, most_bytes);
  std::replace_if(
      printable.begin(), printable.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return printable;
}

}  // namespace footing::discovery

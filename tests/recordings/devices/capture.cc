#include "tests/recordings/devices/capture.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>

namespace footing::recordings {
namespace {

std::optional<std::vector<std::uint8_t>> ParseHex(const std::string& text) {
  if (text.size() % 2 != 0) return std::nullopt;
  std::vector<std::uint8_t> bytes(text.size() / 2);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char* at = text.data() + 2 * i;
    if (std::from_chars(at, at + 2, bytes[i], 16).ptr != at + 2) return std::nullopt;
  }
  return bytes;
}

std::optional<CapturedReport> ParseReport(const std::string& line) {
  std::istringstream words(line);
  double at_ms = 0;
  std::string way;
  std::string hex;
  words >> at_ms >> way >> hex;
  const auto bytes = ParseHex(hex);
  const bool known = way == ">" || way == "<" || way == "<f";
  if (way.empty() || !known || !bytes || !words.eof()) return std::nullopt;
  return CapturedReport{std::llround(at_ms * 1e6), way == ">", way == "<f", *bytes};
}

void ParseHeader(const std::string& line, Capture& capture) {
  const std::size_t colon = line.find(": ");
  if (colon == std::string::npos || colon < 3) return;
  capture.header.emplace_back(line.substr(2, colon - 2), line.substr(colon + 2));
}

}  // namespace

std::string Capture::Header(const std::string& key) const {
  for (const auto& [name, value] : header) {
    if (name == key) return value;
  }
  return "";
}

Result<Capture> ReadCapture(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return InvalidData(path.string() + ": cannot be read; name a capture (*.report)");
  Capture capture;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    if (line[0] == '#') {
      ParseHeader(line, capture);
      continue;
    }
    const auto report = ParseReport(line);
    const bool in_order =
        report && (capture.reports.empty() || report->at_ns >= capture.reports.back().at_ns);
    if (!in_order) {
      return InvalidData(path.string() + ":" + std::to_string(number) +
                         ": is no line \"milliseconds > hex\" (or < or <f) at or after the last");
    }
    capture.reports.push_back(*report);
  }
  return capture;
}

std::string Print(const Capture& capture) {
  std::string text;
  for (const auto& [name, value] : capture.header) text += "# " + name + ": " + value + "\n";
  char part[64];
  for (const CapturedReport& report : capture.reports) {
    const char* way = report.to_device ? ">" : report.feature ? "<f" : "<";
    std::snprintf(part, sizeof part, "%.3f %s ", static_cast<double>(report.at_ns) * 1e-6, way);
    text += part;
    for (const std::uint8_t byte : report.bytes) {
      std::snprintf(part, sizeof part, "%02x", byte);
      text += part;
    }
    text += "\n";
  }
  return text;
}

Result<devices::DeviceIdentity> IdentityOf(const Capture& capture) {
  devices::DeviceIdentity identity;
  identity.name = capture.Header("Device");
  unsigned vendor = 0;
  unsigned product = 0;
  char bus[16] = "";
  const std::string text = capture.Header("Identity");
  if (std::sscanf(text.c_str(), "%4x:%4x %15s", &vendor, &product, bus) != 3 ||
      identity.name.empty()) {
    return InvalidData("header lacks \"# Device: NAME\" or \"# Identity: 057e:0306 bluetooth\"");
  }
  identity.vendor = vendor;
  identity.product = product;
  identity.bus = std::string(bus) == "usb" ? devices::Bus::kUsb : devices::Bus::kBluetooth;
  identity.serial = "00:00:00:00:00:01";
  identity.place = "capture";
  return identity;
}

}  // namespace footing::recordings

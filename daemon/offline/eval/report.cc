#include "daemon/offline/eval/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/cli/cli.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/files.h"

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

void Progress::Done(double done, std::int64_t now_ns, std::ostream& out) {
  if (now_ns < next_ns_) return;
  next_ns_ = now_ns + kEveryNs;
  out << command_ << ": " << std::llround(std::floor(done)) << " of " << std::llround(total_) << " "
      << unit_ << std::endl;
}

namespace {

constexpr std::size_t kMostBytes = 256u << 20;

}  // namespace

Result<std::vector<std::vector<std::string>>> ReadNamedColumns(
    const std::string& path, const std::vector<std::string>& names) {
  const Result<std::string> text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  text::Lines lines(*text, path);
  std::vector<std::size_t> places;
  std::vector<std::vector<std::string>> rows;
  while (const auto line = lines.NextRow()) {
    const std::vector<std::string_view> cells = text::Cells(*line);
    if (places.empty()) {
      for (const std::string& name : names) {
        const auto found = std::find(cells.begin(), cells.end(), name);
        if (found == cells.end()) return InvalidData(path + " has no column " + name);
        if (std::count(cells.begin(), cells.end(), name) > 1) {
          return lines.Fault("two columns are named " + name);
        }
        places.push_back(static_cast<std::size_t>(found - cells.begin()));
      }
      continue;
    }
    std::vector<std::string>& row = rows.emplace_back();
    for (const std::size_t place : places) {
      if (place >= cells.size()) return lines.Fault("fewer cells than the header has names");
      row.emplace_back(cells[place]);
    }
  }
  if (places.empty()) return InvalidData(path + " is empty");
  return rows;
}

std::vector<std::string> ReadHeader(const std::string& path) {
  const Result<std::string> text = config::ReadTextFile(path, kMostBytes);
  if (!text) return {};
  text::Lines lines(*text, path);
  const auto line = lines.NextRow();
  std::vector<std::string> names;
  if (!line) return names;
  for (const std::string_view name : text::Cells(*line)) names.emplace_back(name);
  return names;
}

Result<std::vector<std::vector<double>>> ReadTimeTable(const std::string& path,
                                                       const std::string& columns) {
  const Result<std::string> text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  const std::vector<std::string_view> names = text::Cells(columns);
  std::vector<std::vector<double>> rows;
  text::Lines lines(*text, path);
  bool header_seen = false;
  while (const auto line = lines.NextRow()) {
    if (!header_seen) {
      if (text::Cells(*line) != names) return lines.Fault("the header must be " + columns);
      header_seen = true;
      continue;
    }
    auto row = text::NumberRow(*line, names.size());
    if (!row) return lines.Fault(row.error().message);
    if (!rows.empty() && row->front() < rows.back().front()) {
      return lines.Fault("time goes back, from " + std::to_string(rows.back().front()) + " s to " +
                         std::to_string(row->front()) + " s");
    }
    rows.push_back(std::move(row).value());
  }
  if (!header_seen) return InvalidData(path + " is empty; its first line must be " + columns);
  return rows;
}

Result<void> WriteText(const std::string& path, const std::string& text) {
  auto file = recording::OutputFile::Create(path, true);
  if (!file) return file.error();
  if (auto written = file->Write(text); !written) return written;
  return file->Sync();
}

}  // namespace footing::eval

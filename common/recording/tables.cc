#include "common/recording/tables.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>

#include "common/base/number.h"

namespace footing::bids {
namespace {

using nlohmann::ordered_json;

constexpr const char* kNotAvailable = "n/a";
constexpr int kDecimals = 6;

}  // namespace

Channel Latency() { return {"latency", "n/a", "LATENCY", "n/a", "s"}; }

void AddVector(const std::string& name, const std::string& type, const std::string& point,
               const std::string& units, MotionTable& table) {
  for (const char* component : {"x", "y", "z"}) {
    table.channels.push_back({name + "_" + component, component, type, point, units});
  }
}

void Append(std::initializer_list<double> values, MotionTable& table) {
  table.cells.insert(table.cells.end(), values);
}

std::string Tsv(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += '\t';
      if (row[i].empty()) text += kNotAvailable;
      for (const char c : row[i]) text += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
    }
    text += '\n';
  }
  return text;
}

std::string ChannelsTsv(const MotionTable& table) {
  const std::string rate_hz = text::Fixed(SamplingRateHz(table), 3);
  std::vector<std::vector<std::string>> rows = {
      {"name", "component", "type", "tracked_point", "units", "sampling_frequency"}};
  for (const Channel& one : table.channels) {
    rows.push_back({one.name, one.component, one.type, one.tracked_point, one.units, rate_hz});
  }
  return Tsv(rows);
}

std::string MotionTsv(const MotionTable& table) {
  std::string text;
  const std::size_t columns = table.channels.size();
  for (std::size_t i = 0; i < table.cells.size(); ++i) {
    if (std::isfinite(table.cells[i])) {
      text::AppendFixed(text, table.cells[i], kDecimals);
    } else {
      text += kNotAvailable;
    }
    text += (i + 1) % columns == 0 ? '\n' : '\t';
  }
  return text;
}

double SamplingRateHz(const MotionTable& table) {
  const std::size_t columns = table.channels.size();
  if (columns == 0 || table.cells.size() < 2 * columns) return 0;
  const double passed_s = table.cells[table.cells.size() - columns] - table.cells.front();
  return passed_s > 0 ? static_cast<double>(table.cells.size() / columns - 1) / passed_s : 0;
}

ordered_json MotionJson(const MotionTable& table, const std::string& task,
                        const std::string& task_description) {
  std::map<std::string, std::size_t> of_type;
  std::map<std::string, bool> points;
  for (const Channel& one : table.channels) {
    ++of_type[one.type];
    if (one.tracked_point != kNotAvailable) points[one.tracked_point] = true;
  }
  ordered_json json = {{"TaskName", task},
                       {"TaskDescription", task_description},
                       {"SamplingFrequency", SamplingRateHz(table)},
                       {"TrackingSystemName", table.tracksys},
                       {"Manufacturer", table.manufacturer},
                       {"MotionChannelCount", table.channels.size()},
                       {"TrackedPointsCount", points.size()}};
  for (const auto& [type, count] : of_type) json[type + "ChannelCount"] = count;
  json.update(table.notes);
  return json;
}

std::string EventsTsv(const std::vector<Event>& events) {
  std::vector<std::vector<std::string>> rows = {{"onset", "duration", "trial_type", "counts"}};
  for (const Event& one : events) {
    rows.push_back({text::Fixed(one.onset_s, 3), "0", one.trial_type, one.counts ? "yes" : "no"});
  }
  return Tsv(rows);
}

ordered_json Column(const std::string& description, const std::string& units) {
  ordered_json column = {{"Description", description}};
  if (!units.empty()) column["Units"] = units;
  return column;
}

std::vector<File> EventFiles(const std::vector<Event>& events, const std::string& stem) {
  const ordered_json codebook = {
      {"onset", Column("On the time of the channel latency", "s")},
      {"duration", Column("0: an instant", "s")},
      {"trial_type",
       Column("trial_ready, trial_running (start line), trial_finished (finish line), "
              "trial_stopped; failure_KIND; put_back, put_back_by_operator; task_done; "
              "gait_NAME: the character has changed to this gait")},
      {"counts", Column("no: a failure that was undone, by mistake of the detection")}};
  return {{stem + "_events.tsv", EventsTsv(events)},
          {stem + "_events.json", codebook.dump(2) + "\n"}};
}

std::vector<File> MotionFiles(const MotionTable& table, const std::string& stem,
                              const std::string& run, const std::string& task,
                              const std::string& task_description) {
  const std::string name = stem + "_tracksys-" + table.tracksys + run + "_";
  return {{name + "motion.tsv", MotionTsv(table)},
          {name + "motion.json", MotionJson(table, task, task_description).dump(2) + "\n"},
          {name + "channels.tsv", ChannelsTsv(table)}};
}

File DescriptionFile(const std::string& name, const std::string& program,
                     const std::string& version) {
  const ordered_json json = {{"Name", name},
                             {"BIDSVersion", "1.9.0"},
                             {"DatasetType", "raw"},
                             {"GeneratedBy", {{{"Name", program}, {"Version", version}}}}};
  return {"dataset_description.json", json.dump(2) + "\n"};
}

std::string LabelOf(const std::string& name) {
  std::string label;
  std::copy_if(name.begin(), name.end(), std::back_inserter(label),
               [](unsigned char c) { return std::isalnum(c) != 0; });
  return label;
}

std::string ShiftedTime(double seconds) {
  using namespace std::chrono;
  const sys_seconds time = sys_days(January / 1 / 1900) +
                           std::chrono::seconds(static_cast<std::int64_t>(std::floor(seconds)));
  const sys_days day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return text;
}

}  // namespace footing::bids

#include "daemon/offline/eval/trc.h"

#include <cstdlib>
#include <sstream>

#include "common/config/data_file.h"

namespace footing::eval {
namespace {

constexpr std::size_t kMostBytes = 256u << 20;
constexpr std::size_t kHeaderLines = 5;

/// Fields between tabs, without blanks around them.
std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, '\t');) {
    const auto begin = field.find_first_not_of(" \r");
    const auto end = field.find_last_not_of(" \r");
    fields.push_back(begin == std::string::npos ? "" : field.substr(begin, end - begin + 1));
  }
  return fields;
}

}  // namespace

Result<MarkerTracks> ReadTrc(const std::string& path) {
  const auto text = config::ReadTextFile(path, kMostBytes);
  if (!text) return text.error();
  std::istringstream stream(*text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  const auto at = [&path](std::size_t line) { return path + ", line " + std::to_string(line + 1); };
  if (lines.size() <= kHeaderLines || Fields(lines[2]).size() < 5) {
    return InvalidData(path + ": no TRC file: its header has five lines");
  }
  MarkerTracks tracks;
  tracks.rate_hz = std::atof(Fields(lines[2])[0].c_str());
  const std::string unit = Fields(lines[2])[4];
  const double scale = unit == "m" ? 1 : unit == "mm" ? 1e-3 : 0;
  if (!(tracks.rate_hz > 0) || scale == 0) {
    return InvalidData(at(2) + ": DataRate must be positive and Units m or mm");
  }
  std::vector<std::string> names;
  for (const std::string& field : Fields(lines[3])) {
    if (!field.empty()) names.push_back(field);
  }
  if (names.size() < 3) return InvalidData(at(3) + ": no marker names");
  names.erase(names.begin(), names.begin() + 2);  // Frame# and Time.
  for (std::size_t i = kHeaderLines; i < lines.size(); ++i) {
    const auto fields = Fields(lines[i]);
    if (fields.size() < 2 || fields[0].empty()) continue;
    if (fields.size() < 2 + 3 * names.size()) {
      return InvalidData(at(i) + ": " + std::to_string(names.size()) + " markers need " +
                         std::to_string(2 + 3 * names.size()) + " fields");
    }
    for (std::size_t marker = 0; marker < names.size(); ++marker) {
      Eigen::Vector3d place;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string& field = fields[2 + 3 * marker + axis];
        char* end = nullptr;
        place(static_cast<int>(axis)) = scale * std::strtod(field.c_str(), &end);
        if (field.empty() || *end != '\0') {
          return InvalidData(at(i) + ": marker " + names[marker] + " is not there");
        }
      }
      tracks.markers[names[marker]].push_back(place);
    }
    ++tracks.frames;
  }
  return tracks;
}

}  // namespace footing::eval

#include "common/virtual/motion/trc.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/rate.h"
#include "common/virtual/motion/value.h"

namespace footing::motion {
namespace {

constexpr double kMissingTrcValue = std::numeric_limits<double>::quiet_NaN();
constexpr int kPlaceDecimals = 5;  // Of millimetres.
constexpr int kTimeDecimals = 6;

/// Fields between tabs that are not empty.
std::vector<std::string_view> FullFields(std::string_view line) {
  std::vector<std::string_view> full;
  for (const std::string_view field : text::Fields(line, '\t')) {
    if (!field.empty()) full.push_back(field);
  }
  return full;
}

struct Head {
  double rate_hz = 0;
  double unit_m = 0;
  double frames = 0;  ///< As it says, which may be fewer than there are.
};

Result<Head> ParseHead(text::Lines& lines) {
  auto line = lines.Next();
  if (!line || text::Trim(*line).substr(0, 12) != "PathFileType") {
    return lines.Fault("not a TRC file: expected PathFileType");
  }
  line = lines.Next();
  const auto keys = FullFields(line.value_or(""));
  line = lines.Next();
  const auto values = FullFields(line.value_or(""));
  Head head;
  for (std::size_t i = 0; i < keys.size() && i < values.size(); ++i) {
    if (keys[i] == "DataRate") head.rate_hz = text::ToNumber(values[i]).value_or(0);
    if (keys[i] == "NumFrames") head.frames = text::ToNumber(values[i]).value_or(0);
    if (keys[i] == "Units") {
      head.unit_m = values[i] == "m" ? 1 : values[i] == "cm" ? 1e-2 : values[i] == "mm" ? 1e-3 : 0;
    }
  }
  if (!IsRate(head.rate_hz)) return lines.Fault("expected DataRate from 0.1 to 100000 Hz");
  if (head.unit_m == 0) return lines.Fault("expected Units m, cm or mm");
  return head;
}

/// One coordinate; nothing where the field has no number in it.
std::optional<double> Coordinate(const std::vector<std::string_view>& fields, std::size_t index) {
  return index < fields.size() ? ToValue(fields[index]) : std::nullopt;
}

bool IsGap(std::string_view field) {
  return field.empty() || text::EqualsIgnoringCase(field, "nan") ||
         text::EqualsIgnoringCase(field, "-nan");
}

/// Times are rounded, but no frame is missing, and none has another's place.
bool IsNext(double steps) { return steps > 0.5 && steps < 1.5; }

constexpr const char* kNotNext =
    " s is not a frame of DataRate after the one before; frames are missing or in another order, "
    "or DataRate is wrong";

}  // namespace

Result<MarkerTracks> ParseTrc(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  const auto head = ParseHead(lines);
  if (!head) return head.error();
  MarkerTracks tracks;
  tracks.rate_hz = head->rate_hz;
  const auto names = FullFields(lines.Next().value_or(""));
  if (names.size() < 3 || names[0] != "Frame#") {
    return lines.Fault("expected Frame#, Time and the names of markers");
  }
  const std::size_t markers = names.size() - 2;
  if (3 * markers > kMostColumns) return lines.Fault("too many markers");
  for (std::size_t i = 2; i < names.size(); ++i) tracks.names.emplace_back(names[i]);
  lines.Next();  // X1 Y1 Z1 ...
  std::vector<std::vector<Eigen::Vector3d>> places(markers);
  std::size_t frames = 0;
  double last_s = 0;
  for (auto line = lines.NextFull(); line; line = lines.NextFull()) {
    const auto fields = text::Fields(*line, '\t');
    if (fields[0].empty()) continue;
    if ((frames + 1) * 3 * markers > kMostValues) return lines.Fault("too many frames");
    const auto time_s = Coordinate(fields, 1);
    if (!text::ToNumber(fields[0]) || !time_s)
      return lines.Fault("expected a frame number and a time");
    if (frames == 0) tracks.start_s = *time_s;
    if (frames > 0 && !IsNext((*time_s - last_s) * head->rate_hz)) {
      return lines.Fault("the time " + std::string(fields[1]) + kNotNext);
    }
    last_s = *time_s;
    for (std::size_t marker = 0; marker < markers; ++marker) {
      Eigen::Vector3d p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = 2 + 3 * marker + axis;
        const auto number = Coordinate(fields, at);
        if (!number && at < fields.size() && !IsGap(fields[at])) {
          return lines.Fault("marker " + tracks.names[marker] +
                             ": expected a number within +-1e9, found " + text::Quoted(fields[at]));
        }
        p(static_cast<int>(axis)) = number ? *number * head->unit_m : kMissingTrcValue;
      }
      const bool seen = p.allFinite() && !p.isZero(0);
      places[marker].push_back(seen ? p : Eigen::Vector3d::Constant(kMissingTrcValue));
    }
    ++frames;
  }
  if (frames == 0) return lines.Fault("no frame in the file");
  if (static_cast<double>(frames) < head->frames) {
    return lines.Fault("the file ends after frame " + std::to_string(frames) +
                       ", and NumFrames is " + std::to_string(std::llround(head->frames)));
  }
  for (auto& track : places) {
    tracks.p.emplace_back(3, static_cast<Eigen::Index>(frames));
    for (std::size_t i = 0; i < frames; ++i) {
      tracks.p.back().col(static_cast<Eigen::Index>(i)) = track[i];
    }
    track = {};
  }
  return tracks;
}

std::string WriteTrc(const MarkerTracks& tracks, const std::string& name) {
  const std::string frames = std::to_string(tracks.frames());
  std::string rate;
  text::AppendFixed(rate, tracks.rate_hz, kTimeDecimals);
  std::string text = "PathFileType\t4\t(X/Y/Z)\t" + name +
                     "\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
                     "OrigDataStartFrame\tOrigNumFrames\n" +
                     rate + "\t" + rate + "\t" + frames + "\t" +
                     std::to_string(tracks.names.size()) + "\tmm\t" + rate + "\t1\t" + frames +
                     "\nFrame#\tTime";
  for (const std::string& marker : tracks.names) text += "\t" + marker + "\t\t";
  text += "\n\t";
  for (std::size_t i = 1; i <= tracks.names.size(); ++i) {
    for (const char axis : {'X', 'Y', 'Z'}) text += std::string("\t") + axis + std::to_string(i);
  }
  text += "\n\n";
  for (Eigen::Index frame = 0; frame < tracks.frames(); ++frame) {
    text += std::to_string(frame + 1) + "\t";
    text::AppendFixed(text, tracks.start_s + static_cast<double>(frame) / tracks.rate_hz,
                      kTimeDecimals);
    for (const Eigen::Matrix3Xd& track : tracks.p) {
      const Eigen::Vector3d p = track.col(frame);
      for (int axis = 0; axis < 3; ++axis) {
        text += '\t';
        if (Seen(p)) text::AppendFixed(text, 1000 * p(axis), kPlaceDecimals);
      }
    }
    // OpenSim drops an empty last field unless a tab ends it.
    if (text.back() == '\t') text += '\t';
    text += '\n';
  }
  return text;
}

}  // namespace footing::motion

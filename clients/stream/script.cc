#include "clients/stream/script.h"

#include <map>
#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/units.h"

namespace footing::stream_client {
namespace {

using wrists::Segment;

constexpr std::size_t kMaxSegments = 10'000;

Segment Rest(double duration_s) {
  Segment segment;
  segment.duration_s = duration_s;
  return segment;
}

/// A swing: out of phase for walking and running, in phase for jumping.
Segment Swing(double duration_s, double frequency_hz, double phase_rad, double amplitude_mps2,
              double roll_deg = 0) {
  Segment segment = Rest(duration_s);
  segment.frequency_hz = frequency_hz;
  segment.phase_rad = phase_rad;
  segment.amplitude_mps2 = amplitude_mps2;
  segment.roll_rad = DegreesToRadians(roll_deg);
  return segment;
}

// The frequencies stand well inside a gait's range: walking below 2 Hz, running above (gait paper,
// section 7). Amplitudes are those of a relaxed, a brisk and a wide swing of the wrist.
const std::map<std::string, std::vector<Segment>>& Scripts() {
  static const std::map<std::string, std::vector<Segment>> scripts = {
      {"demo",
       {Rest(4), Swing(5, 1.3, kPi, 7), Swing(2, 1.3, kPi, 7, 20), Swing(2, 1.3, kPi, 7, -20),
        Swing(6, 3.0, kPi, 13), Swing(7, 2.0, 0, 14), Rest(3)}},
      {"straight", {Rest(3), Swing(20, 1.3, kPi, 7), Swing(20, 3.0, kPi, 13), Rest(5)}},
      {"walk", {Rest(2), Swing(60, 1.3, kPi, 7)}},
      {"run", {Rest(2), Swing(60, 3.0, kPi, 13)}},
      {"jump", {Rest(2), Swing(60, 2.0, 0, 14)}},
      {"turn", {Rest(2), Swing(15, 1.3, kPi, 7, 20), Swing(15, 1.3, kPi, 7, -20), Rest(3)}},
      {"rest", {Rest(60)}},
  };
  return scripts;
}

struct Field {
  const char* key;
  double min;
  double max;
  double scale;  ///< From the file's unit to SI.
  double Segment::*member;
};

const Field kFields[] = {
    // key            min    max   to SI                  member
    {"duration_s", 0.01, 3600, 1, &Segment::duration_s},
    {"frequency_hz", 0.1, 10, 1, &Segment::frequency_hz},
    {"phase_deg", -360, 360, kPi / 180, &Segment::phase_rad},
    {"amplitude_mps2", 0, 100, 1, &Segment::amplitude_mps2},
    {"roll_deg", -80, 80, kPi / 180, &Segment::roll_rad},
    {"pitch_deg", -80, 80, kPi / 180, &Segment::pitch_rad},
};

Result<Segment> ParseSegment(const nlohmann::json& json, const std::string& place) {
  if (!json.is_object() || !json.contains("duration_s")) {
    return InvalidData(place + " must be an object with at least duration_s");
  }
  Segment segment;
  for (const auto& [key, value] : json.items()) {
    const Field* found = nullptr;
    for (const Field& field : kFields) {
      if (key == field.key) found = &field;
    }
    if (found == nullptr) return InvalidData(place + ": unknown key \"" + key + "\"");
    const double number = value.is_number() ? value.get<double>() : found->min - 1;
    if (!(number >= found->min && number <= found->max)) {
      return InvalidData(place + ": " + key + " must be a number from " +
                         std::to_string(found->min) + " to " + std::to_string(found->max));
    }
    segment.*(found->member) = number * found->scale;
  }
  return segment;
}

}  // namespace

std::vector<std::string> ScriptNames() {
  std::vector<std::string> names;
  for (const auto& [name, segments] : Scripts()) names.push_back(name);
  return names;
}

Result<std::vector<Segment>> ScriptNamed(const std::string& name) {
  const auto found = Scripts().find(name);
  if (found != Scripts().end()) return found->second;
  std::string names;
  for (const std::string& known : ScriptNames()) names += " " + known;
  return UsageError("no script \"" + name + "\"; there are:" + names +
                    " (or the path of a JSON file)");
}

Result<std::vector<Segment>> ParseScript(const std::string& text, const std::string& origin) {
  const auto read = text::ParseJson(text, origin);
  if (!read) return read.error();
  const auto& json = *read;
  if (!json.is_array() || json.empty()) {
    return InvalidData(origin + " must hold a JSON list of at least one stretch");
  }
  if (json.size() > kMaxSegments) return InvalidData(origin + " has more than 10000 stretches");
  std::vector<Segment> segments;
  for (const auto& item : json) {
    auto segment = ParseSegment(item, origin + ", stretch " + std::to_string(segments.size() + 1));
    if (!segment) return segment.error();
    segments.push_back(*segment);
  }
  return segments;
}

}  // namespace footing::stream_client

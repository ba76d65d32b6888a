#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"

namespace footing::terrain {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxSegments = 1000;
constexpr std::size_t kMaxTasks = 16;
/// Behind the finish line there is so much ground to slow down on.
constexpr double kRunOutM = 5;
constexpr double kStartLineM = 1;
constexpr double kTaskWithinM = 15;
/// Lengths of many segments add up to within this.
constexpr double kRoundingM = 1e-9;

/// Reads one JSON object and remembers the first thing wrong.
class Fields {
 public:
  Fields(const json& object, std::string where) : object_(object), where_(std::move(where)) {}

  double Number(const char* key, double fallback, double min, double max) {
    if (!object_.contains(key)) return fallback;
    const json& value = object_[key];
    if (value.is_number() && value.get<double>() >= min && value.get<double>() <= max) {
      return value.get<double>();
    }
    Fail(std::string(key) + " is " + value.dump() + ", allowed is a number from " +
         std::to_string(min) + " to " + std::to_string(max));
    return fallback;
  }

  bool Flag(const char* key, bool fallback) {
    if (!object_.contains(key)) return fallback;
    if (object_[key].is_boolean()) return object_[key].get<bool>();
    Fail(std::string(key) + " is " + object_[key].dump() + ", allowed is true or false");
    return fallback;
  }

  /// kUnspecified where the key is missing.
  stream::Gait Gait(const char* key) {
    if (!object_.contains(key)) return stream::Gait::kUnspecified;
    const json& value = object_[key];
    const std::string name = value.is_string() ? value.get<std::string>() : value.dump();
    const stream::Gait gait = stream::GaitNamed(name);
    if (gait == stream::Gait::kUnspecified) {
      Fail(std::string(key) + " is " + name + ", allowed is one of: " + stream::GaitNames());
    }
    return gait;
  }

  /// Fails when the object has another key than those.
  void OnlyKeys(std::initializer_list<const char*> keys) {
    for (const auto& [key, value] : object_.items()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        Fail("unknown key \"" + key + "\"");
      }
    }
  }

  void Fail(const std::string& what) {
    if (error_.empty()) error_ = where_ + ": " + what;
  }
  Result<void> Done() const {
    if (error_.empty()) return {};
    return InvalidData(error_);
  }

 private:
  const json& object_;
  std::string where_;
  std::string error_;
};

/// The character stands before the first pit, and lands on the far edge of each.
Result<void> CheckPit(const std::string& where, double curve_rad, const stream::Track& track) {
  const bool first = std::none_of(track.segments.begin(), track.segments.end(),
                                  [](const auto& segment) { return segment.pit; });
  const double ground_m = track.segments.empty() ? 0 : LengthOf(track);
  if (first && ground_m < kGroundAtStartM - kRoundingM) {
    return InvalidData(where + ": the pit begins " + text::Fixed(ground_m, 2) +
                       " m from the start of the track, where the character stands; put at least " +
                       text::Shortest(kGroundAtStartM) + " m of ground before it");
  }
  if (curve_rad != 0) {
    return InvalidData(where + ": a pit has no curve_deg; put the curve before or after it");
  }
  return {};
}

/// One object of the file: as many segments as it repeats.
Result<void> AppendFrom(const json& object, const std::string& where, double width_m,
                        stream::Track& track) {
  if (!object.is_object()) return InvalidData(where + ": a segment is an object {length_m, ...}");
  Fields fields(object, where);
  fields.OnlyKeys({"length_m", "curve_deg", "slope_deg", "step_m", "pit", "repeat"});
  const double repeat = fields.Number("repeat", 1, 1, static_cast<double>(kMaxSegments));
  for (int i = 0; i < static_cast<int>(repeat); ++i) {
    stream::TrackSegment segment =
        track.segments.empty() ? stream::TrackSegment{} : Following(track.segments.back());
    segment.width_m = width_m;
    segment.length_m = fields.Number("length_m", 0, 0.01, 10000);
    if (segment.length_m == 0) fields.Fail("length_m is missing");
    segment.slope_rad = DegreesToRadians(fields.Number("slope_deg", 0, -30, 30));
    const double curve_rad = DegreesToRadians(fields.Number("curve_deg", 0, -90, 90));
    segment.heading_rad += curve_rad;
    segment.start_m.z() += fields.Number("step_m", 0, -0.5, 0.5);
    segment.pit = fields.Flag("pit", false);
    if (segment.pit) {
      if (auto checked = CheckPit(where, curve_rad, track); !checked) return checked;
    }
    track.segments.push_back(segment);
  }
  return fields.Done();
}

Result<void> ReadSegments(const json& root, const std::string& origin, double width_m,
                          stream::Track& track) {
  const json segments = root.value("segments", json());
  if (!segments.is_array() || segments.empty() || segments.size() > kMaxSegments) {
    return InvalidData(origin + ": segments must be a list of 1 to " +
                       std::to_string(kMaxSegments));
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string where = origin + ", segment " + std::to_string(i);
    if (auto appended = AppendFrom(segments[i], where, width_m, track); !appended) return appended;
    if (track.segments.size() > kMaxSegments) {
      return InvalidData(where + ": with all repetitions the track has more than " +
                         std::to_string(kMaxSegments) + " segments");
    }
  }
  return {};
}

Result<void> ReadTask(const json& object, const std::string& where, stream::Track& track) {
  if (!object.is_object())
    return InvalidData(where + ": a task is an object {name, before, after}");
  Fields fields(object, where);
  fields.OnlyKeys({"name", "before", "after"});
  stream::TrackTask task;
  const json name = object.value("name", json());
  task.name = name.is_string() ? name.get<std::string>() : "";
  const bool known = std::any_of(track.tasks.begin(), track.tasks.end(),
                                 [&](const auto& other) { return other.name == task.name; });
  if (task.name.empty() || known) fields.Fail("name must be a text that no other task has");
  task.before = fields.Gait("before");
  task.after = fields.Gait("after");
  if (task.after == stream::Gait::kUnspecified || task.after == task.before) {
    fields.Fail("after must be a gait, and another one than before");
  }
  task.instruction = stream::InstructionFor(task.before, task.after);
  track.tasks.push_back(task);
  return fields.Done();
}

Result<void> ReadMark(const json& root, const std::string& origin, stream::Track& track) {
  if (!root.contains("mark")) return {};
  const std::string where = origin + ", mark";
  if (!root["mark"].is_object()) return InvalidData(where + " must be an object {at_m, tasks}");
  const json& mark = root["mark"];
  Fields fields(mark, where);
  fields.OnlyKeys({"at_m", "within_m", "tasks"});
  const double end_m = track.finish_m > 0 ? track.finish_m : LengthOf(track);
  track.mark_m = fields.Number("at_m", 0, track.start_m + 0.01, end_m);
  if (track.mark_m == 0) fields.Fail("at_m is missing");
  // The task is done or missed before the finish line.
  const double most_m = std::max(0.01, end_m - track.mark_m);
  track.task_within_m = fields.Number("within_m", std::min(kTaskWithinM, most_m), 0.01, most_m);
  const json tasks = mark.value("tasks", json());
  if (!tasks.is_array() || tasks.empty() || tasks.size() > kMaxTasks) {
    fields.Fail("tasks must be a list of 1 to " + std::to_string(kMaxTasks));
  }
  if (auto done = fields.Done(); !done) return done;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::string task = where + ", task " + std::to_string(i);
    if (auto read = ReadTask(tasks[i], task, track); !read) return read;
  }
  return {};
}

/// Start and finish lines. A track that may be left, or that grows, has no finish line of its own.
void ReadLines(Fields& fields, stream::Track& track) {
  const double length_m = LengthOf(track);
  const bool ends = !track.open && !track.extendable && !track.endless;
  const std::string length = "the track is " + text::Fixed(length_m, 2) + " m long";
  track.start_m = fields.Number("start_m", kStartLineM, 0, length_m);
  if (length_m < track.start_m + kGroundAtStartM - kRoundingM) {
    fields.Fail(length + ", its start line is at " + text::Shortest(track.start_m) +
                " m; at least " + text::Shortest(kGroundAtStartM) + " m of track must follow it");
  }
  const auto start = static_cast<std::size_t>(PlaceAt(track, track.start_m).segment);
  if (track.segments[start].pit) {
    fields.Fail("start_m is " + text::Shortest(track.start_m) +
                ", in a pit; put the start line on the ground");
  }
  const double finish_m = fields.Number("finish_m", -1, 0, length_m);
  if (finish_m >= 0 || !ends) {
    track.finish_m = std::max(finish_m, 0.0);
    if (track.finish_m > 0 && track.finish_m <= track.start_m) {
      fields.Fail("finish_m must be beyond start_m");
    }
    return;
  }
  track.finish_m = length_m - kRunOutM;
  if (track.finish_m <= track.start_m + kRoundingM) {
    fields.Fail(length + ", too short for a finish line " + text::Shortest(kRunOutM) +
                " m before its end; make it longer than " +
                text::Shortest(track.start_m + kRunOutM) + " m, or set finish_m");
  }
}

/// Checks the limits of a track that grows.
Result<void> CheckGrowing(const stream::Track& track, const std::string& origin) {
  constexpr std::size_t kMost = 32;
  constexpr double kShortestM = 2;
  if (!Grows(track)) return {};
  if (track.extendable && track.endless) {
    return InvalidData(origin + ": a track is either extendable or endless");
  }
  bool fits = track.segments.size() <= kMost;
  for (const stream::TrackSegment& segment : track.segments) {
    fits = fits && segment.length_m >= kShortestM;
  }
  if (!fits) {
    return InvalidData(origin + (track.extendable ? ": an extendable" : ": an endless") +
                       " track starts with 1 to 32 segments of at least 2 m");
  }
  if (track.endless && !IsFlat(track)) {
    return InvalidData(origin + ": an endless track is level, without steps and pits");
  }
  if (!track.help_over_pits) {
    return InvalidData(origin + ": a track that grows has help_over_pits");
  }
  return {};
}

}  // namespace

Result<stream::Track> ParseTrack(const std::string& text, const std::string& origin) {
  const auto parsed = text::ParseJson(text, origin);
  if (!parsed) return parsed.error();
  const auto& root = *parsed;
  if (!root.is_object()) return InvalidData(origin + ": not a JSON object");
  Fields fields(root, origin);
  if (fields.Number("version", 0, 0, 1e9) != 1) {
    return InvalidData(origin + ": version must be 1, the only one known");
  }
  fields.OnlyKeys({"version", "name", "comment", "width_m", "open", "extendable", "endless",
                   "help_over_pits", "start_m", "finish_m", "mark", "segments"});
  stream::Track track;
  track.revision = 1;
  track.extendable = fields.Flag("extendable", false);
  track.endless = fields.Flag("endless", false);
  track.open = fields.Flag("open", false);
  track.help_over_pits = fields.Flag("help_over_pits", true);
  track.name = root.contains("name") && root["name"].is_string() ? root["name"] : json("unnamed");
  const double width_m = fields.Number("width_m", 4, 0.1, 100);
  if (auto done = fields.Done(); !done) return done.error();
  if (auto read = ReadSegments(root, origin, width_m, track); !read) return read.error();
  ReadLines(fields, track);
  if (auto done = fields.Done(); !done) return done.error();
  if (auto read = ReadMark(root, origin, track); !read) return read.error();
  if (auto checked = CheckGrowing(track, origin); !checked) return checked.error();
  return track;
}

}  // namespace footing::terrain

#include "clients/stream/samples.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>

#include <nlohmann/json.hpp>

#include "clients/stream/boards.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/runtime/files.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/leg_solver.h"
#include "common/virtual/people/perform.h"
#include "common/virtual/people/script.h"

namespace footing::stream_client {
namespace {

constexpr double kSampleHeightM = 1.75;
constexpr double kSampleMassKg = 70;
constexpr double kSampleCornerRateHz = 60;
constexpr double kSampleCornerSeconds = 30;
constexpr double kSampleSwayM = 0.004;
constexpr int kSampleSwayInputs = 20;
constexpr int kSampleSwayRows = 600;

/// A T-pose, a squat with raised arms, and both arms down: 12 s.
constexpr const char* kSampleClip = R"({"sway_mm": 2, "keys": [
  {"seconds": 6},
  {"seconds": 1.2, "both_raise_deg": -75, "both_elbow_deg": 10},
  {"seconds": 1.2, "crouch_m": 0.2, "bow_deg": 24, "both_front_deg": 70, "both_raise_deg": -10},
  {"seconds": 0.6},
  {"seconds": 1.2, "crouch_m": 0, "bow_deg": 0, "both_front_deg": 0, "both_raise_deg": -75},
  {"seconds": 1.8}]})";
constexpr const char* kSampleLabels =
    "begin_s,end_s,activity\n0,6,T-pose\n7.2,10.2,squat\n10.2,12,standing\n";

std::string SampleSubject(const char* code, double height_m, double mass_kg) {
  std::ostringstream text;
  text << "{\"code\": \"" << code << "\", \"height_m\": " << height_m
       << ", \"mass_kg\": " << mass_kg << "}\n";
  return text.str();
}

/// The accelerations that both wrists of the user of the script "demo" feel.
Result<std::array<std::string, 2>> SampleAccelerations() {
  const auto script = ScriptNamed("demo");
  if (!script) return script.error();
  constexpr double kBlendS = 0.15;
  const wrists::HandMotion motion(*script, wrists::WristShape(), kBlendS);
  std::array<std::ostringstream, 2> texts;
  for (auto& text : texts) text << "ax,ay,az\n";
  for (const wrists::TimedReading& reading : wrists::Record(motion, {}, 1)) {
    const Eigen::Vector3d* forces[] = {&reading.left.specific_force_mps2,
                                       &reading.right.specific_force_mps2};
    for (std::size_t side = 0; side < 2; ++side) {
      texts[side] << forces[side]->x() << "," << forces[side]->y() << "," << forces[side]->z()
                  << "\n";
    }
  }
  return std::array{texts[0].str(), texts[1].str()};
}

std::string SampleCorners() {
  std::ostringstream text;
  text << "time_s,tl_kg,tr_kg,bl_kg,br_kg\n";
  noise::Random random(1);
  for (int i = 0; i < static_cast<int>(kSampleCornerSeconds * kSampleCornerRateHz); ++i) {
    const double t_s = i / kSampleCornerRateHz;
    virtual_sensors::FootForce person;
    person.load_n = KilogramsToNewtons(kSampleMassKg);
    person.cop_m = choreography::Sway(kSampleSwayM, t_s);
    const auto load = virtual_sensors::LoadBoard({}, person);
    text << t_s;
    for (const double corner_n : load.corners_n) {
      constexpr double kNoiseKg = 0.01;
      text << "," << NewtonsToKilograms(corner_n) + kNoiseKg * random.Normal();
    }
    text << "\n";
  }
  return text.str();
}

Result<std::string> SampleClip() {
  const auto script = choreography::ParseScript(kSampleClip, "the sample clip");
  if (!script) return script.error();
  const auto performer = choreography::Performer(kSampleHeightM, kSampleMassKg);
  if (!performer) return performer.error();
  constexpr double kRateHz = 60;
  return motion::WriteBvh(choreography::Perform(*script, *performer, kRateHz).motion);
}

/// A gyroscope and an accelerometer at rest for 3 s, then turned to and fro about their x: 20 s at
/// 100 Hz, with the true attitude.
std::string SampleImu() {
  constexpr double kRateHz = 100, kRestS = 3, kSeconds = 20, kSwingRad = 0.5, kSwingRadps = 2;
  std::ostringstream text;
  text << "gx,gy,gz,ax,ay,az,qw,qx,qy,qz,moving\n";
  for (int i = 0; i < static_cast<int>(kSeconds * kRateHz); ++i) {
    const double moved_s = std::max(0.0, i / kRateHz - kRestS);
    const double angle_rad = kSwingRad * (1 - std::cos(kSwingRadps * moved_s));
    const double rate_radps = kSwingRad * kSwingRadps * std::sin(kSwingRadps * moved_s);
    text << rate_radps << ",0,0,0," << kStandardGravityMps2 * std::sin(angle_rad) << ","
         << kStandardGravityMps2 * std::cos(angle_rad) << "," << std::cos(angle_rad / 2) << ","
         << std::sin(angle_rad / 2) << ",0,0," << (moved_s > 0 ? 1 : 0) << "\n";
  }
  return text.str();
}

/// The sway of a standing person and what it will be in half a second: a table to train on.
std::string SampleSwayTable() {
  constexpr double kStepS = 0.05;
  constexpr int kAhead = 10;
  std::ostringstream text;
  for (int i = 0; i < kSampleSwayInputs; ++i) text << "x" << i << ",";
  text << "x_ahead\n";
  for (int row = 0; row < kSampleSwayRows; ++row) {
    const auto at = [row](int step) { return choreography::Sway(1, kStepS * (row + step)).x(); };
    for (int i = 0; i < kSampleSwayInputs; ++i) text << at(i) << ",";
    text << at(kSampleSwayInputs - 1 + kAhead) << "\n";
  }
  return text.str();
}

/// A measure of a synthetic study: its mean with each interface, how much subjects and single
/// values differ, its range, and the decimals that it is recorded with.
struct SampleMeasure {
  std::array<double, 4> means;
  double subject_sd, value_sd;
  double least, greatest;
  int decimals;
};
constexpr SampleMeasure kSampleRatings = {{2.9, 3.7, 3.1, 4.0}, 0.6, 0.7, 1, 5, 0};
constexpr SampleMeasure kSampleOscillation = {{0.21, 0.14, 0.15, 0.12}, 0.03, 0.03, 0.01, 1, 4};
constexpr SampleMeasure kSampleFailures = {{8, 3, 5, 3}, 2, 2, 0, 99, 0};

std::string SampleStudy(const SampleMeasure& measure, std::uint64_t seed) {
  constexpr const char* kInterfaces[] = {"joystick", "wrist", "arm", "leg"};
  constexpr int kSubjects = 15;
  noise::Random random(seed);
  std::string text = "subject,group_index,group,value\n";
  for (int subject = 1; subject <= kSubjects; ++subject) {
    const double own = measure.subject_sd * random.Normal();
    for (std::size_t i = 0; i < measure.means.size(); ++i) {
      const double value = measure.means[i] + own + measure.value_sd * random.Normal();
      text += (subject < 10 ? "p0" : "p") + std::to_string(subject) + "," + std::to_string(i) +
              "," + kInterfaces[i] + ",";
      text::AppendFixed(text, std::clamp(value, measure.least, measure.greatest), measure.decimals);
      text += "\n";
    }
  }
  return text;
}

bool HasOtherContent(const std::string& path, const std::string& text) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return false;
  const auto is = config::ReadTextFile(path);
  return !is || *is != text;
}

}  // namespace

Result<std::vector<SampleFile>> SampleFiles() {
  auto accelerations = SampleAccelerations();
  if (!accelerations) return accelerations.error();
  auto clip = SampleClip();
  if (!clip) return clip.error();
  return std::vector<SampleFile>{{"left.csv", (*accelerations)[0]},
                                 {"right.csv", (*accelerations)[1]},
                                 {"corners.csv", SampleCorners()},
                                 {"p07.json", SampleSubject("p07", 1.81, 74)},
                                 {"p08.json", SampleSubject("p08", 1.68, 61)},
                                 {"p09.json", SampleSubject("p09", 1.75, 80)},
                                 {"clip.bvh", std::move(*clip)},
                                 {"labels.csv", kSampleLabels},
                                 {"imu.csv", SampleImu()},
                                 {"sway.csv", SampleSwayTable()},
                                 {"ratings.csv", SampleStudy(kSampleRatings, 1)},
                                 {"oscillation.csv", SampleStudy(kSampleOscillation, 2)},
                                 {"failures.csv", SampleStudy(kSampleFailures, 3)},
                                 {"camera.json", DemoCameraFile()}};
}

Result<void> WriteSampleFiles(const std::string& folder, bool replace) {
  const auto files = SampleFiles();
  if (!files) return files.error();
  for (const SampleFile& file : *files) {
    const std::string path = folder + "/" + file.name;
    if (!replace && HasOtherContent(path, file.text)) {
      return Failure(path + " is there already, with other content: nothing was written; name " +
                     "another folder, or replace it with --force");
    }
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return Failure("cannot create the folder " + folder + ": " + error.message() +
                   "; name one that you may write to");
  }
  for (const SampleFile& file : *files) {
    const std::string path = folder + "/" + file.name;
    std::ofstream out(path, std::ios::binary);
    out << file.text;
    if (!out.flush()) {
      return Failure("cannot write " + path + ": " + std::generic_category().message(errno) +
                     "; free some space or name another folder");
    }
  }
  return {};
}

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

#include "clients/stream/body_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/board/geometry.h"
#include "common/runtime/data_file.h"
#include "common/runtime/log.h"
#include "common/base/units.h"
#include "common/virtual/people/perform.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/options/load.h"

namespace footing::stream_client {
namespace {

namespace sensors = virtual_sensors;
using sensors::kFeet;

constexpr double kLoadedN = 20;
constexpr double kReportedOutsideShare = 0.02;
constexpr double kEdge = 0.02;  // Of the loaded samples lie beyond each end of a range.
constexpr double kReportedOffsetM = 0.0005;
constexpr double kLongestS = 3600;

std::string Text(const char* format, double value) {
  char text[160];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool IsPath(const std::string& motion) {
  if (motion.find('/') != std::string::npos) return true;
  for (const char* ending : {".json", ".bvh", ".amc", ".trc", ".c3d"})
    if (motion.ends_with(ending)) return true;
  return false;
}

Result<choreography::Script> ReadChoreography(const std::string& motion) {
  if (!IsPath(motion)) {
    auto script = choreography::BuiltInScript(motion);
    if (script) return script;
    return UsageError("--motion: " + script.error().message +
                      " (or the path of a .json, .bvh, .amc, .trc or .c3d file)");
  }
  const auto text = config::ReadTextFile(motion);
  if (!text) return text.error();
  return choreography::ParseScript(*text, motion);
}

/// `repeats`: whether it ends in the T-pose, in which it begins.
Result<sensors::Scene> PerformScript(const StageOptions& options, bool& repeats) {
  const auto script = ReadChoreography(options.motion);
  if (!script) return script.error();
  const auto body = choreography::Performer(options.height_m, options.mass_kg);
  if (!body) return body.error();
  repeats = script->EndsInTPose();
  log::Info("performing " + options.motion + Text(", %.0f s", script->duration_s()) +
            (repeats ? ", again and again" : ", once, since it does not end in the T-pose"));
  const auto made = choreography::Perform(
      *script, *body, 100, [](double done) { log::Info(Text("performing: %.0f %%", 100 * done)); });
  log::Info(Text("performed; its centre of pressure is the script's within %.1f mm",
                 1000 * made.pressure_error_m));
  body::PersonParameters person;
  person.mass_kg = options.mass_kg;
  person.height_m = options.height_m;
  sensors::SceneOptions scene;
  scene.t_pose = false;
  return sensors::MakeScene(made.motion, person, scene, options.motion);
}

Result<sensors::Scene> LoadRecording(const StageOptions& options) {
  motion_files::LoadOptions load;
  load.skeleton = options.skeleton;
  load.bvh_unit_m = options.bvh_unit_m;
  auto loaded = motion_files::LoadMotion(options.motion, load);
  if (!loaded) return loaded.error();
  if (!loaded->note.empty()) log::Info(loaded->note);
  if (loaded->motion.duration_s() > kLongestS) {
    return InvalidData(options.motion +
                       Text(": lasts %.0f s, more than an hour", loaded->motion.duration_s()));
  }
  body::PersonParameters person;
  person.mass_kg = options.mass_kg;
  person.height_m = loaded->height_m;
  sensors::SceneOptions scene;
  const double clip_s = options.seconds - scene.hold_s - scene.leave_s;
  if (clip_s > loaded->motion.duration_s()) scene.loop_s = clip_s;
  // As footing-eval has it, and so that a viewer can hold the pose against it.
  auto kept = motion::WithLandmarksOnly(loaded->motion);
  if (!kept) return InvalidData(options.motion + ": " + kept.error().message);
  return sensors::MakeScene(std::move(kept).value(), person, scene, options.motion);
}

/// The range that most of the values are in.
struct Range {
  double low = 0, high = 0;
  double middle() const { return 0.5 * (low + high); }
};
Range RangeOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return {values[static_cast<std::size_t>(kEdge * last)],
          values[static_cast<std::size_t>((1 - kEdge) * last)]};
}

double OutsideShare(const Stage& stage) {
  std::size_t loaded = 0, outside = 0;
  for (const auto& feet : stage.feet)
    for (std::size_t f = 0; f < kFeet; ++f) {
      if (feet[f].load_n < kLoadedN) continue;
      ++loaded;
      outside += sensors::LoadBoard(stage.boards[f], feet[f]).outside ? 1 : 0;
    }
  return loaded > 0 ? static_cast<double>(outside) / static_cast<double>(loaded) : 0;
}

void Move(const Eigen::Vector2d& by, Stage& stage) {
  sensors::Shift(by, stage.scene);
  for (auto& feet : stage.feet)
    for (auto& foot : feet) foot.cop_m += by;
}

/// The gap, in whole 5 mm, at which the fewest feet are beyond their board's sensors: the middle
/// of such gaps where there are several. `aside_m`: how far each loaded COP is to its own side.
double BestGap(const std::vector<double>& aside_m) {
  constexpr double kStepM = 0.005, kWidestM = 1;
  std::size_t fewest = aside_m.size() + 1;
  double first_m = 0, last_m = 0;
  for (int i = 0; i * kStepM <= kWidestM; ++i) {
    const double middle_m = 0.5 * (board::kBalanceBoard.plate_y_m + i * kStepM);
    const auto outside = static_cast<std::size_t>(
        std::count_if(aside_m.begin(), aside_m.end(), [middle_m](double at_m) {
          return std::abs(at_m - middle_m) > 0.5 * board::kBalanceBoard.sensor_distance_y_m;
        }));
    if (outside < fewest) {
      fewest = outside;
      first_m = last_m = i * kStepM;
    } else if (outside == fewest && i * kStepM - last_m < 1.5 * kStepM) {
      last_m = i * kStepM;
    }
  }
  return kStepM * std::round(0.5 * (first_m + last_m) / kStepM);
}

/// Boards as far apart as suits the feet, and the motion moved so that they press in the boards'
/// middle fore and aft.
void FitBoards(Stage& stage) {
  std::vector<double> ahead, aside;
  for (const auto& feet : stage.feet)
    for (std::size_t f = 0; f < kFeet; ++f) {
      if (feet[f].load_n < kLoadedN) continue;
      ahead.push_back(feet[f].cop_m.x());
      aside.push_back(f == 0 ? feet[f].cop_m.y() : -feet[f].cop_m.y());
    }
  Move({-RangeOf(std::move(ahead)).middle(), 0}, stage);
  stage.gap_m = BestGap(aside);
  stage.boards = sensors::OneFootEach(stage.gap_m);
}

void LogPlacement(const Stage& stage, bool placed) {
  const std::string gap = Text("%.0f", 1000 * stage.gap_m);
  const std::string outside = Text("%.1f %%", 100 * stage.outside_share);
  if (placed) {
    log::Info(
        "boards placed under the feet, " + gap +
        " mm apart; set this in footingd: footing-ctl layout --preset one_foot_each --gap-mm " +
        gap);
  }
  if (stage.outside_share <= kReportedOutsideShare) return;
  log::Warning(outside +
               " of the loaded samples have a foot beyond its board's sensors; their COP is "
               "limited to the edge" +
               (placed ? std::string() : "; --place-boards places the boards under the feet"));
}

}  // namespace

double Stage::duration_s() const {
  return static_cast<double>(scene.motion.frames() - 1) / scene.motion.rate_hz;
}

Stage::Instant Stage::At(double t_s) const {
  const double into_s = repeats ? std::fmod(t_s, duration_s()) : std::min(t_s, duration_s());
  const double place = std::max(0.0, into_s) * scene.motion.rate_hz;
  const Eigen::Index frame = std::min(static_cast<Eigen::Index>(place), scene.motion.frames() - 2);
  return {frame, place - static_cast<double>(frame)};
}

sensors::FootForce Stage::FootAt(std::size_t foot, double t_s) const {
  const Instant at = At(t_s);
  const auto frame = static_cast<std::size_t>(at.frame);
  const sensors::FootForce &a = feet[frame][foot], &b = feet[frame + 1][foot];
  sensors::FootForce out;
  out.load_n = (1 - at.share) * a.load_n + at.share * b.load_n;
  out.cop_m = (1 - at.share) * a.cop_m + at.share * b.cop_m;
  if (out.load_n > 1e-6)
    out.cop_m = ((1 - at.share) * a.load_n * a.cop_m + at.share * b.load_n * b.cop_m) / out.load_n;
  return out;
}

Result<std::shared_ptr<const Stage>> MakeStage(const StageOptions& options) {
  const bool made = !IsPath(options.motion) || options.motion.ends_with(".json");
  Stage stage;
  auto scene = made ? PerformScript(options, stage.repeats) : LoadRecording(options);
  if (!scene) return scene.error();
  stage.scene = *std::move(scene);
  stage.feet = sensors::ShareThroughout(
      stage.scene, [](double done) { log::Info(Text("forces: %.0f %%", 100 * done)); });
  const Eigen::Vector2d start =
      0.5 * (SoleMiddle(stage.scene.course, 0, 0) + SoleMiddle(stage.scene.course, 1, 0)).head<2>();
  Move(-start, stage);
  if (start.norm() > kReportedOffsetM) {
    log::Info("moved by" + Text(" %.3f m ahead", -start.x()) +
              Text(", %.3f m to the left", -start.y()) + ", so that its feet start " +
              (options.on_boards ? "on the boards" : "about the origin"));
  }
  stage.boards = sensors::OneFootEach(stage.gap_m);
  if (options.on_boards) {
    if (options.place_boards) FitBoards(stage);
    stage.outside_share = OutsideShare(stage);
    LogPlacement(stage, options.place_boards);
  }
  return std::make_shared<const Stage>(std::move(stage));
}

}  // namespace footing::stream_client

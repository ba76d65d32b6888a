#include "common/virtual/options/load.h"

#include <cstdint>
#include <cstdio>
#include <span>
#include <utility>

#include "common/base/text.h"
#include "common/body/body.h"
#include "common/body/landmarks.h"
#include "common/runtime/files.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/marker_fit.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

namespace footing::motion_files {
namespace {

constexpr std::size_t kMostBytes = 512u << 20;
constexpr double kFastestMps = 100;  // Speed of a root, ten times that of a sprinter.

Result<std::string> Read(const std::string& path) { return config::ReadTextFile(path, kMostBytes); }

/// "trc" of "a/b.TRC".
std::string Ending(const std::string& path) {
  const auto dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] == '/') return "";
  return text::Lower(path.substr(dot + 1));
}

bool IsMarkerFile(const std::string& ending) { return ending == "trc" || ending == "c3d"; }

Result<motion::C3d> ReadC3d(const std::string& path) {
  const auto text = Read(path);
  if (!text) return text.error();
  return motion::ParseC3d({reinterpret_cast<const std::uint8_t*>(text->data()), text->size()},
                          path);
}

/// Up as the file says it, or as the markers have it.
motion::FileAxes AxesOf(const motion::C3d& c3d) {
  if (c3d.y_screen == "+Z") return motion::FileAxes::kZUp;
  if (c3d.y_screen == "+Y") return motion::FileAxes::kYUp;
  return motion::GuessAxes(c3d.points);
}

Result<LoadedMotion> FromMarkers(const std::string& path, const LoadOptions& options) {
  const auto tracks = LoadMarkers(path);
  if (!tracks) return tracks.error();
  motion::MarkerTracks still;
  motion::MarkerFitOptions fit_options{.set = options.marker_set, .sex = options.sex};
  if (!options.still.empty()) {
    auto read = LoadMarkers(options.still);
    if (!read) return read.error();
    still = *std::move(read);
    fit_options.still = &still;
  }
  auto fit = motion::FitMarkers(*tracks, fit_options);
  if (!fit) return Error{fit.error().kind, path + ": " + fit.error().message};
  char note[160];
  std::snprintf(note, sizeof note, "%zu markers of set %s fitted: height %.2f m, residual %.1f mm",
                fit->markers.size(), fit->set.c_str(), fit->height_m, 1000 * fit->rms_m);
  return LoadedMotion{motion::Canonical(std::move(fit->motion)), note, fit->height_m};
}

/// The motion, read as centimetres, with lengths `ratio` times as long.
motion::Motion Scaled(motion::Motion motion, double ratio) {
  for (body::Joint& joint : motion.skeleton.joints) joint.offset_m *= ratio;
  motion.q.topRows<3>() *= ratio;
  return motion;
}

/// In the unit that makes a person of it; as it is where its joints have names that nobody knows.
Result<LoadedMotion> InLikelyUnit(motion::Motion centimetres, const std::string& path) {
  constexpr std::pair<double, const char*> kUnits[] = {
      {1, ""}, {100, "metres"}, {0.1, "millimetres"}, {2.54, "inches"}};
  const auto landmarks = body::FindLandmarks(centimetres.skeleton);
  if (!landmarks) return LoadedMotion{std::move(centimetres), "", std::nullopt};
  const double height_m =
      body::EstimateHeight(centimetres.skeleton, *landmarks, body::PersonParameters{});
  for (const auto& [ratio, name] : kUnits) {
    if (height_m * ratio < 0.9 || height_m * ratio > 2.3) continue;
    if (ratio == 1) return LoadedMotion{std::move(centimetres), "", std::nullopt};
    char note[120];
    std::snprintf(note, sizeof note, "lengths taken for %s: a person of %.2f m", name,
                  height_m * ratio);
    return LoadedMotion{Scaled(std::move(centimetres), ratio), note, std::nullopt};
  }
  char text[200];
  std::snprintf(text, sizeof text,
                ": in centimetres the skeleton is a person of %.3g m, and in metres, millimetres "
                "or inches no likelier one: give the length of its unit with --bvh-unit-m",
                height_m);
  return InvalidData(path + text);
}

Result<LoadedMotion> FromBvh(const std::string& text, const std::string& path,
                             std::optional<double> unit_m) {
  auto motion = motion::ParseBvh(text, path, {.unit_m = unit_m.value_or(0.01)});
  if (!motion) return motion.error();
  motion::Motion canonical = motion::Canonical(motion::WithoutHalfTurns(*std::move(motion)));
  if (unit_m) return LoadedMotion{std::move(canonical), "", std::nullopt};
  return InLikelyUnit(std::move(canonical), path);
}

Result<LoadedMotion> ReadMotion(const std::string& path, const LoadOptions& options) {
  if (!IsMotionFile(path)) {
    return UsageError(path + ": not a motion file: expected .bvh, .amc, .trc or .c3d");
  }
  const std::string ending = Ending(path);
  if (IsMarkerFile(ending)) return FromMarkers(path, options);
  if (!options.still.empty()) {
    return UsageError(path + ": has no markers, so --still " + options.still +
                      " would have no effect; leave it out");
  }
  const auto text = Read(path);
  if (!text) return text.error();
  if (ending == "bvh") return FromBvh(*text, path, options.bvh_unit_m);
  if (options.skeleton.empty()) {
    return UsageError(path + ": an AMC file needs its skeleton: give --skeleton FILE.asf");
  }
  const auto asf_text = Read(options.skeleton);
  if (!asf_text) return asf_text.error();
  const auto asf = motion::ParseAsf(*asf_text, options.skeleton);
  if (!asf) return asf.error();
  auto motion = motion::ParseAmc(*text, path, *asf, options.amc_rate_hz);
  if (!motion) return motion.error();
  return LoadedMotion{motion::Canonical(motion::WithoutHalfTurns(*std::move(motion))), "",
                      std::nullopt};
}

/// A recording may lose its person for a moment, but nobody moves like that.
Result<void> CheckSteps(const motion::Motion& motion, const std::string& path) {
  for (Eigen::Index i = 1; i < motion.frames(); ++i) {
    const double step_m = (motion.q.col(i) - motion.q.col(i - 1)).head<3>().norm();
    if (step_m * motion.rate_hz <= kFastestMps) continue;
    char text[160];
    std::snprintf(text, sizeof text,
                  ": the root moves by %.3g m between frames %td and %td (%.3f s), a fault of the "
                  "recording; cut it there or repair it",
                  step_m, i, i + 1, motion.start_s + static_cast<double>(i) / motion.rate_hz);
    return InvalidData(path + text);
  }
  return {};
}

}  // namespace

bool IsMotionFile(const std::string& path) {
  const std::string ending = Ending(path);
  return IsMarkerFile(ending) || ending == "bvh" || ending == "amc";
}

Result<LoadedMotion> LoadMotion(const std::string& path, const LoadOptions& options) {
  auto loaded = ReadMotion(path, options);
  if (!loaded) return loaded;
  if (const auto steady = CheckSteps(loaded->motion, path); !steady) return steady.error();
  return loaded;
}

Result<motion::MarkerTracks> LoadMarkers(const std::string& path) {
  const std::string ending = Ending(path);
  if (ending == "c3d") {
    auto c3d = ReadC3d(path);
    if (!c3d) return c3d.error();
    const motion::FileAxes axes = AxesOf(*c3d);  // Before the points are moved away.
    return motion::ToWorld(axes, std::move(c3d->points));
  }
  if (ending != "trc") return UsageError(path + ": no markers: expected .trc or .c3d");
  const auto text = Read(path);
  if (!text) return text.error();
  auto tracks = motion::ParseTrc(*text, path);
  if (!tracks) return tracks.error();
  const motion::FileAxes axes = motion::GuessAxes(*tracks);
  return motion::ToWorld(axes, *std::move(tracks));
}

Result<motion::GroundForces> LoadForces(const std::string& path) {
  const std::string ending = Ending(path);
  if (ending == "c3d") {
    const auto c3d = ReadC3d(path);
    if (!c3d) return c3d.error();
    auto forces = motion::ToGroundForces(*c3d, path);
    if (!forces) return forces.error();
    for (motion::PlateForces& plate : forces->plates) {
      for (Eigen::Matrix3Xd* track : {&plate.force_W, &plate.cop_W, &plate.moment_W}) {
        for (Eigen::Index i = 0; i < track->cols(); ++i) {
          track->col(i) = motion::ToWorld(AxesOf(*c3d), Eigen::Vector3d(track->col(i)));
        }
      }
    }
    return forces;
  }
  if (ending != "mot" && ending != "sto") {
    return UsageError(path + ": no ground forces: expected .mot, .sto or .c3d");
  }
  const auto text = Read(path);
  if (!text) return text.error();
  const auto table = motion::ParseTable(*text, path);
  if (!table) return table.error();
  return motion::ToGroundForces(*table, path);
}

}  // namespace footing::motion_files

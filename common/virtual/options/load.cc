#include "common/virtual/options/load.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/landmarks.h"
#include "common/runtime/files.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/motion/marker_fit.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

namespace footing::motion_files {
namespace {

constexpr std::size_t kMostBytes = 512u << 20;
constexpr double kLongestBoneM = 1.3;  // Pelvis to C7 in one bone, of a person of 2.3 m.
constexpr double kAlong = 0.8;         // Mean cosine of a body that stands along an axis, at least.
constexpr double kFloorM = 0.3;        // Height of ankles that stand on the floor of their file.

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

/// A recording may lose its person for a moment, but nobody moves like that.
Result<void> CheckSteps(const motion::Motion& motion, const std::string& path) {
  for (Eigen::Index i = 1; i < motion.frames(); ++i) {
    const double step_m = (motion.q.col(i) - motion.q.col(i - 1)).head<3>().norm();
    const auto good = motion::CheckStep(step_m, motion.rate_hz, motion.start_s, i, "the root");
    if (!good) return Error{good.error().kind, path + ": " + good.error().message};
  }
  return {};
}

/// Bones between the landmarks of a person; other joints, such as those of props, may be anywhere,
/// and ends, of which only the direction counts.
Result<void> CheckBones(const motion::Motion& motion, const std::string& path) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return {};
  for (int joint : landmarks->joint) {
    for (; joint > 0; joint = motion.skeleton.joint(joint).parent) {
      const body::Joint& bone = motion.skeleton.joint(joint);
      const bool on_floor = joint == (*landmarks)[body::Landmark::kHips];
      if (on_floor || body::IsEnd(motion.skeleton, joint)) continue;
      if (bone.offset_m.norm() <= kLongestBoneM) continue;
      char text[120];
      std::snprintf(text, sizeof text, " is %.3g m from its parent, and no person has such a bone",
                    bone.offset_m.norm());
      return InvalidData(path + ": joint " + bone.name + text +
                         "; repair it, or check the unit of the file's lengths");
    }
  }
  return {};
}

/// The motion, read as centimetres, with lengths `ratio` times as long.
motion::Motion Scaled(motion::Motion motion, double ratio) {
  for (body::Joint& joint : motion.skeleton.joints) joint.offset_m *= ratio;
  motion.q.topRows<3>() *= ratio;
  return motion;
}

/// In the unit that makes a person of it; as it is where its joints have names that nobody knows.
Result<LoadedMotion> InLikelyUnit(motion::Motion centimetres, const std::string& path) {
  constexpr std::pair<double, const char*> kUnits[] = {{1, ""},
                                                       {100, "metres"},
                                                       {0.1, "millimetres"},
                                                       {2.54 / 0.45, "CMU's units of 5.64 cm"},
                                                       {2.54, "inches"}};
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
  char text[240];
  std::snprintf(text, sizeof text,
                ": in centimetres the skeleton is a person of %.3g m, and in metres, millimetres, "
                "inches or CMU's units no likelier one: give the length of its unit with "
                "--bvh-unit-m",
                height_m);
  return InvalidData(path + text);
}

/// From ankles to neck in W, and the ankles' place: of a pose.
struct Stand {
  Eigen::Vector3d up, ankles_m;
};
Stand StandOf(const motion::Motion& motion, const body::Landmarks& landmarks,
              const Eigen::VectorXd& q) {
  body::Kinematics at(motion.skeleton);
  body::ComputeKinematics(motion.skeleton, q, at);
  const auto place = [&](body::Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
  };
  const Eigen::Vector3d ankles_m =
      (place(body::Landmark::kLeftAnkle) + place(body::Landmark::kRightAnkle)) / 2;
  return {(place(body::Landmark::kNeck) - ankles_m).normalized(), ankles_m};
}

/// The motion with the file's z, which ParseBvh() reads as W's x, as W's z. Where the skeleton at
/// rest stands along it too, so does its rest, or else only the root is turned.
motion::Motion ZUp(motion::Motion motion, bool with_rest) {
  const Eigen::Matrix3d turn = body::AxisRotation(body::Axis::kY, -kPi / 2);
  const body::Skeleton before = motion.skeleton;
  // Turned by this, x is z and z is -x: a rotation about x is one about z, and one about z one
  // about x by the negative angle.
  if (with_rest) {
    for (body::Joint& joint : motion.skeleton.joints) {
      joint.offset_m = turn * joint.offset_m;
      for (std::size_t i = 0; i < joint.rotations.size(); ++i) {
        body::Rotation& rotation = joint.rotations[i];
        if (rotation.axis == body::Axis::kY) continue;
        if (rotation.axis == body::Axis::kZ) {
          motion.q.row(joint.first_dof + static_cast<Eigen::Index>(i)) *= -1;
        }
        rotation.axis = rotation.axis == body::Axis::kX ? body::Axis::kZ : body::Axis::kX;
      }
    }
  }
  const body::Joint& root = motion.skeleton.joint(0);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    Eigen::VectorXd q = motion.q.col(i);
    q.head<3>() = turn * Eigen::Vector3d(q.head<3>());
    if (!with_rest) body::SetJointRotation(root, turn * body::JointRotation(root, q), q);
    motion.q.col(i) = q;
  }
  return motion;
}

/// A person who stands along the file's z, with feet on its floor, is stood up. A note says so, and
/// of one who lies in another way or place, too.
LoadedMotion StoodUp(LoadedMotion loaded) {
  constexpr Eigen::Index kSamples = 50;
  const motion::Motion& motion = loaded.motion;
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks || motion.frames() == 0) return loaded;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  std::vector<double> heights_m;
  const Eigen::Index step = std::max<Eigen::Index>(1, motion.frames() / kSamples);
  for (Eigen::Index i = 0; i < motion.frames(); i += step) {
    const Stand stand = StandOf(motion, *landmarks, motion.q.col(i));
    up += stand.up;
    heights_m.push_back(std::abs(stand.ankles_m.x()));
  }
  up /= static_cast<double>(heights_m.size());
  const auto add = [&loaded](const char* note) {
    loaded.note += (loaded.note.empty() ? "" : "; ") + std::string(note);
  };
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(motion.skeleton.dof);
  const bool with_rest = StandOf(motion, *landmarks, rest).up.x() > kAlong;
  if (up.x() > kAlong && (with_rest || text::Median(std::move(heights_m)) < kFloorM)) {
    loaded.motion = ZUp(std::move(loaded.motion), with_rest);
    add("the person stands along z: z taken for up");
  } else if (std::abs(up.z()) < 1 - kAlong) {
    add("the person lies or hangs in most of it: is y up in this file?");
  }
  return loaded;
}

Result<LoadedMotion> FromBvh(const std::string& text, const std::string& path,
                             std::optional<double> unit_m) {
  auto motion = motion::ParseBvh(text, path, {.unit_m = unit_m.value_or(0.01)});
  if (!motion) return motion.error();
  Result<LoadedMotion> loaded = LoadedMotion{*std::move(motion), "", std::nullopt};
  if (!unit_m) loaded = InLikelyUnit(std::move(loaded->motion), path);
  if (!loaded) return loaded;
  *loaded = StoodUp(*std::move(loaded));
  loaded->motion = motion::Canonical(motion::WithoutHalfTurns(std::move(loaded->motion)));
  return loaded;
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

}  // namespace

bool IsMotionFile(const std::string& path) {
  const std::string ending = Ending(path);
  return IsMarkerFile(ending) || ending == "bvh" || ending == "amc";
}

Result<LoadedMotion> LoadMotion(const std::string& path, const LoadOptions& options) {
  auto loaded = ReadMotion(path, options);
  if (!loaded) return loaded;
  if (const auto possible = CheckBones(loaded->motion, path); !possible) return possible.error();
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

#include "daemon/offline/eval/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/cli/cli.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/files.h"
#include "common/virtual/motion/body_files.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/joint_angles.h"
#include "common/virtual/options/load.h"
#include "daemon/offline/analysis/angle_score.h"
#include "daemon/offline/eval/pose_scene.h"
#include "daemon/offline/eval/pose_scores.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostTableBytes = 256u << 20;
constexpr double kBackwardsKneeDeg = -5;  // Mean of a knee that bends by negative angles.

struct ReconstructFlags {
  PoseFlags pose;
  std::string ik, out;
  std::vector<std::string> formats = {"mot", "trc", "c3d", "bvh"};
  bool force = false;
};

/// A motion in the laboratory's W and on its clock, with what its files need.
struct BodyTrack {
  motion::Motion motion;
  std::vector<bool> valid;
  std::vector<motion::FootForces> forces;  ///< Empty: not measured.

  std::vector<double> times_s() const {
    std::vector<double> times;
    for (Eigen::Index i = 0; i < motion.frames(); ++i) {
      times.push_back(motion.start_s + static_cast<double>(i) / motion.rate_hz);
    }
    return times;
  }
};

/// The engine's pose of each frame of the clip, and the true one at the same times.
struct Reconstructed {
  BodyTrack engine, truth;
};

Result<Reconstructed> Reconstruct(const pose_run::PoseRun& run, const Placement& placement,
                                  const reconstruction::Models& models,
                                  const reconstruction::Options& options, double begin_s) {
  auto made = reconstruction::Reconstruction::Create(run.body, models, options);
  if (!made) return made.error();
  const auto lag = static_cast<std::size_t>(std::lround(options.lag_s * options.rate_hz));
  std::vector<Eigen::VectorXd> poses, true_poses;
  Reconstructed out;
  motion::Motion& motion = out.engine.motion;
  motion.skeleton = run.body.skeleton;
  motion.rate_hz = run.rate_hz;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const auto& output = made->Advance(run.frames[i].inputs);
    if (i < run.judged_from + lag) continue;
    if (!output.calibrated) {
      return InvalidData("the T-pose never stood still on the plates: no calibration");
    }
    const pose_run::Frame& then = run.frames[i - lag];
    const double time_s = then.inputs.loads.time_s + run.clock_offset_s;
    if (time_s < begin_s) continue;
    if (poses.empty()) motion.start_s = time_s;
    poses.push_back(placement.Pose(motion.skeleton, output.q));
    true_poses.push_back(placement.Pose(motion.skeleton, then.q));
    out.engine.valid.push_back(output.valid);
    motion::FootForces& forces = out.engine.forces.emplace_back();
    for (std::size_t foot = 0; foot < forces.size(); ++foot) {
      const Eigen::Vector2d& cop_m = then.feet[foot].cop_m;
      if (!(then.feet[foot].load_n > pose_run::kLoadedN) || !cop_m.allFinite()) continue;
      Eigen::Vector3d cop_W = placement.Place({cop_m.x(), cop_m.y(), 0});
      cop_W.z() = 0;
      forces[foot] = {then.feet[foot].load_n, cop_W};
    }
  }
  if (poses.empty()) return InvalidData("no frame after the T-pose");
  out.truth.motion = motion;
  const auto fill = [](const std::vector<Eigen::VectorXd>& from, motion::Motion& to) {
    to.q.resize(to.skeleton.dof, static_cast<Eigen::Index>(from.size()));
    for (std::size_t i = 0; i < from.size(); ++i) to.q.col(static_cast<Eigen::Index>(i)) = from[i];
  };
  fill(poses, motion);
  fill(true_poses, out.truth.motion);
  out.truth.valid.assign(poses.size(), true);
  return out;
}

Result<motion::Table> Angles(const BodyTrack& track) {
  auto table = joint_angles::JointAngles(track.motion);
  if (!table) return table;
  table->values.col(0).array() += track.motion.start_s;
  return table;
}

/// One file, by its format; empty text where the track has nothing for it.
Result<std::string> FileText(const BodyTrack& track, const std::string& format,
                             const std::string& name) {
  if (format == "bvh") return motion::WriteBvh(track.motion);
  if (format == "trc") {
    motion::MarkerTracks places = motion::JointPlaces(track.motion, track.valid);
    places.start_s = track.motion.start_s;
    return motion::WriteTrc(places, name);
  }
  if (format == "c3d") return motion::WriteC3d(ToC3d(track.motion, track.valid, track.forces));
  auto table = Angles(track);
  if (!table) return table.error();
  table->name = name;
  return motion::WriteTable(*table);
}

/// Writes the files of a track, NAME.FORMAT; returns their paths.
Result<std::vector<std::string>> WriteTrack(const BodyTrack& track, const ReconstructFlags& flags,
                                            const std::string& name) {
  std::vector<std::pair<std::string, std::string>> texts;
  for (const std::string& format : flags.formats) {
    auto text = FileText(track, format, name + "." + format);
    if (!text) return text.error();
    texts.emplace_back(name + "." + format, *std::move(text));
    if (format != "mot") continue;
    const auto angles = Angles(track);
    if (!angles) return angles.error();
    auto csv = motion::AnglesCsv(*angles, track.valid);
    if (!csv) return csv.error();
    texts.emplace_back(name + "_angles.csv", *std::move(csv));
    if (track.forces.empty()) continue;
    motion::Table forces = motion::ForceTable(track.forces, track.motion.rate_hz);
    forces.values.col(0).array() += track.motion.start_s;
    forces.name = name + "_grf.mot";
    texts.emplace_back(forces.name, motion::WriteTable(forces));
  }
  std::vector<std::string> paths;
  for (const auto& [file, text] : texts) {
    const std::string path = (std::filesystem::path(flags.out) / file).string();
    auto out = recording::OutputFile::Create(path, flags.force);
    if (!out) return out.error();
    if (const auto written = out->Write(text); !written) return written.error();
    paths.push_back(path);
  }
  return paths;
}

/// Angles of `is` against `should`, in which the person's standing is looked for.
Result<ordered_json> Compare(const motion::Table& is, const motion::Table& should,
                             const std::vector<bool>& valid) {
  return CompareAngles(is, should, valid, 0);
}

/// The tables of errors, of each pair that there is.
Result<ordered_json> ErrorTables(const Reconstructed* engine, const BodyTrack& markers,
                                 const ReconstructFlags& flags) {
  ordered_json json = ordered_json::object();
  std::optional<motion::Table> ik;
  if (!flags.ik.empty()) {
    const auto text = config::ReadTextFile(flags.ik, kMostTableBytes);
    if (!text) return text.error();
    auto table = motion::ParseTable(*text, flags.ik);
    if (!table) return table.error();
    ik = *std::move(table);
  }
  const auto add = [&](const char* name, const motion::Table& is, const motion::Table& should,
                       const std::vector<bool>& valid) -> Result<void> {
    const auto compared = Compare(is, should, valid);
    if (!compared) return compared.error();
    json[name] = *compared;
    return {};
  };
  const auto of_markers = Angles(markers);
  if (!of_markers) return of_markers.error();
  if (ik) {
    const auto lab = AnglesAt(*ik, markers.times_s(), flags.ik);
    if (!lab) return lab.error();
    if (auto done = add("markers_against_ik", *of_markers, *lab, markers.valid); !done) {
      return done.error();
    }
  }
  if (engine == nullptr) return json;
  const auto of_engine = Angles(engine->engine);
  if (!of_engine) return of_engine.error();
  const auto truth = joint_angles::JointAngles(engine->truth.motion, &engine->engine.motion);
  if (!truth) return truth.error();
  if (auto done = add("engine_against_markers", *of_engine, *truth, engine->engine.valid); !done) {
    return done.error();
  }
  if (!ik) return json;
  const auto lab = AnglesAt(*ik, engine->engine.times_s(), flags.ik);
  if (!lab) return lab.error();
  if (auto done = add("engine_against_ik", *of_engine, *lab, engine->engine.valid); !done) {
    return done.error();
  }
  return json;
}

Result<ordered_json> Run(ReconstructFlags flags) {
  PoseFlags& pose = flags.pose;
  const bool plates = !pose.scene.forces.empty();
  pose.boards = plates ? "forces" : "simulated";
  pose.hands = "points";
  pose.scene.settings.hand_noise_m = 0;  // The hands are the laboratory's own markers.
  if (const auto translated = Translate(pose); !translated) return translated.error();
  auto loaded = LoadScene(pose.scene);
  if (!loaded) return loaded.error();
  std::error_code error;
  std::filesystem::create_directories(flags.out, error);
  if (error) return Failure("cannot make folder " + flags.out + ": " + error.message());
  const std::string stem = std::filesystem::path(pose.scene.motion).stem().string();
  BodyTrack markers{loaded->motion,
                    std::vector<bool>(static_cast<std::size_t>(loaded->motion.frames()), true),
                    {}};
  ordered_json json = {{"note", loaded->note}};
  std::optional<Reconstructed> engine;
  if (plates) {
    const auto models = ReadPoseModels(pose.models, pose.scene.motion, pose.same_person);
    if (!models) return models.error();
    const auto run = MakePlateScene(pose.scene, *loaded);
    if (!run) return run.error();
    for (const std::string& warning : run->report.warnings) {
      std::cerr << "warning: " << pose.scene.forces << ": " << warning << "\n";
    }
    auto made = Reconstruct(run->measured, PlacementOf(run->measured, loaded->motion), *models,
                            pose.options, run->report.begin_s);
    if (!made) return Error{made.error().kind, pose.scene.motion + ": " + made.error().message};
    engine = *std::move(made);
    json["begin_s"] = engine->engine.motion.start_s;
    json["frames"] = engine->engine.motion.frames();
    json["invalid_frames"] =
        std::count(engine->engine.valid.begin(), engine->engine.valid.end(), false);
    json["lag_ms"] = pose.lag_ms;
  }
  const auto errors = ErrorTables(engine ? &*engine : nullptr, markers, flags);
  if (!errors) return errors.error();
  const auto of_markers = WriteTrack(markers, flags, stem + "_markers");
  if (!of_markers) return of_markers.error();
  json["files"] = *of_markers;
  if (engine) {
    const auto of_engine = WriteTrack(engine->engine, flags, stem + "_engine");
    if (!of_engine) return of_engine.error();
    for (const std::string& path : *of_engine) json["files"].push_back(path);
  }
  json["errors"] = *errors;
  return json;
}

/// For people: a row for each angle, change from standing first.
void Print(const ordered_json& json) {
  if (const std::string note = json.at("note"); !note.empty()) std::cout << note << "\n";
  for (const auto& [pair, tables] : json.at("errors").items()) {
    std::string name = pair;
    std::replace(name.begin(), name.end(), '_', ' ');
    std::cout << "\n" << name << ", degrees: RMS of the change from standing; absolute (mean)\n";
    const ordered_json none = ordered_json::object();
    const ordered_json& change =
        tables.contains("angles_since_standing") ? tables.at("angles_since_standing") : none;
    for (const auto& [angle, entry] : tables.at("joint_angles").items()) {
      const bool known = change.contains(angle) && change.at(angle).contains("rmse_deg");
      char line[120];
      std::snprintf(
          line, sizeof line, "%-18s %s %7.1f (%.1f)\n", angle.c_str(),
          known ? text::Fixed(change.at(angle).at("rmse_deg").get<double>(), 1).c_str() : "-",
          entry.at("rmse_deg").get<double>(), entry.at("mean_error_deg").get<double>());
      std::cout << line;
    }
    if (change.empty()) std::cout << "no standing still in this trial: no change from it\n";
  }
  std::cout << "\n";
  for (const auto& path : json.at("files")) std::cout << path.get<std::string>() << "\n";
}

}  // namespace

Eigen::Vector3d Placement::Place(const Eigen::Vector3d& p_W) const {
  return body::AxisRotation(body::Axis::kZ, yaw_rad) * p_W + shift_m;
}

Eigen::VectorXd Placement::Pose(const body::Skeleton& skeleton, Eigen::VectorXd q) const {
  const body::Joint& root = skeleton.joint(0);
  q.head<3>() = Place(q.head<3>());
  body::SetJointRotation(
      root, body::AxisRotation(body::Axis::kZ, yaw_rad) * body::JointRotation(root, q), q);
  return q;
}

Placement PlacementOf(const pose_run::PoseRun& run, const motion::Motion& motion) {
  const body::Joint &root = motion.skeleton.joint(0), &run_root = run.body.skeleton.joint(0);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> places;
  for (std::size_t i = run.judged_from; i < run.frames.size(); ++i) {
    const pose_run::Frame& frame = run.frames[i];
    const double column =
        (frame.inputs.loads.time_s + run.clock_offset_s - motion.start_s) * motion.rate_hz;
    if (column < 0 || column > static_cast<double>(motion.frames() - 1)) continue;
    const Eigen::VectorXd q = motion.q.col(std::lround(column));
    turn += body::JointRotation(root, q) * body::JointRotation(run_root, frame.q).transpose();
    places.emplace_back(q.head<3>(), frame.q.head<3>());
  }
  Placement placement;
  if (places.empty()) return placement;
  placement.yaw_rad = std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [of_motion, of_run] : places) sum += of_motion - placement.Place(of_run);
  placement.shift_m = sum / static_cast<double>(places.size());
  return placement;
}

Result<motion::Table> AnglesAt(const motion::Table& table, const std::vector<double>& times_s,
                               const std::string& file) {
  const int time = motion::FindColumn(table, "time");
  const Eigen::Index rows = table.values.rows();
  if (time < 0 || rows < 2) return InvalidData(file + ": no column time, or fewer than two rows");
  const Eigen::VectorXd own_s = table.values.col(time);
  const double slack_s = (own_s(rows - 1) - own_s(0)) / static_cast<double>(rows - 1);
  if (times_s.front() < own_s(0) - slack_s || times_s.back() > own_s(rows - 1) + slack_s) {
    return InvalidData(file + ": its times, " + text::Fixed(own_s(0), 2) + " to " +
                       text::Fixed(own_s(rows - 1), 2) + " s, do not cover the trial's, " +
                       text::Fixed(times_s.front(), 2) + " to " + text::Fixed(times_s.back(), 2) +
                       " s");
  }
  motion::Table out = table;
  out.in_degrees = true;
  out.values.resize(static_cast<Eigen::Index>(times_s.size()), table.values.cols());
  Eigen::Index before = 0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    while (before + 2 < rows && own_s(before + 1) <= times_s[i]) ++before;
    const double step_s = own_s(before + 1) - own_s(before);
    const double share =
        step_s > 0 ? std::clamp((times_s[i] - own_s(before)) / step_s, 0.0, 1.0) : 0;
    out.values.row(static_cast<Eigen::Index>(i)) =
        (1 - share) * table.values.row(before) + share * table.values.row(before + 1);
  }
  for (std::size_t column = 0; column < out.columns.size(); ++column) {
    auto values = out.values.col(static_cast<Eigen::Index>(column));
    const std::string& name = out.columns[column];
    const bool angle = name != "time" && name.rfind("pelvis_t", 0) != 0;
    if (!table.in_degrees && (angle || name == "pelvis_tilt")) values *= 180 / kPi;
    if (name.rfind("knee_angle", 0) == 0 && values.mean() < kBackwardsKneeDeg) values *= -1;
  }
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    out.values(static_cast<Eigen::Index>(i), time) = times_s[i];
  }
  return out;
}

void AddReconstructCommand(CLI::App& app, Shared& shared) {
  auto flags = std::make_shared<ReconstructFlags>();
  flags->pose.lag_ms = 200;
  CLI::App* command = app.add_subcommand(
      "reconstruct",
      "The pose of the body from a laboratory's markers and force plates, written as motion files, "
      "with its errors against the laboratory's inverse kinematics");
  PoseSceneOptions& scene = flags->pose.scene;
  AddMotionOptions(*command, scene);
  command->add_option("--forces", scene.forces,
                      "Forces of the plates, MOT, STO or C3D: the engine reconstructs from these "
                      "and the hands (default: only the body is fitted to the markers)");
  command->add_option("--still-forces", scene.still_forces,
                      "Forces under --still (MOT, STO or C3D), to place the plates under the body");
  command->add_option("--mass-kg", scene.settings.mass_kg, "Mass of the body, kg")
      ->check(CLI::Range(20.0, 250.0));
  command->add_option("--ik", flags->ik,
                      "Joint angles of the laboratory, MOT or STO of OpenSim, to compare with");
  command->add_option("--model", flags->pose.models,
                      "Model file, *.fmodel; may be repeated (default: built in)");
  command->add_flag("--same-person", flags->pose.same_person,
                    "Accept models trained on other takes of the tested person");
  command
      ->add_option("--lag-ms", flags->pose.lag_ms,
                   "Time after a frame that its pose may use, ms, 0 to 200 (default 200)")
      ->check(CLI::Range(0.0, 200.0));
  command->add_option("--out", flags->out, "Folder of the files")->required();
  command
      ->add_option("--format", flags->formats,
                   "Format of the files: mot, trc, c3d or bvh; may be repeated (default: all)")
      ->check(CLI::IsMember({"mot", "trc", "c3d", "bvh"}));
  command->add_flag("--force", flags->force, "Overwrite existing files");
  command->footer(
      "Examples:\n"
      "  footing-eval reconstruct --motion squats.trc --still static.trc --out poses\n"
      "  footing-eval reconstruct --motion squats.trc --still static.trc --forces squats_grf.mot "
      "--mass-kg 60 --ik squats_ik.mot --out poses --json");
  command->callback([flags, &shared] {
    const auto out = Run(*flags);
    if (!out) {
      shared.exit_code = cli::Report(out.error());
    } else if (shared.json) {
      std::cout << text::ToText(*out) << "\n";
    } else {
      Print(*out);
    }
  });
}

}  // namespace footing::eval

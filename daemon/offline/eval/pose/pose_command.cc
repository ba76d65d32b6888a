#include "daemon/offline/eval/pose/pose_command.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/units/units.h"
#include "common/virtual/motion/standard_layout.h"
#include "common/virtual/sensor_options/sensor_options.h"
#include "daemon/offline/eval/pose/ablations.h"
#include "daemon/offline/eval/pose/baselines.h"
#include "daemon/offline/eval/pose/claims.h"
#include "daemon/offline/eval/pose/constants.h"
#include "daemon/offline/eval/pose/figures.h"
#include "daemon/offline/eval/pose/insoles.h"
#include "daemon/offline/eval/pose/motion_options.h"
#include "daemon/offline/eval/pose/plates.h"
#include "daemon/offline/eval/pose/scene.h"
#include "daemon/offline/eval/pose/trial.h"

namespace footing::eval {
namespace {

using nlohmann::ordered_json;

struct Flags {
  PoseSceneOptions scene;
  reconstruction::Options options;
  std::vector<std::string> models, ablate, oracle, constants;
  std::string hands = "move", mode = "best", boards = "simulated";
  double lag_ms = 0, loop_minutes = 0, yaw_error_deg = 0, height_m = 0;
  std::string figures;
  bool baselines = true, ablations = false, claims = false, same_person = false;
};

bool Has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// What the strings say, into the options.
Result<void> Translate(Flags& flags) {
  pose_run::Settings& settings = flags.scene.settings;
  settings.hands = flags.hands != "none";
  if (flags.hands == "wiimote") settings.hand_device = pose_run::HandDevice::kWiimote;
  if (flags.hands == "straps") settings.hand_device = pose_run::HandDevice::kStraps;
  if (flags.hands == "kinect") settings.hand_device = pose_run::HandDevice::kKinect;
  if (settings.joints && (flags.hands != "kinect" || flags.boards != "simulated")) {
    return UsageError("--joints goes with --hands kinect and --boards simulated");
  }
  if (flags.boards == "insoles" && flags.hands != "move" && flags.hands != "none") {
    return UsageError("--boards insoles has --hands move and none, not " + flags.hands);
  }
  if (flags.boards == "forces" && (flags.hands == "wiimote" || flags.hands == "straps")) {
    return UsageError("--boards forces has --hands move, kinect and none, not " + flags.hands);
  }
  if ((flags.boards == "forces") == flags.scene.forces.empty()) {
    return UsageError("--boards forces and --forces FILE (.mot, .sto or .c3d) go together");
  }
  if (!flags.scene.still_forces.empty() &&
      (flags.boards != "forces" || flags.scene.still.empty())) {
    return UsageError("--still-forces goes with --boards forces and the --still that it is of");
  }
  if (flags.boards == "insoles" && !flags.scene.activities.empty()) {
    return UsageError("--activities is for boards: --boards insoles has no table by activity");
  }
  settings.loop_s = 60 * flags.loop_minutes;
  settings.yaw_error_rad = DegreesToRadians(flags.yaw_error_deg);
  if (flags.height_m > 0) settings.height_m = flags.height_m;
  settings.seed = settings.errors.seed;
  flags.options.rate_hz = settings.rate_hz;
  flags.options.lag_s = flags.lag_ms / 1000;
  flags.options.mode =
      flags.mode == "paper" ? reconstruction::Mode::kPaper : reconstruction::Mode::kBest;
  flags.options.use_momentum = !Has(flags.ablate, "momentum");
  flags.options.use_angular_momentum = !Has(flags.ablate, "angular_momentum");
  flags.options.clean_up = !Has(flags.ablate, "cleanup");
  flags.options.use_basis = !Has(flags.ablate, "basis");
  flags.options.use_posture = !Has(flags.ablate, "posture");
  return SetConstants(flags.constants, flags.options.best);
}

Result<ordered_json> Evaluate(Flags flags) {
  if (const auto translated = Translate(flags); !translated) return translated.error();
  if (flags.claims) {  // About the motion and equation (2): no models.
    const auto run = MakePoseScene(flags.scene);
    if (!run) return run.error();
    return ordered_json{{"claims", CheckClaims(*run)}};
  }
  const auto models = ReadPoseModels(flags.models, flags.scene.motion, flags.same_person);
  if (!models) return models.error();
  // A basis of the user's own may be of another layout.
  flags.scene.standard_layout = motion::IsStandardLayout(models->dofs);
  if (flags.boards == "insoles") {
    const auto walk = MakeInsoleScene(flags.scene);
    if (!walk) return walk.error();
    return ScoreInsoles(*walk, *models, flags.options);
  }
  std::optional<pose_run::PlateRun> plates;
  if (flags.boards == "forces") {
    auto made = MakePlateScene(flags.scene);
    if (!made) return made.error();
    plates = *std::move(made);
  }
  auto run = plates ? Result<pose_run::PoseRun>(plates->measured) : MakePoseScene(flags.scene);
  if (!run) return run.error();
  if (flags.hands == "wiimote" && !models->arm)
    return UsageError("--hands wiimote: give a model of kind arm too (footing-train arm)");
  if (flags.hands == "wiimote" || flags.hands == "straps")
    pose_run::EstimateArms(models->arm, *run);
  if (flags.ablations) {
    const auto rows = ScoreAblations(*run, *models, flags.options);
    if (!rows) return Error{rows.error().kind, flags.scene.motion + ": " + rows.error().message};
    return ordered_json{{"ablations", *rows}};
  }
  const Oracle oracle{Has(flags.oracle, "com"), Has(flags.oracle, "momentum"),
                      Has(flags.oracle, "feet")};
  auto json = RunPoseTrial(*run, *models, flags.options, oracle);
  if (!json) return Error{json.error().kind, flags.scene.motion + ": " + json.error().message};
  (*json)["mode"] = flags.mode;
  (*json)["hands"] = flags.hands;
  (*json)["boards"] = flags.boards;
  (*json)["boards_limited"] = flags.scene.settings.limited;
  (*json)["cop_outside_sensors_share"] = run->outside_share;
  if (plates) {
    const auto judged = ScorePlates(*plates, *models, flags.options, oracle);
    if (!judged) return judged.error();
    (*json)["plates"] = *judged;
  }
  if (!flags.figures.empty()) {
    const auto names = WriteFigures(*run, *models, flags.options, flags.figures);
    if (!names) return names.error();
    (*json)["figures"] = *names;
  }
  if (!flags.baselines) return json;
  const auto baselines = ScoreBaselines(*run, *models, flags.options, run->judged_from);
  if (!baselines) return baselines.error();
  (*json)["baselines"] = *baselines;
  return json;
}

/// One line; a table has one for each row.
void PrintField(const std::string& name, const ordered_json& value) {
  if (value.empty() || !value.is_array() || !value.front().is_object()) {
    std::cout << name << ": " << value.dump() << "\n";
    return;
  }
  std::cout << name << ":\n";
  for (const ordered_json& row : value) std::cout << "  " << row.dump() << "\n";
}

void AddFlags(CLI::App& command, Flags& flags) {
  pose_run::Settings& settings = flags.scene.settings;
  AddMotionOptions(command, flags.scene);
  command.add_option("--forces", flags.scene.forces,
                     "Measured forces for --boards forces: MOT, STO or C3D");
  command.add_option(
      "--still-forces", flags.scene.still_forces,
      "Measured forces under --still (MOT, STO or C3D), to place the plates under the body");
  command.add_option("--activities", flags.scene.activities,
                     "Activities, CSV begin_s,end_s,activity (default: detected from the motion)");
  command.add_option("--mass-kg", settings.mass_kg, "Mass of the body, kg")
      ->check(CLI::Range(20.0, 250.0));
  command.add_option("--height-m", flags.height_m, "Height of the body, m")
      ->check(CLI::Range(0.5, 2.6));
  command
      .add_option("--hands", flags.hands,
                  "Hand devices: move (positions, 1 cm noise), wiimote (attitudes of the fists), "
                  "straps (of the arms), kinect (late "
                  "positions), none")
      ->check(CLI::IsMember({"move", "wiimote", "straps", "kinect", "none"}));
  command.add_flag("--joints", settings.joints,
                   "With --hands kinect: all joints of its skeleton, hidden ones inferred");
  command
      .add_option("--boards", flags.boards,
                  "Board forces: simulated, forces (measured), or insoles")
      ->check(CLI::IsMember({"simulated", "forces", "insoles"}));
  command.add_option("--model", flags.models,
                     "Model file, *.fmodel; may be repeated (default: built in)");
  command.add_flag("--same-person", flags.same_person,
                   "Accept models trained on other takes of the tested person");
  command.add_option("--mode", flags.mode, "Reconstruction mode: paper or best")
      ->check(CLI::IsMember({"paper", "best"}));
  command.add_option("--rate-hz", settings.rate_hz, "Frame rate, Hz")
      ->check(CLI::Range(30.0, 120.0));
  command.add_option("--lag-ms", flags.lag_ms, "Output delay for smoothing, ms, 0 to 200")
      ->check(CLI::Range(0.0, 200.0));
  sensor_options::AddBoardErrors(command, settings.errors);
  command.add_option("--seed", settings.errors.seed, "Seed of the errors of sensors and hands");
  command
      .add_option("--gap-error-m", settings.gap_error_m,
                  "Error of the configured gap between the boards, m")
      ->check(CLI::Range(-0.2, 0.2));
  command
      .add_option("--yaw-error-deg", flags.yaw_error_deg,
                  "Error of the configured yaw of the right board, degrees")
      ->check(CLI::Range(-45.0, 45.0));
  command
      .add_option("--mass-error", settings.mass_error,
                  "Relative error of the mass measured in the T-pose; 0.02 is two percent")
      ->check(CLI::Range(-0.2, 0.2));
  command.add_flag("--limited", settings.limited, "End the boards at their sensors");
  command
      .add_option(
          "--loop-minutes", flags.loop_minutes,
          "Total duration, min: the motion is played forwards and backwards until then (0: once)")
      ->check(CLI::Range(0.0, 60.0));
  command
      .add_option("--ablate", flags.ablate,
                  "Part of the reconstruction to leave out; may be repeated")
      ->check(CLI::IsMember({"angular_momentum", "momentum", "cleanup", "basis", "posture"}));
  command.add_flag("--ablations", flags.ablations,
                   "Print the table of all ablations, in both modes");
  command.add_flag("--claims", flags.claims,
                   "Test the paper's statements about COM motion and outliers");
  command.add_option("--figures", flags.figures,
                     "Folder for plots in the form of the paper's figures");
  command
      .add_option("--oracle", flags.oracle,
                  "Quantity taken from the motion in place of its estimate; may be repeated")
      ->check(CLI::IsMember({"com", "momentum", "feet"}));
  command.add_option("--constant", flags.constants,
                     "Constant of the best mode, NAME=VALUE; may be repeated");
  command.add_flag("--baselines,!--no-baselines", flags.baselines,
                   "Compare with reconstructions from fewer measurements");
}

}  // namespace

void AddPoseCommand(CLI::App& app, Shared& shared) {
  auto* command = app.add_subcommand("pose",
                                     "Whole-body pose estimated from two boards and two hands "
                                     "under a motion, compared with the motion");
  const auto flags = std::make_shared<Flags>();
  flags->scene.settings.errors.noise_kg = 0.05;
  AddFlags(*command, *flags);
  command->footer(
      "Examples:\n"
      "  footing-eval pose --motion clip.bvh --json\n"
      "  footing-eval pose --motion clip.bvh --activities labels.csv --json\n"
      "  footing-eval pose --motion squats.trc --still static.trc --boards forces "
      "--forces squats_grf.mot --mass-kg 60");
  command->callback([flags, &shared] {
    const auto out = Evaluate(*flags);
    if (!out) {
      shared.exit_code = cli::Report(out.error());
      return;
    }
    if (out->contains("plates")) {
      for (const auto& warning : out->at("plates").at("warnings")) {
        std::cerr << "warning: " << flags->scene.forces << ": " << warning.get<std::string>()
                  << "\n";
      }
    }
    if (shared.json) {
      std::cout << out->dump() << "\n";
    } else {
      for (const auto& [name, value] : out->items()) PrintField(name, value);
    }
  });
}

}  // namespace footing::eval

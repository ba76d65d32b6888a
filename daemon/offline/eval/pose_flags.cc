#include "daemon/offline/eval/pose_flags.h"

#include "common/base/units.h"
#include "common/virtual/options/sensor_options.h"
#include "daemon/offline/eval/constants.h"
#include "daemon/offline/eval/motion_options.h"

namespace footing::eval {
namespace {

/// The motion and what is known of the person.
void AddSceneFlags(CLI::App& command, PoseFlags& flags) {
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
}

/// Which sensors there are, and their errors.
void AddSensorFlags(CLI::App& command, PoseFlags& flags) {
  pose_run::Settings& settings = flags.scene.settings;
  command
      .add_option("--hands", flags.hands,
                  "Hand devices: move (positions, 1 cm noise), wiimote (attitudes of the fists), "
                  "straps (of the arms), kinect (late "
                  "positions), none")
      ->check(CLI::IsMember({"move", "wiimote", "straps", "kinect", "none"}));
  command
      .add_option("--head", flags.head,
                  "Tracker of the head: sphere (on a cap, 1 cm noise and 2 cm of its seat), kinect "
                  "(late), none (default)")
      ->check(CLI::IsMember({"sphere", "kinect", "none"}));
  command.add_flag("--belt", settings.belt,
                   "A Wiimote with MotionPlus on a belt: attitude of the pelvis");
  command.add_flag("--joints", settings.joints,
                   "With --hands kinect: all joints of its skeleton, hidden ones inferred");
  command
      .add_option("--boards", flags.boards,
                  "Board forces: simulated, forces (measured), or insoles")
      ->check(CLI::IsMember({"simulated", "forces", "insoles"}));
  command.add_option("--rate-hz", settings.rate_hz, "Frame rate, Hz")
      ->check(CLI::Range(30.0, 120.0));
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
  command.add_flag("--floor", settings.floor,
                   "Put feet that step beyond their board's plate on the floor, with --limited");
}

/// Models, modes and what is reported.
void AddReportFlags(CLI::App& command, PoseFlags& flags) {
  command.add_option("--model", flags.models,
                     "Model file, *.fmodel; may be repeated (default: built in)");
  command.add_flag("--same-person", flags.same_person,
                   "Accept models trained on other takes of the tested person");
  command.add_option("--mode", flags.mode, "Reconstruction mode: paper or best")
      ->check(CLI::IsMember({"paper", "best"}));
  command.add_option("--lag-ms", flags.lag_ms, "Output delay for smoothing, ms, 0 to 200")
      ->check(CLI::Range(0.0, 200.0));
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

void AddPoseFlags(CLI::App& command, PoseFlags& flags) {
  AddSceneFlags(command, flags);
  AddSensorFlags(command, flags);
  AddReportFlags(command, flags);
}

Result<void> Translate(PoseFlags& flags) {
  pose_run::Settings& settings = flags.scene.settings;
  settings.hands = flags.hands != "none";
  if (flags.hands == "wiimote") settings.hand_device = pose_run::HandDevice::kWiimote;
  if (flags.hands == "straps") settings.hand_device = pose_run::HandDevice::kStraps;
  if (flags.hands == "kinect") settings.hand_device = pose_run::HandDevice::kKinect;
  if (settings.joints && (flags.hands != "kinect" || flags.boards != "simulated")) {
    return UsageError("--joints goes with --hands kinect and --boards simulated");
  }
  settings.head = flags.head == "sphere"   ? pose_run::HeadDevice::kSphere
                  : flags.head == "kinect" ? pose_run::HeadDevice::kKinect
                                           : pose_run::HeadDevice::kNone;
  const bool extra = flags.head != "none" || settings.belt;
  if (flags.head != "none" && flags.hands == "kinect") {
    return UsageError(
        "--head has --hands move, wiimote, straps and none: the Kinect of the hands "
        "shows the head by --joints");
  }
  if (extra && (flags.boards == "insoles" || flags.mode == "paper")) {
    return UsageError(
        "--head and --belt are for the best mode on boards, not for --mode paper or "
        "--boards insoles");
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

}  // namespace footing::eval

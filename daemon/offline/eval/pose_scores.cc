#include "daemon/offline/eval/pose_scores.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/options/sensor_options.h"
#include "daemon/offline/eval/pose_scene.h"

namespace footing::eval {
namespace {

const Eigen::Vector3d& JointPlace(const body::Kinematics& at, int joint) {
  return at.p_WJ[static_cast<std::size_t>(joint)];
}

}  // namespace

FootScore::FootScore(const pose_run::PoseRun& run, std::size_t lag)
    : run_(run), lag_(lag), step_s_(1 / run.rate_hz) {
  const auto geometry = reconstruction::StandingFeet(run.body);
  for (int side = 0; side < 2; ++side) {
    const auto f = static_cast<std::size_t>(side);
    feet_[f].geometry = geometry[f];
    feet_[f].ankle = body::Ankle(run.body, side).joint;
    feet_[f].toe = body::Toe(run.body, side).joint;
  }
  first_on_feet_ =
      static_cast<std::size_t>(std::lround((pose_run::kStandS + pose_run::kLeaveS) * run.rate_hz));
}

void FootScore::Add(const reconstruction::Output& output, const PoseScore& score, std::size_t i) {
  const bool settled = i - lag_ >= first_on_feet_;
  for (std::size_t f = 0; f < momentum::kFeet; ++f) {
    const bool contact = output.momentum.feet[f].contact;
    contacts_.Add(f, run_.frames[i].feet[f].load_n > kContactN, contact, step_s_);
    AddSkate(run_.frames[i - lag_].inputs.loads.feet[f], score, settled, feet_[f]);
    if (settled && contacts_.true_since_s[f] > kSettledContactS) AddPlace(score, feet_[f]);
    AddBallSpeed(score, contact, feet_[f]);
  }
}

void FootScore::AddPlace(const PoseScore& score, const Foot& foot) {
  const Eigen::Vector3d error_m =
      0.5 * (JointPlace(score.at(), foot.ankle) + JointPlace(score.at(), foot.toe) -
             JointPlace(score.truth(), foot.ankle) - JointPlace(score.truth(), foot.toe));
  place_.Add(100 * error_m.head<2>().norm());
}

void FootScore::AddBallSpeed(const PoseScore& score, bool contact, Foot& foot) {
  const Eigen::Vector3d toe_m = JointPlace(score.at(), foot.toe);
  const Eigen::Vector3d true_toe_m = JointPlace(score.truth(), foot.toe);
  if (contact && foot.contact) {
    ball_speed_.Add(100 * (toe_m - foot.toe_m).head<2>().norm() / step_s_);
    true_ball_speed_.Add(100 * (true_toe_m - foot.true_toe_m).head<2>().norm() / step_s_);
  }
  foot.toe_m = toe_m;
  foot.true_toe_m = true_toe_m;
  foot.contact = contact;
}

/// The point of the sole where the true foot has its COP, as it moves with either foot.
void FootScore::AddSkate(const momentum::FootLoads& loads, const PoseScore& score, bool settled,
                         Foot& foot) {
  const momentum::Pressure pressure = momentum::PressureOf(loads, kContactN);
  const SolePoints now{body::Place(foot.geometry.heel, score.at()),
                       body::Place(foot.geometry.toe, score.at())};
  const SolePoints true_now{body::Place(foot.geometry.heel, score.truth()),
                            body::Place(foot.geometry.toe, score.truth())};
  const Eigen::Vector2d along = (true_now[1] - true_now[0]).head<2>();
  const double from_heel = (pressure.p_WP_m - true_now[0]).head<2>().dot(along);
  const double share = pressure.cop_valid
                           ? std::clamp(from_heel / std::max(along.squaredNorm(), 1e-6), 0.0, 1.0)
                           : 0.5;
  const auto speed = [&](const SolePoints& after, const SolePoints& before) {
    const Eigen::Vector3d step_m =
        (1 - share) * (after[0] - before[0]) + share * (after[1] - before[1]);
    return 100 * step_m.head<2>().norm() / step_s_;
  };
  if (const auto oldest = foot.stance.Advance(
          settled && pressure.cop_valid,
          {speed(now, foot.sole_m), speed(true_now, foot.true_sole_m)}, step_s_)) {
    skate_.Add((*oldest)[0]);
    true_skate_.Add((*oldest)[1]);
  }
  foot.sole_m = now;
  foot.true_sole_m = true_now;
}

void FootScore::WriteTo(nlohmann::ordered_json& json) const {
  json["foot_skate_cm_per_s"] = skate_.mean();
  json["foot_skate_true_cm_per_s"] = true_skate_.mean();
  json["ball_speed_in_contact_cm_per_s"] = ball_speed_.mean();
  json["ball_speed_in_contact_true_cm_per_s"] = true_ball_speed_.mean();
  json["foot_position_rms_cm"] = place_.rms();
  json["contact_f1"] = contacts_.F1();
  json["landings"] = contacts_.landings;
  json["landing_delay_ms"] = 1000 * contacts_.mean_delay_s();
}

void ComScore::Add(const body::Body& body, const reconstruction::Output& output,
                   const PoseScore& score, const pose_run::Frame& truth) {
  const Eigen::Vector3d error_m = output.com_W_m - truth.com_m;
  vertical_.Add(100 * error_m.z());
  horizontal_.Add(100 * error_m.head<2>().norm());
  forward_.Add(100 * error_m.x());
  lateral_.Add(100 * error_m.y());
  const double t_s = truth.inputs.loads.time_s;
  vertical_drift_.Add(t_s, 100 * std::abs(error_m.z()));
  horizontal_drift_.Add(t_s, 100 * error_m.head<2>().norm());
  const Eigen::Vector3d com = body::CentreOfMass(body, score.at());
  pose_vertical_.Add(100 * (com.z() - truth.com_m.z()));
  loads_vertical_.Add(100 * (output.momentum.p_WC_m.z() - truth.com_m.z()));
  nees_ += error_m.z() * error_m.z() / output.com_variance_m2.z();
  ++frames_;
  if (output.posture_com_W_m) {
    const Eigen::Vector3d off_m = *output.posture_com_W_m - truth.com_m;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      posture_[static_cast<std::size_t>(axis)].Add(100 * off_m(axis));
    }
  }
  pose_horizontal_.Add(100 * (com - truth.com_m).head<2>().norm());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    angular_[static_cast<std::size_t>(axis)].Add(output.momentum.angular_momentum_kgm2ps(axis) -
                                                 truth.angular_momentum(axis));
  }
}

void ComScore::WriteTo(nlohmann::ordered_json& json) const {
  json["com_vertical_rms_cm"] = vertical_.rms();
  json["com_horizontal_rms_cm"] = horizontal_.rms();
  json["com_forward_rms_cm"] = forward_.rms();
  json["com_lateral_rms_cm"] = lateral_.rms();
  json["com_forward_bias_cm"] = forward_.mean();
  json["com_forward_sd_cm"] =
      std::sqrt(std::max(0.0, std::pow(forward_.rms(), 2) - std::pow(forward_.mean(), 2)));
  json["com_vertical_drift_cm_per_min"] = vertical_drift_.PerMinute();
  json["com_horizontal_drift_cm_per_min"] = horizontal_drift_.PerMinute();
  json["loads_com_vertical_rms_cm"] = loads_vertical_.rms();
  json["com_vertical_nees"] = nees_ / static_cast<double>(std::max(frames_, std::size_t{1}));
  json["pose_com_vertical_rms_cm"] = pose_vertical_.rms();
  json["pose_com_horizontal_rms_cm"] = pose_horizontal_.rms();
  for (const Spread& axis : posture_) json["posture_com_rms_cm"].push_back(axis.rms());
  for (const Spread& axis : posture_) json["posture_com_bias_cm"].push_back(axis.mean());
  for (const Spread& axis : angular_) json["angular_momentum_error_kgm2ps"].push_back(axis.rms());
}

namespace {

/// The motion and what is known of the person.
void AddSceneFlags(CLI::App& command, PoseFlags& flags) {
  pose_run::Settings& settings = flags.scene.settings;
  AddMotionOptions(command, flags.scene);
  command
      .add_option("--speed", flags.scene.speed,
                  "Speed of the motion, of the recorded one: 0.5 is slow motion, with its forces")
      ->check(CLI::Range(0.25, 2.0));
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
      .add_option(
          "--hands", flags.hands,
          "Hand devices: move (positions, 1 cm noise, and attitudes), points (such positions "
          "alone), wiimote (attitudes of the fists), straps (of the arms), kinect (late "
          "positions), none")
      ->check(CLI::IsMember({"move", "points", "wiimote", "straps", "kinect", "none"}));
  command
      .add_option("--head", flags.head,
                  "Tracker of the head: sphere (on a cap, 1 cm noise and 2 cm of its seat), kinect "
                  "(late), none (default)")
      ->check(CLI::IsMember({"sphere", "kinect", "none"}));
  command.add_flag_callback(
      "--belt", [&flags] { flags.segments.insert(flags.segments.begin(), "pelvis"); },
      "A Wiimote with MotionPlus on a belt: --worn pelvis");
  command
      .add_option(
          "--worn", flags.segments,
          "Segment with a Wiimote with MotionPlus: pelvis, chest, head, thighs, shanks, hands, or "
          "one of them such as left_thigh; may be repeated")
      ->delimiter(',');
  command.add_flag("--squat-before,!--no-squat-before", settings.squat_before,
                   "One squat before the motion shows worn sensors which way they face (default); "
                   "else the motion's own squats do");
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
  command.add_option(
      "--constant", flags.constants,
      "Constant of the mode, NAME=VALUE, those of the paper mode paper.NAME; may be repeated");
  command.add_flag("--baselines,!--no-baselines", flags.baselines,
                   "Compare with reconstructions from fewer measurements");
}

}  // namespace

void AddPoseFlags(CLI::App& command, PoseFlags& flags) {
  AddSceneFlags(command, flags);
  AddSensorFlags(command, flags);
  AddReportFlags(command, flags);
}

namespace {

/// The segments of a name: both of a side-less one.
Result<void> AddSites(const std::string& name, std::vector<reconstruction::BodySite>& sites) {
  const std::size_t before = sites.size();
  for (std::size_t site = 0; site < reconstruction::kBodySites; ++site) {
    const std::string known = reconstruction::kBodySiteNames[site];
    const std::size_t side = known.find('_');
    const bool both = side != std::string::npos && known.substr(side + 1) + "s" == name;
    const auto one = static_cast<reconstruction::BodySite>(site);
    if (known != name && !both) continue;
    if (std::find(sites.begin(), sites.end(), one) != sites.end()) {
      return UsageError("--worn names " + known + " twice");
    }
    sites.push_back(one);
  }
  if (sites.size() > before) return {};
  return UsageError("--worn " + name +
                    ": must be pelvis, chest, head, thighs, shanks, hands, or one of a side such "
                    "as left_thigh");
}

/// A Move in each hand, which measures how the hand turns.
void AddHands(std::vector<reconstruction::BodySite>& sites) {
  for (const auto hand :
       {reconstruction::BodySite::kLeftHand, reconstruction::BodySite::kRightHand})
    if (std::find(sites.begin(), sites.end(), hand) == sites.end()) sites.push_back(hand);
}

/// Sensors of hands, head and segments that do not go together.
Result<void> CheckSensors(const PoseFlags& flags) {
  const pose_run::Settings& settings = flags.scene.settings;
  if (settings.joints && (flags.hands != "kinect" || flags.boards != "simulated")) {
    return UsageError("--joints goes with --hands kinect and --boards simulated");
  }
  const bool extra = flags.head != "none" || !settings.segments.empty();
  if (flags.head != "none" && flags.hands == "kinect") {
    return UsageError(
        "--head has --hands move, wiimote, straps and none: the Kinect of the hands "
        "shows the head by --joints");
  }
  if (extra && (flags.boards == "insoles" || flags.mode == "paper")) {
    return UsageError(
        "--head, --worn and --belt are for the best mode on boards, not for --mode paper or "
        "--boards insoles");
  }
  const bool positions = flags.hands == "move" || flags.hands == "points";
  if (flags.boards == "insoles" && !positions && flags.hands != "none") {
    return UsageError("--boards insoles has --hands move, points and none, not " + flags.hands);
  }
  if (flags.boards == "forces" && (flags.hands == "wiimote" || flags.hands == "straps")) {
    return UsageError("--boards forces has --hands move, points, kinect and none, not " +
                      flags.hands);
  }
  if (!settings.hands &&
      std::any_of(settings.segments.begin(), settings.segments.end(), reconstruction::IsHand)) {
    return UsageError("--worn hands needs --hands: attitudes count where the hands are seen");
  }
  return {};
}

}  // namespace

Result<void> Translate(PoseFlags& flags) {
  pose_run::Settings& settings = flags.scene.settings;
  settings.hands = flags.hands != "none";
  if (flags.hands == "wiimote") settings.hand_device = pose_run::HandDevice::kWiimote;
  if (flags.hands == "straps") settings.hand_device = pose_run::HandDevice::kStraps;
  if (flags.hands == "kinect") settings.hand_device = pose_run::HandDevice::kKinect;
  for (const std::string& name : flags.segments) {
    if (const auto added = AddSites(name, settings.segments); !added) return added;
  }
  settings.head = flags.head == "sphere"   ? pose_run::HeadDevice::kSphere
                  : flags.head == "kinect" ? pose_run::HeadDevice::kKinect
                                           : pose_run::HeadDevice::kNone;
  if (auto can = CheckSensors(flags); !can) return can;
  if (flags.hands == "move" && flags.boards != "insoles" && flags.mode == "best") {
    AddHands(settings.segments);
  }
  if ((flags.boards == "forces") == flags.scene.forces.empty()) {
    return UsageError("--boards forces and --forces FILE (.mot, .sto or .c3d) go together");
  }
  if (flags.scene.speed != 1 && (flags.boards == "forces" || !flags.scene.activities.empty())) {
    return UsageError(
        "--speed changes the motion and its computed forces: no --forces and no "
        "--activities with it");
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
  if (auto set = reconstruction::SetMode(flags.mode, flags.ablate, flags.options); !set) return set;
  return SetConstants(flags.constants, flags.options);
}

namespace {

std::map<std::string, double*> ConstantsOf(reconstruction::Options& options) {
  reconstruction::BestConstants& c = options.best;
  reconstruction::PaperConstants& paper = options.paper;
  momentum::PaperConfig& momenta = paper.momentum;
  return {
      {"hand_sd_m", &c.hand_sd_m},
      {"arm_spread", &c.arm_spread},
      {"segment_sd_rad", &c.segment_sd_rad},
      {"pelvis_sd_rad", &c.pelvis_sd_rad},
      {"hand_turn_sd_rad", &c.hand_turn_sd_rad},
      {"foot_along", &c.foot.along},
      {"foot_across", &c.foot.across},
      {"ankle_up", &c.foot.ankle_up},
      {"toe_up", &c.foot.toe_up},
      {"lift", &c.foot.lift},
      {"lift_time_s", &c.foot.lift_time_s},
      {"ankle_rise", &c.foot.ankle_rise},
      {"toe_rise", &c.foot.toe_rise},
      {"forward", &c.foot.forward},
      {"air_level", &c.foot.air_level},
      {"air_up", &c.foot.air_up},
      {"aloft_sd_m", &c.aloft_sd_m},
      {"aloft_time_s", &c.aloft_time_s},
      {"spread", &c.spread},
      {"arm_joint_spread", &c.arm_joint_spread},
      {"com_spread", &c.com_spread},
      {"angle_weight", &c.angle_weight},
      {"bent_angle_weight", &c.bent_angle_weight},
      {"com_sd_m", &c.com_sd_m},
      {"angular_sd", &c.angular_sd},
      {"prior_weight", &c.prior_weight},
      {"smooth_weight", &c.smooth_weight},
      {"regressed_prior_weight", &c.regressed_prior_weight},
      {"regressed_smooth_weight", &c.regressed_smooth_weight},
      {"paper.variance_share", &paper.variance_share},
      {"paper.span", &paper.search.span},
      {"paper.reach", &paper.search.reach},
      {"paper.carry", &paper.search.carry},
      {"paper.hand_sd_m", &paper.hand_sd_m},
      {"paper.arm_sd_rad", &paper.arm_sd_rad},
      {"paper.foot_sd_m", &paper.foot_sd_m},
      {"paper.com_sd_m", &paper.com_sd_m},
      {"paper.height_sd_m", &paper.height_sd_m},
      {"paper.angular_sd", &paper.angular_sd},
      {"paper.load_walk_n", &momenta.load_filter.walk_n},
      {"paper.load_noise_n", &momenta.load_filter.noise_n},
      {"paper.vertical_near_zero", &momenta.vertical.near_zero},
      {"paper.vertical_after_s", &momenta.vertical.after_s},
      {"paper.vertical_fades_s", &momenta.vertical.fades_s},
      {"paper.angular_near_zero", &momenta.angular.near_zero},
      {"paper.angular_after_s", &momenta.angular.after_s},
      {"paper.angular_fades_s", &momenta.angular.fades_s},
      {"paper.true_com_sd_m", &paper.true_com_sd_m},
      {"paper.true_angular_sd", &paper.true_angular_sd},
  };
}

std::map<std::string, int*> CountsOf(reconstruction::Options& options) {
  pose::FibonacciOptions& search = options.paper.search;
  return {{"paper.evaluations", &search.evaluations}, {"paper.sweeps", &search.sweeps}};
}

}  // namespace

Result<void> SetConstants(const std::vector<std::string>& assignments,
                          reconstruction::Options& options) {
  const std::map<std::string, double*> names = ConstantsOf(options);
  const std::map<std::string, int*> counts = CountsOf(options);
  for (const std::string& assignment : assignments) {
    const auto equal = assignment.find('=');
    const auto found = names.find(assignment.substr(0, equal));
    char* end = nullptr;
    const double value =
        equal == std::string::npos ? NAN : std::strtod(assignment.c_str() + equal + 1, &end);
    const auto count = counts.find(assignment.substr(0, equal));
    const bool whole = value == std::round(value) && value >= 1 && value <= 100;
    const bool known = found != names.end() || (count != counts.end() && whole);
    if (!known || !std::isfinite(value) || *end != '\0') {
      std::string list;
      for (const auto& [name, place] : names) list += (list.empty() ? "" : ", ") + name;
      for (const auto& [name, place] : counts) list += ", " + name + " (1 to 100)";
      return UsageError("--constant " + assignment + ": say NAME=VALUE with one of " + list);
    }
    if (found != names.end()) {
      *found->second = value;
    } else {
      *count->second = static_cast<int>(value);
    }
  }
  return {};
}

}  // namespace footing::eval

#include "clients/stream/body_stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/stream/user_interface.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/options/load.h"
#include "common/virtual/people/perform.h"
#include "common/wire/wire.h"

namespace footing::stream_client {
namespace {

constexpr double kLeanM = 0.05;
constexpr double kFollowS = 0.1;
constexpr double kHalfXM = board::kBalanceBoard.sensor_distance_x_m / 2;
constexpr double kHalfYM = board::kBalanceBoard.sensor_distance_y_m / 2;
constexpr double kTremorMps2 = 0.05;
constexpr double kSwayM = 0.002;
constexpr double kOvertone = 0.25;  // Without it half a period would look like a whole one.
constexpr double kRattleRad = 0.5;  // How far a loose strap turns about the limb, to and fro.
constexpr double kRattleHz = 0.35;  // Slow, so that two parts of three steps differ.
const Eigen::Vector3d kSwing_M = Eigen::Vector3d(0, 0.6, 0.8);

/// How the straps sit in truth: f_S = this * f_M.
Eigen::Quaterniond Askew(int limb) {
  return limb == 0 ? Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2).normalized()
                   : Eigen::Quaterniond(0.5, -0.6, 0.2, 0.5).normalized();
}

double Follow(double value, double target, double elapsed_s) {
  return target + (value - target) * std::exp(-elapsed_s / kFollowS);
}

}  // namespace

SetupBody::SetupBody(Place place, double mass_kg, int boards)
    : place_(place), weight_n_(KilogramsToNewtons(mass_kg)), boards_(boards) {
  const auto poses = board::OneFootEach(0);
  Lay(poses[0].yaw_rad, poses[1].yaw_rad);
}

stream::DeviceRole SetupBody::Role(int limb) const {
  using stream::DeviceRole;
  if (place_ == Place::kShins) return limb == 0 ? DeviceRole::kLeftLeg : DeviceRole::kRightLeg;
  return limb == 0 ? DeviceRole::kLeftHand : DeviceRole::kRightHand;
}

bool SetupBody::Do(const std::string& line) {
  std::istringstream words(line);
  std::string verb;
  std::string which;
  words >> verb >> which;
  const auto side = static_cast<std::size_t>(which == "right" ? 1 : 0);
  const auto both = [this](const Swing& swing) {
    swing_ = {swing, swing};
    swinging_s_ = {};
  };
  if (verb == "off" || verb == "left" || verb == "right" || verb == "both") {
    stance_ = verb;
    lean_m_ = 0;
  } else if (verb == "lean") {
    lean_m_ = kLeanM;
  } else if (verb == "still") {
    both({});
  } else if (verb == "shake") {
    both({});
    swing_[side] = {4, 20, false};
  } else if (verb == "walk") {
    both({1.3, 8, true});
  } else if (verb == "run") {
    both({2.6, 14, true});
  } else if (verb == "jump") {
    both({1.3, 14, false});
  } else if (verb == "swap") {
    swapped_ = !swapped_;
  } else if (verb == "turn") {
    turned_[side] = !turned_[side];
  } else if (verb == "slip") {
    double degrees = 0;
    if (!(words >> degrees)) return false;
    strap_[side].slip_rad = DegreesToRadians(degrees);
  } else if (verb == "loose") {
    strap_[side].loose = !strap_[side].loose;
  } else {
    return false;
  }
  return true;
}

/// Share of the weight on the board that lies left (0) or right (1).
double SetupBody::Share(int place) const {
  if (stance_ == "both") return boards_ == 1 ? 1 : 0.5;
  return stance_ == (place == 0 ? "left" : "right") ? 1 : 0;
}

virtual_devices::CornerForces SetupBody::Board(int board, double t_s) {
  const auto i = static_cast<std::size_t>(board);
  const double elapsed_s = std::max(0.0, t_s - board_s_[i]);
  board_s_[i] = t_s;
  const int place = swapped_ ? 1 - board : board;
  share_[i] = Follow(share_[i], Share(place), elapsed_s);
  leaning_m_[i] = Follow(leaning_m_[i], lean_m_, elapsed_s);
  const double yaw_rad = yaw_rad_[static_cast<std::size_t>(place)] + (turned_[i] ? kPi : 0);
  const double forward_m = leaning_m_[i] + kSwayM * std::sin(2 * kPi * 0.7 * t_s);
  // In the plate's frame: x to the right, y to the front; yaw turns the front away from forward.
  const double x = forward_m * std::sin(yaw_rad) / kHalfXM;
  const double y = forward_m * std::cos(yaw_rad) / kHalfYM;
  const double quarter_n = (share_[i] * weight_n_ + 0.5 * random_.Normal()) / 4;
  return {quarter_n * (1 - x) * (1 + y), quarter_n * (1 + x) * (1 + y),
          quarter_n * (1 - x) * (1 - y), quarter_n * (1 + x) * (1 - y)};
}

/// Along kSwing_M, from rest, in units of the amplitude.
double SetupBody::Wave(int limb) const {
  const auto i = static_cast<std::size_t>(limb);
  const Swing& swing = swing_[i];
  double cycles = swing.frequency_hz * swinging_s_[i];
  if (swing.in_turns && place_ == Place::kShins && limb == 1) cycles -= 0.5;
  if (cycles <= 0) return 0;
  const bool back = swing.in_turns && place_ != Place::kShins && limb == 0;
  const double angle_rad = 2 * kPi * cycles + (back ? kPi : 0);
  return std::sin(angle_rad) + kOvertone * std::sin(2 * angle_rad);
}

Eigen::Vector3d SetupBody::Limb(int limb, double t_s) {
  const auto i = static_cast<std::size_t>(limb);
  const double elapsed_s = std::max(0.0, t_s - limb_s_[i]);
  limb_s_[i] = t_s;
  swinging_s_[i] += elapsed_s;
  Eigen::Vector3d force_M = Eigen::Vector3d(0, 0, -kStandardGravityMps2) +
                            swing_[i].amplitude_mps2 * Wave(limb) * kSwing_M;
  for (int axis = 0; axis < 3; ++axis) force_M[axis] += kTremorMps2 * random_.Normal();
  double about_limb_rad = strap_[i].slip_rad;
  if (strap_[i].loose && swing_[i].amplitude_mps2 > 0) {
    about_limb_rad += kRattleRad * std::sin(2 * kPi * kRattleHz * swinging_s_[i]);
  }
  const Eigen::Quaterniond strapped =
      place_ == Place::kHands ? Eigen::Quaterniond::Identity() : Askew(limb);
  return strapped * (Eigen::AngleAxisd(about_limb_rad, Eigen::Vector3d::UnitZ()) * force_M);
}

namespace {

using stream::DeviceRole;
using stream::Gesture;
using stream::UserInterface;

constexpr auto kThreeSteps = std::chrono::milliseconds(2300);
/// The last effects on the devices are still looked at when nothing is asked for any more.
constexpr auto kSetupOver = std::chrono::seconds(3);
constexpr std::size_t kMostAsked = 10'000;

bool IsLeft(DeviceRole role) {
  return role == DeviceRole::kLeftHand || role == DeviceRole::kLeftLeg ||
         role == DeviceRole::kLeftBoard;
}

/// Lines of SetupBody::Do for a gesture; none for one that is not the body's.
std::vector<std::string> LinesFor(Gesture gesture, DeviceRole role) {
  const std::string side = IsLeft(role) ? "left" : "right";
  switch (gesture) {
    case Gesture::kHoldStill:
      return {"still"};
    case Gesture::kStepOff:
      return {"still", "off"};
    case Gesture::kStepOn:
      return {"still", side};
    case Gesture::kStand:
      return {"still", "both"};
    case Gesture::kLean:
      return {"lean"};
    case Gesture::kShake:
      return {"shake " + side};
    case Gesture::kTakeSteps:
      return {"walk"};
    case Gesture::kSwitchOn:
    case Gesture::kUnspecified:
      break;
  }
  return {};
}

}  // namespace

SetupPerson::SetupPerson(boost::asio::io_context& io, std::shared_ptr<SetupBody> body,
                         std::string rig, std::shared_ptr<SetupRecord> record,
                         std::function<void()> on_end)
    : body_(std::move(body)),
      rig_(std::move(rig)),
      record_(std::move(record)),
      on_end_(std::move(on_end)),
      steps_(io),
      over_(io) {}

void SetupPerson::See(const v1::Tick& tick) {
  if (!tick.has_setup()) return;
  for (const v1::RigSetup& rig : tick.setup().rigs()) {
    if (rig.rig() == rig_) Follow(wire::FromProto(rig));
  }
}

void SetupPerson::Follow(const stream::RigSetup& setup) {
  const stream::BoardLayout layout = board::LayoutOr(setup.layout);
  body_->Lay(layout.left.yaw_rad, layout.right.yaw_rad);
  if (!setup.prompt) {
    if (!item_.empty()) End();
    return;
  }
  if (setup.prompt->number == number_ && !item_.empty()) return;
  number_ = setup.prompt->number;
  item_ = setup.prompt->item;
  over_.cancel();
  log::Info("asked for " + item_ + ": " + setup.prompt->text);
  const bool performed = Perform(*setup.prompt);
  if (record_->asked.size() < kMostAsked) record_->asked.push_back({*setup.prompt, performed});
}

bool SetupPerson::Perform(const stream::SetupPrompt& prompt) {
  steps_.cancel();
  const auto lines = LinesFor(prompt.gesture, prompt.role);
  for (const std::string& line : lines) body_->Do(line);
  if (prompt.gesture == Gesture::kTakeSteps) {
    steps_.After(kThreeSteps, [body = body_] { body->Do("still"); });
  }
  // The devices are on from the beginning.
  return !lines.empty() || prompt.gesture == Gesture::kSwitchOn;
}

void SetupPerson::End() {
  item_.clear();
  over_.After(kSetupOver, [this] {
    ++record_->setups;
    log::Info("the setup has ended");
    on_end_();
  });
}

Result<SetupPersonPlan> PlanSetupPerson(const SetupPersonOptions& options, const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const UserInterface interface = stream::UserInterfaceNamed(options.interface);
  if (interface == UserInterface::kUnspecified && !options.interface.empty()) {
    return UsageError("--interface " + options.interface +
                      ": unknown interface; there are: " + stream::UserInterfaceNames());
  }
  const bool boards_only = interface == UserInterface::kBoards;
  const bool joystick = interface == UserInterface::kJoystick;
  const bool all = interface == UserInterface::kUnspecified;
  const int boards = options.boards.value_or(all || boards_only ? 2 : 0);
  const int remotes = boards_only ? 0 : joystick ? 1 : 2;
  if (boards + remotes == 0) {
    return UsageError("--interface boards --boards 0: there is no device; leave out one of them");
  }
  const auto place = interface == UserInterface::kLeg ? SetupBody::Place::kShins
                     : options.strapped               ? SetupBody::Place::kWrists
                                                      : SetupBody::Place::kHands;
  SetupPersonPlan planned;
  planned.body = std::make_shared<SetupBody>(place, options.mass_kg, boards);
  const auto side_asked = [&](int side) { return options.jumbled ? 1 - side : side; };
  for (int side = 0; side < boards; ++side) {
    const std::uint64_t seed = DeviceSeed(common, static_cast<std::uint64_t>(side) + 1);
    const int asked = boards == 2 ? side_asked(side) : side;
    planned.plan.devices.emplace_back(
        virtual_devices::BalanceBoard(seed),
        [body = planned.body, side](double t_s) { return body->Board(side, t_s); },
        asked == 0 ? DeviceRole::kLeftBoard : DeviceRole::kRightBoard,
        virtual_devices::BoardLink(*link, seed + 500));
  }
  for (int side = 2 - remotes; side < 2; ++side) {
    const auto feels = [body = planned.body, side](double t_s) {
      virtual_devices::WiimoteSensors sensors;
      sensors.specific_force_S_mps2 = body->Limb(side, t_s);
      return sensors;
    };
    const DeviceRole role = planned.body->Role(remotes == 2 ? side_asked(side) : side);
    planned.plan.devices.push_back(MakeRemote(common, *link, static_cast<std::uint64_t>(side) + 3,
                                              role, feels, {.nunchuk = joystick}));
  }
  planned.plan.duration_s = common.seconds;
  return planned;
}

CLI::App* AddRehearseCommand(CLI::App& app, RehearseOptions& options) {
  SetupPersonOptions& person = options.person;
  auto* rehearse = app.add_subcommand(
      "rehearse", "A synthetic person who performs what footing-ctl setup asks for");
  rehearse->add_option("--interface", person.interface,
                       "Interface whose devices the person uses: wrist, arm, leg, joystick or "
                       "boards (default: two held remotes and two boards)");
  rehearse
      ->add_option("--boards", person.boards, "Number of boards (default: those of the interface)")
      ->check(CLI::Range(0, 2));
  rehearse->add_option("--mass-kg", person.mass_kg, "Mass of the person, kg (default 70)")
      ->check(CLI::Range(20.0, 200.0));
  rehearse->add_option("--rig", person.rig, "Rig whose setup is followed (default main)");
  rehearse->add_flag("--strapped", person.strapped,
                     "Strap the remotes of wrist and arm on the wrists, askew, instead of holding "
                     "them; for footing-ctl setup --worn left_hand,right_hand");
  rehearse->add_flag("--jumbled", person.jumbled,
                     "Let left and right devices ask for each other's roles");
  rehearse->add_flag("--once", person.once, "End after one setup");
  rehearse->add_option("--watch", options.sensor,
                       "Address of footingd, whose setup is followed, unix:PATH, tcp:HOST:PORT or "
                       "tls:HOST:PORT");
  rehearse->add_flag("--json", options.json,
                     "At the end print what was asked for and performed, as JSON");
  return rehearse;
}

void PrintAsked(const SetupRecord& record, bool json) {
  const auto& asked = record.asked;
  const auto performed =
      std::count_if(asked.begin(), asked.end(), [](const auto& one) { return one.performed; });
  if (!json) {
    std::cerr << "setups: " << record.setups << ", prompts: " << asked.size()
              << ", performed: " << performed << std::endl;
    return;
  }
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SetupRecord::Asked& one : asked) {
    const bool has_role = one.prompt.role != stream::DeviceRole::kUnspecified;
    rows.push_back({{"item", one.prompt.item},
                    {"gesture", stream::Name(one.prompt.gesture)},
                    {"role", has_role ? stream::Name(one.prompt.role) : ""},
                    {"prompt", one.prompt.text},
                    {"performed", one.performed}});
  }
  std::cout << nlohmann::ordered_json{{"setups", record.setups},
                                      {"prompts", asked.size()},
                                      {"performed", performed},
                                      {"rows", rows}}
            << std::endl;
}

std::unique_ptr<transport::Client> Watch(boost::asio::io_context& io,
                                         const transport::Address& server,
                                         std::vector<std::string> channels,
                                         std::function<void(const v1::Tick&)> see) {
  transport::ClientOptions options;
  options.address = server;
  options.client_name = "footing-stream";
  options.channels = std::move(channels);
  transport::ClientHandlers handlers;
  handlers.on_tick = std::move(see);
  handlers.on_state = [](transport::LinkState, const std::string& why) {
    log::Info("watching the server: " + why);
  };
  handlers.on_notice = [](const v1::Notice& notice) {
    log::Warning("watching the server: " + notice.text());
  };
  auto client = std::make_unique<transport::Client>(io, options, std::move(handlers));
  client->Start();
  return client;
}

namespace {

namespace sensors = virtual_sensors;
using sensors::kFeet;

constexpr double kLoadedN = 20;
constexpr double kReportedOutsideShare = 0.02;
constexpr double kEdge = 0.02;  // Share of the loaded samples beyond each end of a range.
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

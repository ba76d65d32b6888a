#include "clients/ctl/guided.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include <poll.h>
#include <unistd.h>

#include "clients/ctl/commands.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/frames/camera_file.h"
#include "common/guide/set_up.h"
#include "common/rig/follower.h"
#include "common/runtime/clock.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

constexpr double kGuideStepS = 0.05;
constexpr double kSolveWithinS = 10;
constexpr double kSilenceTimeoutS = 3;  // Without a tick in this time, footingd is gone.

std::vector<std::string> Adapters() {
  std::vector<std::string> adapters;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/bluetooth", none)) {
    adapters.push_back(entry.path().filename().string());
  }
  return adapters;
}

v1::Command CommandOf(const guide::Action& action, const std::string& rig) {
  v1::Command command;
  switch (action.kind) {
    case guide::Action::Kind::kAssign: {
      auto& assign = *command.mutable_assign_role();
      assign.set_serial(action.serial);
      assign.set_rig(rig);
      assign.set_role(static_cast<v1::DeviceRole>(action.role));
      break;
    }
    case guide::Action::Kind::kTare:
      command.mutable_tare()->set_serial(action.serial);
      command.mutable_tare()->set_window_s(action.window_s);
      break;
    case guide::Action::Kind::kSolveMounting: {
      auto& solve = *command.mutable_solve_mounting();
      solve.set_serial(action.serial);
      solve.set_still_from_ns(action.still_from_ns);
      solve.set_still_to_ns(action.still_to_ns);
      solve.set_steps_from_ns(action.steps_from_ns);
      solve.set_steps_to_ns(action.steps_to_ns);
      break;
    }
    case guide::Action::Kind::kLayout:
      *command.mutable_set_board_layout()->mutable_layout() = wire::ToProto(action.layout);
      break;
    case guide::Action::Kind::kStoreCamera:
      break;  // A file's, not footingd's.
  }
  return command;
}

guide::Answer StoreCamera(const guide::Action& action, const std::string& file) {
  constexpr std::size_t kDateLength = 10;  // Length of an ISO 8601 date.
  const std::string remark =
      text::Utc(clock::WallNs()).substr(0, kDateLength) + ": " + action.remark;
  const auto stored = frames::StorePose(file, action.X_WC, remark);
  guide::Answer answer;
  answer.key = action.key;
  answer.ok = stored.ok();
  answer.message = stored ? action.remark + "; stored in " + file : stored.error().message;
  return answer;
}

guide::Answer Do(Connection& session, const guide::Action& action,
                 const guide::SetUpOptions& options) {
  if (action.kind == guide::Action::Kind::kStoreCamera)
    return StoreCamera(action, options.camera_file);
  guide::Answer answer;
  answer.key = action.key;
  const auto result = session.Call(CommandOf(action, options.rig), kSolveWithinS);
  answer.ok = result.ok();
  if (result) {
    answer.message = result->message();
    answer.residual = result->residual();
    answer.unit = result->unit();
  } else {
    answer.message = result.error().message;
  }
  return answer;
}

/// Prints each new prompt once, and on a terminal the feedback below it, in place.
class PromptPrinter {
 public:
  explicit PromptPrinter(const PromptOptions& prompts)
      : script_(prompts.script), screen_(!prompts.script && isatty(STDERR_FILENO) == 1) {}

  void Show(const guide::Progress& progress) {
    if (!progress.prompt.empty() && progress.prompt != prompt_) {
      Break();
      prompt_ = progress.prompt;
      if (script_) {
        std::cerr << "PROMPT: " << prompt_ << std::endl;
      } else {
        std::cerr << progress.picture << "\n> " << prompt_ << std::endl;
      }
    }
    if (screen_ && !progress.feedback.empty()) {
      std::cerr << "\r\x1b[K  " << progress.feedback << std::flush;
      dirty_ = true;
    }
  }

  void Report(const stream::SetupItem& item) {
    Break();
    std::cerr << (script_ ? "DONE: " : "  ") << ToText(item) << std::endl;
  }

 private:
  void Break() {
    if (dirty_) std::cerr << std::endl;
    dirty_ = false;
  }

  bool script_;
  bool screen_;
  bool dirty_ = false;
  std::string prompt_;
};

/// Publishes each new prompt with the rig's set-up, for whoever follows it: another screen, or the
/// device simulator that performs what is asked for. An older footingd that does not know how is
/// asked once.
class PublishedPrompts {
 public:
  PublishedPrompts(Connection& session, std::string rig)
      : session_(session), rig_(std::move(rig)) {}

  void Show(guide::Item item, const guide::Progress& progress) {
    if (!taken_ || progress.prompt.empty() || progress.prompt == text_) return;
    text_ = progress.prompt;
    v1::Command command;
    command.mutable_show_prompt()->set_rig(rig_);
    *command.mutable_show_prompt()->mutable_prompt() = wire::ToProto(stream::SetupPrompt{
        guide::Name(item), text_.substr(0, kMostBytes), progress.gesture, progress.role});
    taken_ = session_.Call(std::move(command)).ok();
  }
  void End() {
    if (!taken_ || text_.empty()) return;
    v1::Command command;
    command.mutable_show_prompt()->set_rig(rig_);
    taken_ = session_.Call(std::move(command)).ok();
  }

 private:
  static constexpr std::size_t kMostBytes = 1024;

  Connection& session_;
  const std::string rig_;
  bool taken_ = true;
  std::string text_;
};

Result<void> Record(Connection& session, const std::string& rig, const stream::SetupItem& item) {
  v1::Command command;
  command.mutable_record_setup()->set_rig(rig);
  *command.mutable_record_setup()->mutable_item() = wire::ToProto(item);
  const auto done = session.Call(std::move(command));
  if (!done) return Failure("cannot record " + item.name + ": " + done.error().message);
  return {};
}

}  // namespace

bool EnterPressed() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  if (isatty(STDIN_FILENO) != 1 || poll(&in, 1, 0) <= 0) return false;
  std::string line;
  std::getline(std::cin, line);
  return true;
}

const std::vector<std::string>& GuidedChannels() {
  static const std::vector<std::string> channels{"status", "setup", "motion", "boards", "hands"};
  return channels;
}

Result<recording::RecordingWriter> CreateRecording(const std::string& path, bool replace) {
  recording::WriterSettings settings;
  settings.chunks.compress = true;
  settings.library = std::string("footing-ctl ") + cli::Version();
  settings.replace = replace;
  return recording::RecordingWriter::Create(path, settings);
}

std::vector<stream::DeviceStatus> DevicesOf(const Connection& session, const std::string& rig) {
  std::vector<stream::DeviceStatus> devices;
  for (const auto& device : session.status()) {
    if (device.rig == rig && device.state != stream::DeviceState::kLost) devices.push_back(device);
  }
  return devices;
}

Result<std::vector<stream::SetupItem>> RunGuided(Connection& session,
                                                 const guide::SetUpOptions& options,
                                                 const std::vector<guide::Item>& items,
                                                 const PromptOptions& prompts) {
  guide::SetUp set_up(options, items);
  guide::Recent recent;
  recent.SetDevices(session.status());
  session.set_on_tick([&](const v1::Tick&, const rig::Tick& sensors) { recent.Take(sensors); });
  PromptPrinter printer(prompts);
  PublishedPrompts published(session, options.rig);
  std::vector<stream::SetupItem> found;
  std::vector<guide::Answer> answers;
  std::int64_t last_ns = session.server_ns();
  double silent_s = 0;
  Result<void> outcome;
  for (bool finished = false; !finished && outcome;) {
    if (session.RunFor(kGuideStepS) == Waited::kInterrupted) outcome = Failure("stopped");
    silent_s = session.server_ns() == last_ns ? silent_s + kGuideStepS : 0;
    last_ns = session.server_ns();
    if (silent_s > kSilenceTimeoutS) outcome = NoDevice("footingd is gone: " + session.link());
    if (!outcome || silent_s > 0) continue;
    guide::Situation now;
    now.now_ns = last_ns;
    now.recent = &recent;
    now.setup = &session.setup();
    now.adapters = Adapters();
    now.answers = std::exchange(answers, {});
    now.enter = !prompts.script && EnterPressed();
    const guide::Item under_way = set_up.item();
    const guide::Progress progress = set_up.Advance(now);
    printer.Show(progress);
    published.Show(under_way, progress);
    for (const auto& action : progress.actions) {
      answers.push_back(Do(session, action, options));
    }
    while (found.size() < set_up.results().size()) {
      stream::SetupItem item = set_up.results()[found.size()];
      item.wall_time_ns = clock::WallNs();
      printer.Report(item);
      // A set-up whose results cannot be recorded still runs to its end; the person is warned at
      // once.
      if (const auto kept = Record(session, options.rig, item); !kept) {
        std::cerr << "warning: " << kept.error().message << std::endl;
        item.note += (item.note.empty() ? "" : "; ") + std::string("not recorded by footingd");
      }
      found.push_back(std::move(item));
    }
    finished = progress.finished;
  }
  published.End();
  session.set_on_tick({});
  if (!outcome) return outcome.error();
  return found;
}

std::vector<stream::SetupItem> ItemsOf(const Connection& session, const std::string& rig,
                                       const std::vector<stream::SetupItem>& results) {
  std::vector<stream::SetupItem> recorded;
  for (const auto& one : session.setup()) {
    if (one.rig == rig) recorded = one.items;
  }
  return guide::Merged(recorded, results, DevicesOf(session, rig));
}

namespace {

using nlohmann::ordered_json;

/// "2026-11-21T10:30:00Z"; empty when there is none.
std::string Date(std::int64_t wall_time_ns) {
  if (wall_time_ns <= 0) return "";
  return text::Utc(wall_time_ns);
}

std::string RoundedText(double value) {
  const double rounded = std::round(value * 100) / 100;
  return ordered_json(rounded).dump();
}

}  // namespace

ordered_json ToJson(const stream::SetupItem& item) {
  return {{"name", item.name},         {"serial", item.serial}, {"passed", item.passed},
          {"residual", item.residual}, {"unit", item.unit},     {"date", Date(item.wall_time_ns)},
          {"stale", item.stale},       {"note", item.note}};
}

std::string ToText(const stream::SetupItem& item) {
  std::string text = item.name;
  if (!item.serial.empty()) text += " " + item.serial;
  text += item.passed ? (item.stale ? ": stale" : ": ok") : ": FAILED";
  if (!item.unit.empty()) text += ", " + RoundedText(item.residual) + " " + item.unit;
  if (!item.note.empty()) text += ", " + item.note;
  return text;
}

Result<void> PrintItems(const Connection& session, const std::string& rig,
                        const std::vector<stream::SetupItem>& items, bool need_ready,
                        const Shared& shared) {
  std::vector<std::string> missing;
  const bool ready = guide::Ready(items, DevicesOf(session, rig), &missing);
  ordered_json out{{"rig", rig}, {"items", ordered_json::array()}, {"ready", ready}};
  std::string text = "rig " + rig + (ready ? " is ready" : " is not ready");
  for (const auto& item : items) {
    out["items"].push_back(ToJson(item));
    text += "\n  " + Date(item.wall_time_ns) + "  " + ToText(item);
  }
  out["missing"] = missing;
  if (!missing.empty()) text += "\nmissing:";
  for (const std::string& one : missing) text += "\n  " + one;
  Print(out, text, shared);
  if (need_ready && !ready) return Failure("rig " + rig + " is not ready; " + missing.front());
  return {};
}

Result<std::vector<stream::DeviceRole>> BodyRoles(const std::vector<std::string>& names) {
  std::vector<stream::DeviceRole> roles;
  for (const std::string& name : names) {
    const stream::DeviceRole role = stream::RoleNamed(name);
    if (role == stream::DeviceRole::kLeftBoard || role == stream::DeviceRole::kRightBoard ||
        role == stream::DeviceRole::kUnspecified) {
      return UsageError("--worn " + name +
                        ": not a role of a remote; must be one of: left_hand right_hand left_leg "
                        "right_leg head trunk editor left_upper_arm right_upper_arm left_forearm "
                        "right_forearm pelvis left_thigh right_thigh");
    }
    if (std::find(roles.begin(), roles.end(), role) != roles.end()) {
      return UsageError("--worn names " + name + " twice");
    }
    roles.push_back(role);
  }
  return roles;
}

Result<void> AssignByGesture(Connection& session, const std::string& rig,
                             const std::vector<stream::DeviceRole>& body_roles, bool script,
                             const Shared& shared) {
  guide::SetUpOptions options;
  options.rig = rig;
  options.body_roles = body_roles;
  const auto results = RunGuided(session, options, {guide::Item::kRoles}, PromptOptions{script});
  if (!results) return results.error();
  if (results->empty()) return NoDevice("rig " + rig + " has no device; see footing-ctl devices");
  nlohmann::ordered_json out{{"rig", rig}, {"items", nlohmann::ordered_json::array()}};
  std::string text;
  for (const auto& item : *results) {
    out["items"].push_back(ToJson(item));
    text += (text.empty() ? "" : "\n") + ToText(item);
  }
  Print(out, text, shared);
  for (const auto& item : *results) {
    if (!item.passed) return Failure(ToText(item));
  }
  return {};
}

namespace {

struct SetUpArguments {
  guide::SetUpOptions options;
  std::vector<std::string> only;
  std::vector<std::string> body_roles;
  double mass_kg = 0;
  std::string calibration = "marks";
  double height_m = 0;
  bool yes = false;
  bool script = false;
};

constexpr double kScriptSettleS = 2;
constexpr double kEffectsSeenS = 1.2;

Result<void> TakePoses(SetUpArguments& arguments, const frames::CameraFile& camera) {
  if (arguments.calibration != "poses") {
    if (arguments.height_m <= 0) return {};
    return UsageError(
        "--height-m is for --calibration poses; the marks of the boards do not need it");
  }
  if (arguments.height_m <= 0)
    return UsageError("--calibration poses needs --height-m, the height of who holds the poses");
  for (const auto role : {stream::DeviceRole::kLeftHand, stream::DeviceRole::kRightHand}) {
    const bool has = std::any_of(camera.spheres.begin(), camera.spheres.end(),
                                 [&](const auto& sphere) { return sphere.role == role; });
    if (!has)
      return UsageError("--calibration poses needs the spheres of both hands, and " +
                        arguments.options.camera_file + " has none of the " +
                        std::string(stream::Name(role)) + "; use --calibration marks");
  }
  arguments.options.poses_height_m = arguments.height_m;
  return {};
}

/// The camera's sphere that is held on the marks: the first of its file.
Result<void> TakeCamera(SetUpArguments& arguments, const std::vector<guide::Item>& items) {
  const bool is_named = std::find(items.begin(), items.end(), guide::Item::kCamera) != items.end();
  if (arguments.options.camera_file.empty()) {
    if (!is_named) return {};
    return UsageError("--only camera needs --camera FILE, the file that footing-camera runs with");
  }
  const auto camera = frames::ReadCameraFile(arguments.options.camera_file);
  if (!camera) return camera.error();
  arguments.options.camera_role = camera->spheres.front().role;
  arguments.options.camera_radius_m = camera->spheres.front().target.radius_m;
  return TakePoses(arguments, *camera);
}

/// The items that the arguments name; UsageError when they contradict each other.
Result<std::vector<guide::Item>> Validate(SetUpArguments& arguments) {
  std::vector<guide::Item> items;
  for (const std::string& name : arguments.only) {
    const auto item = guide::ItemNamed(name);
    if (!item) {
      std::string known;
      for (const guide::Item one : guide::AllItems()) known += std::string(" ") + guide::Name(one);
      return UsageError("--only " + name + ": no such item; must be one of:" + known);
    }
    items.push_back(*item);
  }
  auto roles = BodyRoles(arguments.body_roles);
  if (!roles) return roles.error();
  arguments.options.body_roles = std::move(roles).value();
  if (!arguments.options.preset.empty() && !board::LayoutNamed(arguments.options.preset, 0)) {
    return UsageError("--preset " + arguments.options.preset +
                      ": no such layout; must be one of: one_foot_each side_by_side single");
  }
  if (const auto camera = TakeCamera(arguments, items); !camera) return camera.error();
  if (arguments.mass_kg > 0) arguments.options.mass_kg = arguments.mass_kg;
  if (arguments.script || arguments.yes) arguments.options.settle_s = kScriptSettleS;
  return items;
}

/// An item that was asked for by name, and for which the rig has no device, was not done.
Result<void> AllDone(const std::vector<guide::Item>& items,
                     const std::vector<stream::SetupItem>& results, const std::string& rig) {
  for (const guide::Item item : items) {
    const std::string name = guide::Name(item);
    const bool done = std::any_of(results.begin(), results.end(),
                                  [&](const stream::SetupItem& one) { return one.name == name; });
    if (!done) {
      return NoDevice("--only " + name + ": nothing done, rig " + rig +
                      " has no attached device for it; footing-ctl devices lists them");
    }
  }
  return {};
}

Result<void> Setup(Connection& session, const SetUpArguments& arguments,
                   const std::vector<guide::Item>& items, const Shared& shared) {
  const auto results =
      RunGuided(session, arguments.options, items, PromptOptions{arguments.script});
  if (!results) return results.error();
  // So that the last answers' effects on the devices are seen.
  session.RunFor(kEffectsSeenS);
  const auto list = ItemsOf(session, arguments.options.rig, *results);
  const bool whole = items.empty();
  if (const auto printed = PrintItems(session, arguments.options.rig, list, whole, shared);
      !printed) {
    return printed;
  }
  for (const auto& result : *results) {
    if (!result.passed) return Failure(ToText(result));
  }
  return AllDone(items, *results, arguments.options.rig);
}

void AddCameraOptions(CLI::App& command, SetUpArguments& arguments) {
  command.add_option("--camera", arguments.options.camera_file,
                     "Camera file of the running footing-camera, whose pose is calibrated");
  command
      .add_option("--calibration", arguments.calibration,
                  "With --camera: marks (a sphere on each mark of the boards, default) or poses "
                  "(three poses of a person with a sphere in each hand)")
      ->check(CLI::IsMember({"marks", "poses"}));
  command
      .add_option("--height-m", arguments.height_m,
                  "With --calibration poses: height of the person, m")
      ->check(CLI::Range(1.0, 2.3));
  command
      .add_option("--fist-to-sphere-m", arguments.options.fist_to_sphere_m,
                  "With --calibration poses: from the middle of the fist to the sphere, m (default "
                  "0.11, a PS Move; 0 for simulated hands)")
      ->check(CLI::Range(0.0, 0.3));
}

}  // namespace

void AddSetupCommand(CLI::App& app, Shared& shared) {
  const auto arguments = std::make_shared<SetUpArguments>();
  CLI::App* command =
      app.add_subcommand("setup",
                         "Guided setup of a rig: adapter, pairing, roles, layout, tare, "
                         "mounting, weigh, camera, checks");
  command->add_option("--rig", arguments->options.rig,
                      "Rig: the devices of one person (default main)");
  command
      ->add_option("--only", arguments->only, "Item to run; may be repeated (default: all items)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      ->add_option(
          "--worn", arguments->body_roles,
          "Roles of the remotes, such as left_leg,right_leg (default: their present roles)")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option(
      "--preset", arguments->options.preset,
      "Layout of the boards: one_foot_each, side_by_side or single (default: the recorded one)");
  command
      ->add_option("--gap-mm", arguments->options.gap_mm, "Gap between the boards, mm (default 20)")
      ->check(CLI::Range(0.0, 2000.0));
  command
      ->add_option("--mass-kg", arguments->mass_kg,
                   "Mass of the person, kg, to compare the weighing with (default: not compared)")
      ->check(CLI::Range(10.0, 200.0));
  command
      ->add_option("--patience", arguments->options.patience_s,
                   "Timeout of an item, s (default 60)")
      ->check(CLI::Range(1.0, 3600.0));
  command->add_option("--tries", arguments->options.tries, "Attempts for each item (default 2)")
      ->check(CLI::Range(1, 10));
  AddCameraOptions(*command, *arguments);
  command->add_flag("--yes", arguments->yes,
                    "Do not wait for Enter at steps that no sensor can confirm");
  command->add_flag(
      "--script", arguments->script,
      "Print prompts as lines PROMPT: ... on standard error, for a program that drives "
      "the devices");
  command->footer(
      "Items, in order: adapter pairing roles layout tare mounting weigh camera checks\n"
      "Examples:\n  footing-ctl setup --worn left_leg,right_leg\n"
      "  footing-ctl setup --only layout --only tare      # two items alone\n"
      "  footing-ctl setup --only camera --camera camera.json   # while footing-camera runs\n"
      "  footing-ctl setup --only camera --camera camera.json --calibration poses --height-m 1.74\n"
      "  footing-ctl setup --mass-kg 70 --json");
  command->callback([arguments, &shared] {
    const auto items = Validate(*arguments);
    if (!items) {
      shared.exit_code = cli::Report(items.error());
      return;
    }
    WithSession(shared, GuidedChannels(),
                [&](Connection& session) { return Setup(session, *arguments, *items, shared); });
  });
}

}  // namespace footing::ctl

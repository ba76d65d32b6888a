#include "clients/ctl/guided.h"

#include <poll.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <utility>

#include "common/runtime/clock.h"
#include "common/frames/camera_file.h"
#include "common/guide/set_up.h"
#include "common/base/utc.h"
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

bool EnterPressed() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  if (isatty(STDIN_FILENO) != 1 || poll(&in, 1, 0) <= 0) return false;
  std::string line;
  std::getline(std::cin, line);
  return true;
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
  constexpr std::size_t kDateLength = 10;  // Of ISO 8601.
  const std::string remark =
      text::Utc(clock::WallNs()).substr(0, kDateLength) + ": " + action.remark;
  const auto stored = frames::StorePose(file, action.X_WC, remark);
  guide::Answer answer;
  answer.key = action.key;
  answer.ok = stored.ok();
  answer.message = stored ? action.remark + "; stored in " + file : stored.error().message;
  return answer;
}

guide::Answer Do(Session& session, const guide::Action& action,
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
  PublishedPrompts(Session& session, std::string rig) : session_(session), rig_(std::move(rig)) {}

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

  Session& session_;
  const std::string rig_;
  bool taken_ = true;
  std::string text_;
};

Result<void> Record(Session& session, const std::string& rig, const stream::SetupItem& item) {
  v1::Command command;
  command.mutable_record_setup()->set_rig(rig);
  *command.mutable_record_setup()->mutable_item() = wire::ToProto(item);
  const auto done = session.Call(std::move(command));
  if (!done) return Failure("cannot record " + item.name + ": " + done.error().message);
  return {};
}

}  // namespace

const std::vector<std::string>& GuidedChannels() {
  static const std::vector<std::string> channels{"status", "setup", "motion", "boards", "hands"};
  return channels;
}

void TakeTick(const v1::Tick& tick, guide::Recent& recent) {
  if (tick.has_status()) {
    std::vector<stream::DeviceStatus> devices;
    for (const auto& device : tick.status().devices()) devices.push_back(wire::FromProto(device));
    recent.SetDevices(std::move(devices));
  }
  for (const auto& sample : tick.motion().samples()) recent.Add(wire::FromProto(sample));
  for (const auto& sample : tick.boards().samples()) recent.Add(wire::FromProto(sample));
  for (const auto& sample : tick.hands().samples()) recent.Add(wire::FromProto(sample));
}

std::vector<stream::DeviceStatus> DevicesOf(const Session& session, const std::string& rig) {
  std::vector<stream::DeviceStatus> devices;
  for (const auto& device : session.status()) {
    if (device.rig == rig && device.state != stream::DeviceState::kLost) devices.push_back(device);
  }
  return devices;
}

Result<std::vector<stream::SetupItem>> RunGuided(Session& session,
                                                 const guide::SetUpOptions& options,
                                                 const std::vector<guide::Item>& items,
                                                 const PromptOptions& prompts) {
  guide::SetUp set_up(options, items);
  guide::Recent recent;
  recent.SetDevices(session.status());
  session.set_on_tick([&](const v1::Tick& tick) { TakeTick(tick, recent); });
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

std::vector<stream::SetupItem> ItemsOf(const Session& session, const std::string& rig,
                                       const std::vector<stream::SetupItem>& results) {
  std::vector<stream::SetupItem> recorded;
  for (const auto& one : session.setup()) {
    if (one.rig == rig) recorded = one.items;
  }
  return guide::Merged(recorded, results, DevicesOf(session, rig));
}

}  // namespace footing::ctl

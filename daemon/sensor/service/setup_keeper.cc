#include "daemon/sensor/service/setup_keeper.h"

#include <algorithm>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"

namespace footing::sensor {
namespace {

using decode::Placement;
using stream::DeviceRole;

constexpr std::size_t kMostRigBytes = 64;
constexpr double kTareWindowS = 2;
constexpr double kLeastTareWindowS = 0.5;
constexpr double kMostTareWindowS = 30;
constexpr std::size_t kMostNameBytes = 64;
constexpr std::size_t kMostNoteBytes = 1024;
constexpr std::size_t kMostPrompts = 16;

bool Same(const std::optional<Eigen::Quaterniond>& a, const std::optional<Eigen::Quaterniond>& b) {
  return a.has_value() == b.has_value() && (!a || a->coeffs() == b->coeffs());
}

}  // namespace

Result<Measured> SetupKeeper::Tare(const std::string& serial, double window_s, bool clear) {
  if (clear) {
    store_.SetTare(serial, std::nullopt);
    return Measured{0, "N", "the tare of " + serial + " is forgotten"};
  }
  const auto found = devices_.Attached(serial);
  if (!found) return found.error();
  if ((*found)->placement() != Placement::kUnderFeet) {
    return UsageError(serial + " is a " + stream::Name((*found)->kind()) +
                      "; only boards are tared");
  }
  if (window_s == 0) window_s = kTareWindowS;
  if (!(window_s >= kLeastTareWindowS && window_s <= kMostTareWindowS)) {
    return UsageError("tare: window_s must be from 0.5 to 30");
  }
  const tare::Tare tare = (*found)->chain().SolveTare(now_ns_(), window_s);
  if (!tare.ok) return Failure("tare of " + serial + ": " + tare.problem);
  store_.SetTare(serial, setup::StoredTare{tare.offset, tare.residual_n});
  return Measured{tare.residual_n, "N",
                  "empty it shows " + text::Fixed(board::Total(tare.offset), 1) + " N"};
}

Result<Device*> SetupKeeper::AttachedOnBody(const std::string& serial) const {
  auto found = devices_.Attached(serial);
  if (!found) return found;
  const Device& device = **found;
  if (!IsOnBody(device.binding().role)) {
    return UsageError(
        serial + " is " + ToText(device.binding()) +
        "; only devices on hands, legs, head and trunk have a mounting (footing-ctl assign)");
  }
  return found;
}

Result<Measured> SetupKeeper::SolveMounting(const std::string& serial,
                                            const MountingStretches& stretches) {
  const auto found = AttachedOnBody(serial);
  if (!found) return found.error();
  if (stretches.still_to_ns <= stretches.still_from_ns ||
      stretches.steps_to_ns <= stretches.steps_from_ns ||
      stretches.steps_from_ns < stretches.still_from_ns) {
    return UsageError("mounting: standing still must come before the steps, and each must last");
  }
  const Binding& binding = (*found)->binding();
  const mounting::Mounting solved = (*found)->mounted_sensor().Solve(binding.role, stretches);
  if (!solved.ok) return Failure("mounting of " + serial + ": " + solved.problem);
  StoreMounting(binding, {serial, solved.rotation_MS, solved.residual_rad});
  const double turn_rad = solved.rotation_MS.angularDistance(Eigen::Quaterniond::Identity());
  return Measured{RadiansToDegrees(solved.residual_rad), "deg",
                  "turned by " + text::Fixed(RadiansToDegrees(turn_rad), 0) +
                      " degrees against a perfect mounting"};
}

Result<Measured> SetupKeeper::ClearMounting(const std::string& serial) {
  store_.SetMounting(serial, std::nullopt);
  return Measured{0, "deg", "the mounting of " + serial + " is forgotten"};
}

void SetupKeeper::StoreMounting(const Binding& binding, const stream::DeviceMounting& mounting) {
  setup::StoredMounting stored;
  stored.role = ToText(binding);
  stored.rotation_MS = mounting.rotation_MS;
  stored.residual_rad = mounting.residual_rad;
  store_.SetMounting(mounting.serial, stored);
}

Result<Measured> SetupKeeper::SetBoardLayout(stream::BoardLayout layout) {
  if (layout.rig.empty()) layout.rig = config_.default_rig;
  if (layout.rig.size() > kMostRigBytes) return UsageError("layout: the rig's name is too long");
  if (auto problem = board::Problem(layout); !problem.empty()) return UsageError(problem);
  if (auto problem = board::ProblemWith(layout, devices_.AttachedBoards(layout.rig), layout.rig);
      !problem.empty()) {
    return UsageError(problem);
  }
  const stream::BoardLayout before = store_.LayoutOf(layout.rig);
  const auto same = [](const stream::BoardPose& a, const stream::BoardPose& b) {
    return a.x_m == b.x_m && a.y_m == b.y_m && a.yaw_rad == b.yaw_rad;
  };
  const bool changed = before.preset != layout.preset || before.gap_mm != layout.gap_mm ||
                       !same(before.left, layout.left) || !same(before.right, layout.right);
  if (!store_.SetLayout(layout)) return Failure("layout: there are too many rigs already");
  if (changed) {
    store_.MarkStale(layout.rig, "layout", "", "the layout was changed and not checked since");
  }
  return Measured{0, "",
                  layout.preset == "single"
                      ? "one board alone: left and right foot cannot be distinguished"
                      : ""};
}

Result<void> SetupKeeper::RecordSetup(const std::string& rig, const stream::SetupItem& item,
                                      bool forget) {
  const std::string& name = rig.empty() ? config_.default_rig : rig;
  if (name.size() > kMostNameBytes || item.name.size() > kMostNameBytes ||
      item.serial.size() > kMostNameBytes || item.unit.size() > kMostNameBytes ||
      item.note.size() > kMostNoteBytes) {
    return UsageError("record: a name is longer than 64 bytes, or the note than 1024");
  }
  if (forget) {
    store_.Forget(name, item.name, item.serial);
    return {};
  }
  if (item.name.empty()) return UsageError("record: the item has no name");
  if (!store_.Record(name, item)) return Failure("record: there are too many items already");
  if (item.name != "layout" || !item.passed || item.stale) return {};
  // Checked where they lie now.
  for (const auto& device : devices_) {
    if (device->placement() != Placement::kUnderFeet || device->binding().rig != name) continue;
    store_.SetMoved(device->identity().serial, false);
    device->chain().RestartWatch();
  }
  return {};
}

Result<void> SetupKeeper::ShowPrompt(std::uint64_t session, const std::string& rig,
                                     const std::optional<stream::SetupPrompt>& prompt) {
  const std::string& name = rig.empty() ? config_.default_rig : rig;
  if (const auto checked = CheckRig(name); !checked) {
    return UsageError("show_prompt: " + checked.error().message);
  }
  due_ = true;
  if (!prompt) {
    prompts_.erase(name);
    return {};
  }
  if (prompt->item.size() > kMostNameBytes || prompt->text.size() > kMostNoteBytes) {
    return UsageError("show_prompt: the item is longer than 64 bytes, or the text than 1024");
  }
  if (!prompts_.contains(name) && prompts_.size() >= kMostPrompts) {
    return Failure("show_prompt: there are too many prompts already");
  }
  prompts_[name] = {session, *prompt};
  prompts_[name].prompt.number = ++last_prompt_;
  return {};
}

void SetupKeeper::EndSession(std::uint64_t session) {
  const auto is_its = [session](const auto& one) { return one.second.session == session; };
  if (std::erase_if(prompts_, is_its) > 0) due_ = true;
}

void SetupKeeper::StoreRole(const std::string& serial, const Binding& binding) {
  store_.SetRole(serial, binding.role == DeviceRole::kUnspecified ? "" : ToText(binding));
  if (!store_.MountingOf(serial, ToText(binding))) {
    store_.MarkStale(binding.rig, "mounting", serial, "its role is new");
  }
}

bool SetupKeeper::Apply(Device& device) const {
  const std::string& serial = device.identity().serial;
  const Binding& binding = device.binding();
  const auto tare = store_.TareOf(serial);
  device.chain().SetTare(tare ? std::optional(tare->offset) : std::nullopt);
  const auto stored = store_.MountingOf(serial, ToText(binding));
  const auto rotation_MS =
      stored ? std::optional(stored->rotation_MS) : std::optional<Eigen::Quaterniond>();
  const bool remounted = stored && !stored->slipped && device.mounted_sensor().slipped();
  if (Same(rotation_MS, device.mounted_sensor().rotation_MS()) && !remounted) return false;
  device.mounted_sensor().SetMounting(rotation_MS, binding.role);
  return true;
}

bool SetupKeeper::Changed() {
  const bool changed = store_.revision() != applied_revision_;
  applied_revision_ = store_.revision();
  due_ = due_ || changed;
  return changed;
}

std::optional<std::vector<stream::RigSetup>> SetupKeeper::Publish() {
  if (std::set<std::string> rigs = devices_.RigsWithBoards(); rigs != published_board_rigs_) {
    published_board_rigs_ = std::move(rigs);
    due_ = true;
  }
  return std::exchange(due_, false) ? std::optional(InForce()) : std::nullopt;
}

/// The set-up of every rig that has one or a board, with the geometry by which its boards' samples
/// are computed.
std::vector<stream::RigSetup> SetupKeeper::InForce() const {
  std::vector<stream::RigSetup> setup = store_.Rigs();
  for (const std::string& rig : devices_.RigsWithBoards()) {
    const bool has_one =
        std::any_of(setup.begin(), setup.end(), [&rig](const auto& one) { return one.rig == rig; });
    if (!has_one) setup.emplace_back().rig = rig;
  }
  for (const auto& [rig, shown] : prompts_) {
    auto one = std::find_if(setup.begin(), setup.end(),
                            [&name = rig](const auto& other) { return other.rig == name; });
    if (one == setup.end()) {
      one = setup.emplace(setup.end());
      one->rig = rig;
    }
    one->prompt = shown.prompt;
  }
  for (stream::RigSetup& one : setup) {
    one.layout.left_geometry = one.layout.right_geometry = config_.plate.geometry;
  }
  return setup;
}

/// A second board that comes to a layout of one is reported once, and the layout is to be redone.
bool SetupKeeper::WatchLayouts() {
  bool changed = false;
  for (const std::string& rig : devices_.RigsWithBoards()) {
    const std::string problem =
        board::ProblemWith(store_.LayoutOf(rig), devices_.AttachedBoards(rig), rig);
    if (problem.empty()) {
      if (crowded_rigs_.erase(rig) > 0) changed = true;
    } else if (crowded_rigs_.insert(rig).second) {
      store_.MarkStale(rig, "layout", "", problem);
      changed = true;
      log_({problem, "", true});
    }
  }
  return changed;
}

bool SetupKeeper::Watch() {
  bool changed = WatchLayouts();
  for (const auto& device : devices_) {
    const std::string& serial = device->identity().serial;
    const Binding& binding = device->binding();
    if (device->chain().moved() && !store_.Moved(serial) && store_.LayoutChecked(binding.rig)) {
      store_.SetMoved(serial, true);
      store_.MarkStale(binding.rig, "layout", "", "board " + serial + " was moved");
      store_.MarkStale(binding.rig, "tare", serial, "the board was moved");
      changed = true;
      log_({"board " + serial + " was moved: footing-ctl setup --only tare --only layout", serial,
            true});
    }
    auto stored = store_.MountingOf(serial, ToText(binding));
    if (stored && device->mounted_sensor().slipped() && !stored->slipped) {
      stored->slipped = true;
      store_.SetMounting(serial, stored);
      store_.MarkStale(binding.rig, "mounting", serial, "it slipped");
      changed = true;
      log_({serial + " has slipped on the " + stream::Name(binding.role) +
                ": footing-ctl setup --only mounting",
            serial, true});
    }
  }
  return changed;
}

/// A board that should be one of two is alone, or one that should be alone is not; empty when all
/// is well.
std::string SetupKeeper::BoardNote(const stream::DeviceStatus& status) const {
  if (status.state == stream::DeviceState::kLost) return "";
  const std::size_t boards = devices_.AttachedBoards(status.rig);
  const stream::BoardLayout layout = store_.LayoutOf(status.rig);
  if (layout.preset == "single") return board::ProblemWith(layout, boards, status.rig);
  return boards < 2
             ? "one board alone: weight beside it is not measured; switch the other on, or say "
               "that there is none: footing-ctl layout --preset single"
             : "";
}

void SetupKeeper::AddTo(Placement placement, stream::DeviceStatus& status) const {
  if (placement == Placement::kUnderFeet) {
    status.moved = store_.Moved(status.serial);
    if (status.note.empty()) status.note = BoardNote(status);
    return;
  }
  const auto stored = store_.MountingOf(status.serial, ToText({status.rig, status.role}));
  status.slipped = stored && stored->slipped;
}

}  // namespace footing::sensor

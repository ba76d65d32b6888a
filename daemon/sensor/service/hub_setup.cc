// The set-up's commands, and which part of the stored set-up holds for which device.
#include <algorithm>
#include <cmath>

#include "common/base/number.h"
#include "common/base/units.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

using decode::Placement;
using stream::DeviceRole;

constexpr double kTareWindowS = 2;
constexpr double kLeastTareWindowS = 0.5;
constexpr double kMostTareWindowS = 30;
constexpr std::size_t kMostNameBytes = 64;
constexpr std::size_t kMostNoteBytes = 1024;
constexpr std::size_t kMostPrompts = 16;

bool IsOnBody(DeviceRole role) {
  switch (role) {
    case DeviceRole::kLeftHand:
    case DeviceRole::kRightHand:
    case DeviceRole::kLeftLeg:
    case DeviceRole::kRightLeg:
    case DeviceRole::kHead:
    case DeviceRole::kTrunk:
      return true;
    case DeviceRole::kUnspecified:
    case DeviceRole::kLeftBoard:
    case DeviceRole::kRightBoard:
    case DeviceRole::kEditor:
    case DeviceRole::kLeftUpperArm:
    case DeviceRole::kRightUpperArm:
    case DeviceRole::kLeftForearm:
    case DeviceRole::kRightForearm:
      return false;
  }
  return false;
}

bool Same(const std::optional<Eigen::Quaterniond>& a, const std::optional<Eigen::Quaterniond>& b) {
  return a.has_value() == b.has_value() && (!a || a->coeffs() == b->coeffs());
}

}  // namespace

/// Roles that a command gave outlive a restart.
void Hub::KeepRole(const std::string& serial, const Binding& binding) {
  assigned_[serial] = binding;
  store_.SetRole(serial, binding.role == DeviceRole::kUnspecified ? "" : ToText(binding));
  if (!store_.MountingOf(serial, ToText(binding))) {
    store_.MarkStale(binding.rig, "mounting", serial, "its role is new");
  }
}

void Hub::ApplySetup(Device& device) {
  const std::string& serial = device.identity().serial;
  const Binding& binding = device.binding();
  const auto tare = store_.TareOf(serial);
  device.chain().SetTare(tare ? std::optional(tare->offset) : std::nullopt);
  const auto stored = store_.MountingOf(serial, ToText(binding));
  const auto rotation_MS =
      stored ? std::optional(stored->rotation_MS) : std::optional<Eigen::Quaterniond>();
  const bool remounted = stored && !stored->slipped && device.mounted_sensor().slipped();
  if (Same(rotation_MS, device.mounted_sensor().rotation_MS()) && !remounted) return;
  device.mounted_sensor().SetMounting(rotation_MS, binding.role);
  // What was felt before lies in another frame.
  if (const auto rig = rigs_.find(binding.rig); rig != rigs_.end()) {
    rig->second.extractor =
        std::make_unique<features::RigFeatureExtractor>(binding.rig, rig->second.members);
  }
}

void Hub::ApplySetupToAll() {
  for (const auto& device : devices_) ApplySetup(*device);
  status_due_ = true;
}

/// The set-up of every rig that has one or a board, with the geometry by which its boards' samples
/// are computed.
std::vector<stream::RigSetup> Hub::SetupInForce() const {
  std::vector<stream::RigSetup> setup = store_.Rigs();
  for (const std::string& rig : RigsWithBoards()) {
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

/// Alarms that the devices' own watches raise; they are stored until that part is done again.
void Hub::WatchSetup() {
  WatchLayouts();
  for (const auto& device : devices_) {
    const std::string& serial = device->identity().serial;
    const Binding& binding = device->binding();
    if (device->chain().moved() && !store_.Moved(serial) && store_.LayoutChecked(binding.rig)) {
      store_.SetMoved(serial, true);
      store_.MarkStale(binding.rig, "layout", "", "board " + serial + " was moved");
      store_.MarkStale(binding.rig, "tare", serial, "the board was moved");
      status_due_ = true;
      ports_.log({"board " + serial + " was moved: footing-ctl setup --only tare --only layout",
                  serial, true});
    }
    auto stored = store_.MountingOf(serial, ToText(binding));
    if (stored && device->mounted_sensor().slipped() && !stored->slipped) {
      stored->slipped = true;
      store_.SetMounting(serial, stored);
      store_.MarkStale(binding.rig, "mounting", serial, "it slipped");
      status_due_ = true;
      ports_.log({serial + " has slipped on the " + stream::Name(binding.role) +
                      ": footing-ctl setup --only mounting",
                  serial, true});
    }
  }
}

void Hub::AddSetupTo(Placement placement, stream::DeviceStatus& status) const {
  if (placement == Placement::kUnderFeet) {
    status.moved = store_.Moved(status.serial);
    if (status.note.empty()) status.note = BoardNote(status);
    return;
  }
  const auto stored = store_.MountingOf(status.serial, ToText({status.rig, status.role}));
  status.slipped = stored && stored->slipped;
}

Result<Device*> Hub::Attached(const std::string& serial) {
  Device* found = WithSerial(serial);
  if (found == nullptr) return NoDevice("no device with serial " + serial + " was seen");
  if (!found->attached()) return NoDevice("device " + serial + " is not attached; switch it on");
  return found;
}

Result<Hub::Measured> Hub::Tare(const std::string& serial, double window_s, bool clear) {
  if (clear) {
    store_.SetTare(serial, std::nullopt);
    return Measured{0, "N", "the tare of " + serial + " is forgotten"};
  }
  const auto found = Attached(serial);
  if (!found) return found.error();
  if ((*found)->placement() != Placement::kUnderFeet) {
    return UsageError(serial + " is a " + stream::Name((*found)->kind()) +
                      "; only boards are tared");
  }
  if (window_s == 0) window_s = kTareWindowS;
  if (!(window_s >= kLeastTareWindowS && window_s <= kMostTareWindowS)) {
    return UsageError("tare: window_s must be from 0.5 to 30");
  }
  const tare::Tare tare = (*found)->chain().SolveTare(ports_.now_ns(), window_s);
  if (!tare.ok) return Failure("tare of " + serial + ": " + tare.problem);
  store_.SetTare(serial, setup::StoredTare{tare.offset, tare.residual_n});
  return Measured{tare.residual_n, "N",
                  "empty it shows " + text::Fixed(board::Total(tare.offset), 1) + " N"};
}

Result<Device*> Hub::AttachedOnBody(const std::string& serial) {
  auto found = Attached(serial);
  if (!found) return found;
  const Device& device = **found;
  if (device.placement() != Placement::kOnBody || !IsOnBody(device.binding().role)) {
    return UsageError(
        serial + " is " + ToText(device.binding()) +
        "; only devices on hands, legs, head and trunk have a mounting (footing-ctl assign)");
  }
  return found;
}

Result<Hub::Measured> Hub::SolveMounting(const std::string& serial,
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
  TakeMounting(binding, {serial, solved.rotation_MS, solved.residual_rad});
  const double turn_rad = solved.rotation_MS.angularDistance(Eigen::Quaterniond::Identity());
  return Measured{RadiansToDegrees(solved.residual_rad), "deg",
                  "turned by " + text::Fixed(RadiansToDegrees(turn_rad), 0) +
                      " degrees against a perfect mounting"};
}

Result<Hub::Measured> Hub::ClearMounting(const std::string& serial) {
  store_.SetMounting(serial, std::nullopt);
  return Measured{0, "deg", "the mounting of " + serial + " is forgotten"};
}

Result<void> Hub::RecordSetup(const std::string& rig, const stream::SetupItem& item, bool forget) {
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

Result<void> Hub::ShowPrompt(std::uint64_t session, const std::string& rig,
                             const std::optional<stream::SetupPrompt>& prompt) {
  const std::string& name = rig.empty() ? config_.default_rig : rig;
  if (const auto checked = CheckRig(name); !checked) {
    return UsageError("show_prompt: " + checked.error().message);
  }
  content_.has_setup = true;
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

void Hub::TakeMounting(const Binding& binding, const stream::DeviceMounting& mounting) {
  setup::StoredMounting stored;
  stored.role = ToText(binding);
  stored.rotation_MS = mounting.rotation_MS;
  stored.residual_rad = mounting.residual_rad;
  store_.SetMounting(mounting.serial, stored);
}

}  // namespace footing::sensor

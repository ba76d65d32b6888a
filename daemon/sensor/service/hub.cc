#include "daemon/sensor/service/hub.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "daemon/sensor/mounting/hands.h"

namespace footing::sensor {
namespace {

constexpr std::int64_t kStatusIntervalNs = 200'000'000;

}  // namespace

Hub::Hub(const Config& config, Ports ports)
    : config_(config), ports_(std::move(ports)), store_(ports_.storage) {
  for (const auto& [serial, text] : config_.roles) {
    if (auto binding = ParseBinding(text)) assigned_[serial] = std::move(binding).value();
  }
  for (const auto& [serial, text] : store_.roles()) {
    auto binding = ParseBinding(text);
    if (!binding) {
      ports_.log({"the stored role of " + serial + " is ignored: " + binding.error().message,
                  serial, true});
      continue;
    }
    const auto configured = assigned_.find(serial);
    if (configured != assigned_.end() && configured->second != *binding) {
      ports_.log({serial + " is " + text + " by the last command, no longer " +
                      config_.roles.at(serial) + " as in the config",
                  serial});
    }
    assigned_[serial] = std::move(binding).value();
  }
}

Device* Hub::Find(devices::DeviceHandle handle) {
  for (const auto& device : devices_) {
    if (device->Owns(handle)) return device.get();
  }
  return nullptr;
}

Device* Hub::WithSerial(const std::string& serial) {
  for (const auto& device : devices_) {
    if (device->identity().serial == serial) return device.get();
  }
  return nullptr;
}

Device* Hub::Numbered(std::uint32_t number) {
  for (const auto& device : devices_) {
    if (device->number() == number) return device.get();
  }
  return nullptr;
}

void Hub::OnDetach(devices::DeviceHandle handle, const std::string& reason) {
  Device* device = Find(handle);
  if (device == nullptr) return;
  device->Detach(handle, reason);
  status_due_ = true;
  if (device->attached()) return;  // Its other link is still there.
  leases_.erase(device->number());
  const std::string& serial = device->identity().serial;
  ports_.log({"device " + std::to_string(device->number()) + " (" + serial + ") lost: " + reason,
              serial, true});
}

void Hub::TakeRaw(const Device& device, std::int64_t at_ns, std::span<const std::uint8_t> bytes,
                  bool to_device, std::int64_t true_ns, bool feature) {
  if (content_.raw.size() >= kMaxSamplesPerTick || bytes.size() > 64) return;
  stream::RawReport raw;
  raw.device = device.number();
  raw.received_ns = at_ns;
  raw.report.assign(bytes.begin(), bytes.end());
  raw.to_device = to_device;
  raw.feature = feature;
  raw.simulated = device.simulated();
  raw.true_ns = true_ns;
  content_.raw.push_back(std::move(raw));
}

void Hub::AddToRig(const Device& device, const stream::MotionSample& sample) {
  const auto rig = rigs_.find(device.binding().rig);
  if (rig == rigs_.end()) return;
  rig->second.extractor->AddSample(sample);
  rig->second.decoded_ns = ports_.now_ns();
}

void Hub::OnReport(devices::DeviceHandle handle, const devices::IncomingReport& report) {
  Device* device = Find(handle);
  if (device == nullptr) return;
  TakeRaw(*device, report.received_ns, report.bytes, false, report.true_ns, report.feature);
  const Device::Taken taken = device->Take(handle, report, content_);
  if (taken.calibration && ports_.save_calibration) {
    ports_.save_calibration(device->identity().serial, *taken.calibration);
  }
  if (taken.other_kind) Bind(*device);
  for (const stream::MotionSample& sample : taken.motion) {
    AddToRig(*device, device->mounted_sensor().Take(sample));
  }
  Flush(*device);
}

/// Writes the device's next report if one is due.
void Hub::Flush(Device& device) {
  if (!device.attached()) return;
  const std::int64_t now_ns = ports_.now_ns();
  if (ports_.request_feature) {
    if (const auto feature = device.NextFeature(now_ns)) {
      ports_.request_feature(device.feature_handle(), feature->id, feature->size);
      TakeRaw(device, now_ns, std::span(&feature->id, 1), true, 0, true);
    }
  }
  const auto report = device.NextOutput(now_ns);
  if (!report) return;
  ports_.send(device.handle(), *report);
  TakeRaw(device, now_ns, *report, true, 0);
}

void Hub::PublishStatus(std::int64_t now_ns) {
  std::vector<stream::DeviceState> states;
  std::vector<stream::DeviceStatus> status;
  for (const auto& device : devices_) {
    status.push_back(device->Status(now_ns, config_.stale_after_s));
    AddSetupTo(device->placement(), status.back());
    states.push_back(status.back().state);
  }
  if (!status_due_ && states == last_states_ && now_ns - status_ns_ < kStatusIntervalNs) return;
  status_due_ = false;
  status_ns_ = now_ns;
  last_states_ = std::move(states);
  content_.has_status = true;
  content_.status = std::move(status);
}

TickContent Hub::Tick(std::int64_t now_ns) {
  EndLeases(now_ns);
  for (const auto& device : devices_) {
    device->Advance(now_ns);
    Flush(*device);
  }
  for (auto& [name, rig] : rigs_) {
    stream::RigFeatures features = rig.extractor->Compute(now_ns);
    features.decoded_ns = rig.decoded_ns;
    for (stream::DeviceFeatures& one : features.devices) {
      const Device* device = Numbered(one.device);
      one.simulated = device != nullptr && device->simulated();
    }
    features.computed_ns = ports_.now_ns();
    content_.features.push_back(std::move(features));
  }
  if (store_.revision() != published_revision_) {
    published_revision_ = store_.revision();
    content_.has_setup = true;
    ApplySetupToAll();
  }
  if (std::set<std::string> rigs = RigsWithBoards(); rigs != published_board_rigs_) {
    published_board_rigs_ = std::move(rigs);
    content_.has_setup = true;
  }
  if (content_.has_setup) content_.setup = SetupInForce();
  WatchSetup();
  for (const std::string& line : refusals_.Due(now_ns)) ports_.log({line, "", true});
  PublishStatus(now_ns);
  PublishExposures();
  return std::exchange(content_, {});
}

// The boards of a rig, and whether its layout is for as many.
namespace {

using decode::Placement;

constexpr std::size_t kMostRigBytes = 64;

}  // namespace

std::set<std::string> Hub::RigsWithBoards() const {
  std::set<std::string> rigs;
  for (const auto& device : devices_) {
    if (device->placement() == Placement::kUnderFeet) rigs.insert(device->binding().rig);
  }
  return rigs;
}

std::size_t Hub::AttachedBoards(const std::string& rig) const {
  return static_cast<std::size_t>(
      std::count_if(devices_.begin(), devices_.end(), [&rig](const auto& device) {
        return device->attached() && device->placement() == Placement::kUnderFeet &&
               device->binding().rig == rig;
      }));
}

/// A second board that comes to a layout of one is reported once, and the layout is to be redone.
void Hub::WatchLayouts() {
  for (const std::string& rig : RigsWithBoards()) {
    const std::string problem = board::ProblemWith(store_.LayoutOf(rig), AttachedBoards(rig), rig);
    if (problem.empty()) {
      if (crowded_rigs_.erase(rig) > 0) status_due_ = true;
    } else if (crowded_rigs_.insert(rig).second) {
      store_.MarkStale(rig, "layout", "", problem);
      status_due_ = true;
      ports_.log({problem, "", true});
    }
  }
}

/// A board that should be one of two is alone, or one that should be alone is not; empty when all
/// is well.
std::string Hub::BoardNote(const stream::DeviceStatus& status) const {
  if (status.state == stream::DeviceState::kLost) return "";
  const std::size_t boards = AttachedBoards(status.rig);
  const stream::BoardLayout layout = store_.LayoutOf(status.rig);
  if (layout.preset == "single") return board::ProblemWith(layout, boards, status.rig);
  return boards < 2
             ? "one board alone: weight beside it is not measured; switch the other on, or say "
               "that there is none: footing-ctl layout --preset single"
             : "";
}

Result<Hub::Measured> Hub::SetBoardLayout(stream::BoardLayout layout) {
  if (layout.rig.empty()) layout.rig = config_.default_rig;
  if (layout.rig.size() > kMostRigBytes) return UsageError("layout: the rig's name is too long");
  if (auto problem = board::Problem(layout); !problem.empty()) return UsageError(problem);
  if (auto problem = board::ProblemWith(layout, AttachedBoards(layout.rig), layout.rig);
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

// Hands that trackers see, loads under feet that insoles feel, and the true poses of simulated
// bodies.
namespace {

/// Clocks of sources at once: eight skeletons of 16 points. The one that was silent for longest
/// gives way to another.
constexpr std::size_t kMostExposures = 128;

int PartOf(const stream::HandSample& sample) {
  return 100 * static_cast<int>(sample.role) + static_cast<int>(sample.joint);
}

/// The newest sample of a source shows that its samples of the same read are older than was said.
template <typename Sample, typename IsOfSource>
void MakeEarlier(std::vector<Sample>& samples, std::int64_t received_ns, std::int64_t earlier_ns,
                 const IsOfSource& is_of_source) {
  if (earlier_ns == 0) return;
  for (Sample& sample : samples) {
    if (sample.received_ns == received_ns && is_of_source(sample)) sample.sampled_ns -= earlier_ns;
  }
}

}  // namespace

hands::ExposureClock::Exposure Hub::Expose(const Exposed& what, const hands::FrameTimes& times) {
  if (!exposures_.contains(what) && exposures_.size() >= kMostExposures) {
    exposures_.erase(std::min_element(
        exposures_.begin(), exposures_.end(), [](const auto& one, const auto& other) {
          return one.second.received_ns() < other.second.received_ns();
        }));
  }
  return exposures_[what].Take(times);
}

void Hub::PublishExposures() {
  for (auto& [what, clock] : exposures_) clock.Publish();
}

void Hub::OnHands(std::int64_t received_ns, const stream::HandFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a hand frame", problem);
    return;
  }
  const hands::FrameTimes times = {received_ns, frame.sent_ns, frame.age_ns};
  for (stream::HandSample& sample : hands::ToSamples(frame, received_ns, config_.default_rig)) {
    if (content_.hands.size() >= kMaxSamplesPerTick) return;
    const auto exposure = Expose({'h', sample.rig, sample.tracker, PartOf(sample)}, times);
    sample.sampled_ns = exposure.sampled_ns;
    MakeEarlier(content_.hands, received_ns, exposure.others_earlier_ns, [&](const auto& other) {
      return other.rig == sample.rig && other.tracker == sample.tracker &&
             PartOf(other) == PartOf(sample);
    });
    content_.hands.push_back(std::move(sample));
  }
}

void Hub::OnReference(std::int64_t received_ns, const stream::ReferenceFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a reference frame", problem);
    return;
  }
  if (content_.reference.size() >= kMaxReferencesPerTick) return;
  stream::ReferencePose pose = hands::ToPose(frame, received_ns, config_.default_rig);
  const Exposed what = {'r', pose.rig, "", 0};
  pose.sampled_ns = Expose(what, {received_ns, frame.sent_ns, frame.age_ns}).sampled_ns;
  exposures_[what].Publish();
  content_.reference.push_back(std::move(pose));
}

void Hub::OnContacts(std::int64_t received_ns, const stream::ContactFrame& frame) {
  if (const std::string problem = hands::Problem(frame); !problem.empty()) {
    Refuse("a contact frame", problem);
    return;
  }
  if (content_.contacts.size() >= kMaxContactsPerTick) return;
  stream::ContactSample sample = hands::ToSample(frame, received_ns, config_.default_rig);
  const auto exposure = Expose({'c', sample.rig, sample.source, static_cast<int>(sample.body)},
                               {received_ns, frame.sent_ns, frame.age_ns});
  sample.sampled_ns = exposure.sampled_ns;
  MakeEarlier(content_.contacts, received_ns, exposure.others_earlier_ns, [&](const auto& other) {
    return other.rig == sample.rig && other.source == sample.source && other.body == sample.body;
  });
  content_.contacts.push_back(std::move(sample));
}

void Hub::Refuse(const std::string& what, const std::string& why) {
  if (const auto line = refusals_.Add(ports_.now_ns(), what, why)) ports_.log({*line, "", true});
}

// Which devices are taken, and which give way to others.
namespace {

/// Why a second device of one serial is not taken; empty when it is.
std::string WhyNotTwice(const Device& first, const devices::DeviceIdentity& second,
                        bool second_link) {
  if (!second.simulated)
    return "";  // A real one that is found again, or in a simulated one's place.
  if (!first.simulated()) {
    return "a simulated device with the serial of the real device " + second.serial + " is ignored";
  }
  if (second_link) return "";
  return "a second simulated device with the serial " + second.serial +
         " is ignored: the first one is still there; end it, or choose another serial or seed";
}

}  // namespace

/// A new Device; null when there is no place for it.
Device* Hub::AddDevice(bool simulated) {
  if (devices_.size() >= kMaxDevices && !FreePlaceFor(simulated)) return nullptr;
  DeviceOptions options;
  options.plate = config_.plate;
  options.kind.local_gravity_mps2 = config_.local_gravity_mps2;
  options.kind.handshake.motion_plus = config_.motion_plus;
  options.kind.handshake.camera = config_.camera;
  options.kind.handshake.status_interval_s = config_.status_interval_s;
  devices_.push_back(std::make_unique<Device>(++last_number_, options));
  return devices_.back().get();
}

bool Hub::FreePlaceFor(bool simulated) {
  const auto lost = std::find_if(devices_.begin(), devices_.end(),
                                 [](const auto& device) { return !device->attached(); });
  if (lost != devices_.end()) {
    devices_.erase(lost);
    return true;
  }
  if (simulated) return false;
  const auto newest = std::find_if(devices_.rbegin(), devices_.rend(),
                                   [](const auto& device) { return device->simulated(); });
  if (newest == devices_.rend()) return false;
  DropSimulated(**newest, "there are " + std::to_string(kMaxDevices) +
                              " devices already, and a real device takes its place");
  devices_.erase(std::next(newest).base());
  return true;
}

/// Later messages of its links are ignored; the caller gives its place to another.
void Hub::DropSimulated(const Device& device, const std::string& why) {
  const std::string line =
      "simulated device " + device.identity().serial + " is no longer taken: " + why;
  ports_.log({line, device.identity().serial, true});
  leases_.erase(device.number());
  if (!ports_.refuse) return;
  ports_.refuse(device.handle(), line);
  if (device.feature_handle() != device.handle()) ports_.refuse(device.feature_handle(), line);
}

std::string Hub::OnAttach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  Device* device = WithSerial(identity.serial);
  const bool there = device != nullptr && device->attached();
  const bool second_link = there && device->has_second_link() &&
                           device->simulated() == identity.simulated &&
                           device->identity().bus != identity.bus;
  const std::string why = there ? WhyNotTwice(*device, identity, second_link) : "";
  if (!why.empty()) {
    ports_.log({why, identity.serial, true});
    return why;
  }
  if (second_link) {
    device->AttachSecond(handle, identity);
    status_due_ = true;
    ports_.log({"device " + std::to_string(device->number()) + " (" + identity.serial +
                    ") is on a second link: " + identity.place,
                identity.serial});
    Flush(*device);
    return "";
  }
  if (there && device->simulated()) {
    DropSimulated(*device, "the real device with this serial is there");
  }
  if (device == nullptr) device = AddDevice(identity.simulated);
  if (device == nullptr) {
    const std::string full =
        "more than " + std::to_string(kMaxDevices) + " devices: " + identity.serial + " is ignored";
    ports_.log({full, identity.serial, true});
    return full;
  }
  Device::Stored stored;
  if (ports_.load_calibration) stored = ports_.load_calibration(identity.serial);
  device->Attach(handle, identity, stored);
  Bind(*device);
  ports_.log({std::string(identity.simulated ? "simulated " : "") + stream::Name(device->kind()) +
                  " " + identity.serial + " attached as device " +
                  std::to_string(device->number()) + ", " + ToText(device->binding()) +
                  WhyOtherRole(*device) + ": " + identity.place,
              identity.serial});
  device->Advance(ports_.now_ns());
  Flush(*device);
  return "";
}

// Which device has which role, and whose samples a rig's features come from.
namespace {

using stream::DeviceRole;

constexpr std::size_t kMaxRigMembers = 8;  // Limit of RigFeatureExtractor.

}  // namespace

/// A real device that comes back gets its role back from a simulated one that has it in the
/// meantime, unless it was assigned to that one.
bool Hub::GivesWay(const Device& holder, const Device& device) const {
  return !device.simulated() && holder.simulated() && holder.binding() == device.binding() &&
         !assigned_.contains(holder.identity().serial);
}

Binding Hub::ChooseBinding(const Device& device) const {
  const devices::DeviceIdentity& identity = device.identity();
  const auto assigned = assigned_.find(identity.serial);
  if (assigned != assigned_.end() && RoleFits(device.placement(), assigned->second.role)) {
    return assigned->second;
  }
  std::vector<Binding> taken;
  for (const auto& other : devices_) {
    if (other.get() == &device || !other->attached() || GivesWay(*other, device)) continue;
    taken.push_back(other->binding());
  }
  const auto is_free = [&taken](const Binding& binding) {
    return std::find(taken.begin(), taken.end(), binding) == taken.end();
  };
  // One that comes back keeps its role.
  const Binding& before = device.binding();
  if (before.role != DeviceRole::kUnspecified && RoleFits(device.placement(), before.role) &&
      is_free(before)) {
    return before;
  }
  Binding wish = {identity.wished_rig.empty() ? config_.default_rig : identity.wished_rig,
                  identity.wished_role};
  if (wish.role == DeviceRole::kUnspecified || !RoleFits(device.placement(), wish.role) ||
      !is_free(wish)) {
    wish.role = FirstFreeRole(device.placement(), wish.rig, taken);
  }
  return wish;
}

std::string Hub::WhyOtherRole(const Device& device) const {
  const DeviceRole wished = device.identity().wished_role;
  if (wished == DeviceRole::kUnspecified || wished == device.binding().role) return "";
  const std::string text = std::string(", not ") + stream::Name(wished) + " as it asked: ";
  if (!RoleFits(device.placement(), wished)) {
    return text + "a " + stream::Name(device.kind()) + " cannot be that";
  }
  const bool assigned = assigned_.contains(device.identity().serial);
  return text + (assigned ? ToText(device.binding()) + " is assigned to it" : "that is taken");
}

void Hub::Bind(Device& device) {
  Rebind(device, ChooseBinding(device));
  if (device.binding().role == DeviceRole::kUnspecified) return;
  for (const auto& other : devices_) {
    if (other.get() != &device && other->attached() && GivesWay(*other, device)) {
      Rebind(*other, ChooseBinding(*other));
    }
  }
}

void Hub::Rebind(Device& device, const Binding& binding) {
  device.set_binding(binding);
  status_due_ = true;
  ApplySetup(device);
  RebuildRigs();
}

/// Rigs whose members stayed as they are keep their features. A lost device stays a member of its
/// rig until its role goes to another.
void Hub::RebuildRigs() {
  std::map<std::string, std::vector<features::Member>> members;
  for (const auto& device : devices_) {
    const Binding& binding = device->binding();
    if (device->placement() != decode::Placement::kOnBody ||
        binding.role == DeviceRole::kUnspecified) {
      continue;
    }
    auto& rig = members[binding.rig];
    const auto holder = std::find_if(rig.begin(), rig.end(), [&binding](const auto& member) {
      return member.role == binding.role;
    });
    if (holder != rig.end()) {
      if (device->attached()) holder->device = device->number();
    } else if (rig.size() < kMaxRigMembers) {
      rig.push_back({device->number(), binding.role});
    }
  }
  std::erase_if(rigs_, [&members](const auto& rig) { return !members.contains(rig.first); });
  for (auto& [name, wanted] : members) {
    Rig& rig = rigs_[name];
    const bool same = std::equal(
        rig.members.begin(), rig.members.end(), wanted.begin(), wanted.end(),
        [](const auto& a, const auto& b) { return a.device == b.device && a.role == b.role; });
    if (same) continue;
    rig.members = wanted;
    rig.extractor = std::make_unique<features::RigFeatureExtractor>(name, wanted);
  }
}

Result<void> Hub::AssignRole(const std::string& serial, const Binding& binding) {
  if (const auto rig = CheckRig(binding.rig); !rig) {
    return UsageError("assign_role: " + rig.error().message);
  }
  Device* const found = WithSerial(serial);
  if (found == nullptr) return NoDevice("no device with serial " + serial + " was seen");
  Device& device = *found;
  if (!RoleFits(device.placement(), binding.role)) {
    return UsageError(std::string("a ") + stream::Name(device.kind()) + " cannot be " +
                      stream::Name(binding.role));
  }
  const Binding before = device.binding();
  for (const auto& other : devices_) {
    if (other.get() == &device || other->binding() != binding) continue;
    KeepRole(other->identity().serial, before);
    Rebind(*other, before);
  }
  KeepRole(serial, binding);
  Rebind(device, binding);
  return {};
}

// The set-up's commands, and which part of the stored set-up holds for which device.
namespace {

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
  // Earlier readings are in another frame.
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

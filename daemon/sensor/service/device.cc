#include "daemon/sensor/service/device.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/stream/roles.h"

namespace footing::sensor {
namespace {

using decode::Placement;
using stream::DeviceRole;

constexpr std::size_t kMaxRigBytes = 64;

constexpr DeviceRole kBodyRoles[] = {DeviceRole::kLeftHand, DeviceRole::kRightHand,
                                     DeviceRole::kLeftLeg,  DeviceRole::kRightLeg,
                                     DeviceRole::kHead,     DeviceRole::kTrunk};
constexpr DeviceRole kBoardRoles[] = {DeviceRole::kLeftBoard, DeviceRole::kRightBoard};

std::span<const DeviceRole> RolesOf(Placement placement) {
  switch (placement) {
    case Placement::kOnBody:
      return kBodyRoles;
    case Placement::kUnderFeet:
      return kBoardRoles;
    case Placement::kInBothHands:
    case Placement::kByChoice:
      break;
  }
  return {};
}

}  // namespace

Result<void> CheckRig(const std::string& rig) {
  if (!rig.empty() && rig.size() <= kMaxRigBytes && text::IsPrintable(rig)) return {};
  return UsageError("the rig's name " + text::Quoted(rig) + " must be 1 to " +
                    std::to_string(kMaxRigBytes) + " bytes without control characters");
}

Result<Binding> ParseBinding(const std::string& text) {
  const std::size_t slash = text.rfind('/');  // A rig's name may have one, a role's has none.
  if (slash == std::string::npos || slash == 0) {
    return UsageError("role " + text::Quoted(text) +
                      " is not of the form rig/role, e.g. main/left_hand");
  }
  const std::string rig = text.substr(0, slash), name = text.substr(slash + 1);
  if (const auto checked = CheckRig(rig); !checked) return checked.error();
  const DeviceRole role = stream::RoleNamed(name);
  if (role == DeviceRole::kUnspecified) {
    return UsageError("role " + text::Quoted(name) + " does not exist; there are " +
                      stream::RoleNames());
  }
  return Binding{rig, role};
}

std::string ToText(const Binding& binding) {
  return binding.rig + "/" + stream::Name(binding.role);
}

DeviceRole FirstFreeRole(Placement placement, const std::string& rig,
                         const std::vector<Binding>& taken) {
  for (const DeviceRole role : RolesOf(placement)) {
    if (std::find(taken.begin(), taken.end(), Binding{rig, role}) == taken.end()) return role;
  }
  return DeviceRole::kUnspecified;
}

bool IsOnBody(DeviceRole role) {
  return std::find(std::begin(kBodyRoles), std::end(kBodyRoles), role) != std::end(kBodyRoles);
}

bool RoleFits(Placement placement, DeviceRole role) {
  if (role == DeviceRole::kUnspecified) return true;
  if (placement == Placement::kInBothHands) return role == DeviceRole::kEditor;
  const bool of_board = role == DeviceRole::kLeftBoard || role == DeviceRole::kRightBoard;
  return of_board == (placement == Placement::kUnderFeet);
}

void Links::Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  attached_ = true;
  reason_.clear();
  handle_ = handle;
  identity_ = identity;
  second_.reset();
}

bool Links::AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  second_ = handle;
  second_identity_ = identity;
  if (identity.bus == devices::Bus::kUsb) return false;
  std::swap(*second_, handle_);
  std::swap(second_identity_, identity_);
  return true;
}

void Links::Detach(devices::DeviceHandle handle, const std::string& reason) {
  if (second_) {
    if (handle == handle_) {
      handle_ = *second_;
      identity_ = second_identity_;
    }
    second_.reset();
    return;
  }
  attached_ = false;
  reason_ = reason;
}

void SampleTiming::Restart(const decode::Timing& timing) {
  timing_ = timing;
  link::DeviceClockConfig config;
  config.nominal_period_s = timing.report_period_s;
  config.sensor_period_s = timing.sensor_period_s;
  config.max_lag_s = timing.max_lag_s;
  clock_ = link::DeviceClock(config);
  own_clock_ = link::OwnClock(timing.own_rate_range);
  own_times_ = false;
  statistics_ = link::LinkStatistics(timing.report_period_s);
}

void SampleTiming::Take(std::int64_t received_ns, const decode::Decoded& decoded) {
  statistics_.Advance(received_ns);
  std::int64_t newest_ns = 0;
  if (decoded.own_times) {
    const std::int64_t own_ns = decoded.motion.back().sampled_ns;
    own_clock_.Take(received_ns, own_ns);
    newest_ns = std::min(own_clock_.HostNs(own_ns), received_ns);
  } else {
    if (own_times_) own_clock_ = link::OwnClock(timing_.own_rate_range);
    newest_ns = clock_.Advance(received_ns, decoded.changed);
  }
  own_times_ = decoded.own_times;
  sampled_ns_ = std::max(sampled_ns_, newest_ns);
}

std::int64_t SampleTiming::TimeOf(const decode::Decoded& decoded, std::size_t i,
                                  std::int64_t before_ns) const {
  const double count = static_cast<double>(decoded.motion.size());
  const double back = count - 1 - static_cast<double>(i);
  const std::int64_t at_ns =
      decoded.own_times
          ? own_clock_.HostNs(decoded.motion[i].sampled_ns)
          : sampled_ns_ - SecondsToNanoseconds(back * timing_.report_period_s / count);
  return std::clamp(at_ns, before_ns, sampled_ns_);
}

void Device::Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity,
                    const Stored& stored) {
  links_.Attach(handle, identity);
  kind_ =
      kinds::MakeKind(options_.kind, {identity.vendor, identity.product, identity.name}, stored);
  stored_calibration_ = stored.value_or(std::vector<std::uint8_t>());
  outputs_.clear();
  ShowBinding();
  Restart();
}

void Device::set_binding(Binding binding) {
  const bool other = binding.role != binding_.role;
  binding_ = std::move(binding);
  if (other) ShowBinding();
}

void Device::ShowBinding() {
  leds_set_ = false;
  const bool has_role = binding_.role != stream::DeviceRole::kUnspecified;
  leds_ = static_cast<std::uint8_t>(has_role ? stream::LedsOf(binding_.role)
                                             : 1u << ((number_ - 1) % 4));  // As a player's number.
}

/// Everything that belongs to one uninterrupted stream.
void Device::Restart() {
  timing_.Restart(kind_->timing());
  outbox_ = link::Outbox(kind_->writing());
  kind_->Restart();
  motion_ = MotionChain();
  chain_.Restart();
  mounted_sensor_.Restart();
  // These are shares of the reports, which count from the attach as well.
  counters_.repeats = counters_.clipped = counters_.undecodable = 0;
}

void Device::AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  if (links_.AttachSecond(handle, identity)) Restart();
  kind_->OnSecondLink();
}

void Device::SetLeds(std::uint8_t leds) {
  leds_ = leds & 0x0f;
  kind_->SetLamps(leds_, outputs_);
  PushOutputs();
}

void Device::PushOutputs() {
  for (reports::OutputReport& output : outputs_) outbox_.Push(std::move(output));
  outputs_.clear();
}

void Device::Advance(std::int64_t now_ns) {
  if (!attached()) return;
  kind_->Advance(now_ns, outputs_);
  PushOutputs();
  if (kind_->live() && !leds_set_) {
    leds_set_ = true;
    SetLeds(leds_);
  }
}

std::optional<reports::OutputReport> Device::NextOutput(std::int64_t now_ns) {
  return attached() ? kind_->NextOutput(now_ns, outbox_) : std::nullopt;
}

std::optional<decode::FeatureRequest> Device::NextFeature(std::int64_t now_ns) {
  return attached() ? kind_->NextFeature(now_ns) : std::nullopt;
}

Device::Taken Device::Take(devices::DeviceHandle handle, const devices::IncomingReport& report,
                           TickContent& content) {
  Taken taken;
  if (handle == links_.handle()) {
    counters_.queue_drops = report.dropped;
    counters_.writes_failed = report.writes_failed;
  }
  if (report.feature) {
    taken.calibration = kind_->TakeFeature(report.bytes);
    return taken;
  }
  if (handle != links_.handle()) return taken;
  const stream::DeviceKind before = kind();
  auto decoded = kind_->Take(report.received_ns, report.bytes, outputs_);
  PushOutputs();
  taken.other_kind = kind() != before;
  if (taken.other_kind) timing_.Restart(kind_->timing());
  const std::size_t motion_before = content.motion.size();
  if (!decoded) {
    ++counters_.undecodable;
  } else if (!decoded->empty()) {
    TakeDecoded(report, *decoded, content);
  }
  taken.motion = std::span(content.motion).subspan(motion_before);
  return taken;
}

bool Device::HasSpace(const TickContent& content) {
  if (content.motion.size() + content.boards.size() + content.gamepads.size() < kMaxSamplesPerTick)
    return true;
  ++counters_.flooded;
  return false;
}

template <typename Sample>
void Device::Stamp(const devices::IncomingReport& report, Sample& sample) const {
  sample.device = number_;
  sample.received_ns = report.received_ns;
  sample.sampled_ns = timing_.sampled_ns();
  sample.simulated = simulated();
}

void Device::TakeDecoded(const devices::IncomingReport& report, decode::Decoded& decoded,
                         TickContent& content) {
  if (!HasSpace(content)) return;
  const std::int64_t before_ns = timing_.sampled_ns();
  if (!decoded.buttons_only) timing_.Take(report.received_ns, decoded);
  TakeMotion(report, decoded, before_ns, content);
  if (decoded.board) TakeBoard(report, *decoded.board, content);
  if (decoded.nunchuk) {
    Stamp(report, *decoded.nunchuk);
    decoded.nunchuk->report_count = timing_.statistics().reports();
    content.nunchuks.push_back(*decoded.nunchuk);
  }
  if (decoded.gamepad) {
    Stamp(report, *decoded.gamepad);
    decoded.gamepad->report_count = timing_.statistics().reports();
    content.gamepads.push_back(*decoded.gamepad);
  }
  if (decoded.camera) {
    Stamp(report, *decoded.camera);
    content.cameras.push_back(std::move(*decoded.camera));
  }
}

void Device::TakeMotion(const devices::IncomingReport& report, decode::Decoded& decoded,
                        std::int64_t before_ns, TickContent& content) {
  const bool measured = !decoded.buttons_only;
  for (std::size_t i = 0; i < decoded.motion.size(); ++i) {
    stream::MotionSample& sample = decoded.motion[i];
    const std::int64_t sampled_ns = timing_.TimeOf(decoded, i, before_ns);
    Stamp(report, sample);
    sample.sampled_ns = sampled_ns;
    sample.report_count = timing_.statistics().reports();
    motion_.Take(sample, measured);
    counters_.repeats += sample.repeated && measured ? 1 : 0;
    counters_.clipped += sample.clipped_axes != 0 ? 1 : 0;
    content.motion.push_back(sample);
  }
}

void Device::TakeBoard(const devices::IncomingReport& report, const decode::BoardReading& reading,
                       TickContent& content) {
  stream::BoardSample sample;
  Stamp(report, sample);
  sample.report_count = timing_.statistics().reports();
  sample.uncalibrated = reading.uncalibrated;
  chain_.Take(reading.forces, sample);
  counters_.repeats += sample.repeated ? 1 : 0;
  content.boards.push_back(sample);
}

stream::DeviceStatus Device::Status(std::int64_t now_ns, double stale_after_s) const {
  stream::DeviceStatus status;
  status.device = number_;
  status.serial = identity().serial;
  status.bus = static_cast<std::uint32_t>(identity().bus);
  status.vendor = identity().vendor;
  status.product = identity().product;
  status.rig = binding_.rig;
  status.role = binding_.role;
  status.simulated = simulated();
  status.name = identity().name;
  status.driver = identity().driver;
  status.place = identity().place;
  status.reports = timing_.statistics().reports();
  status.gaps = timing_.statistics().gaps();
  status.repeats = counters_.repeats;
  status.clipped = counters_.clipped;
  status.undecodable = counters_.undecodable;
  status.queue_drops = counters_.queue_drops;
  status.writes_failed = counters_.writes_failed;
  status.rumble = outbox_.rumble();
  if (kind_->has_lamps()) status.leds = leds_;
  status.last_report_ns = timing_.statistics().last_ns();
  status.tared = chain_.tared() && placement() == decode::Placement::kUnderFeet;
  status.mounted = mounted_sensor_.rotation_MS().has_value();
  kind_->AddTo(status);
  if (status.calibration == stream::CalibrationOrigin::kStored) {
    status.stored_calibration = stored_calibration_;
  }
  AddState(now_ns, stale_after_s, status);
  return status;
}

void Device::AddState(std::int64_t now_ns, double stale_after_s,
                      stream::DeviceStatus& status) const {
  const link::LinkStatistics& link = timing_.statistics();
  if (!attached()) {
    status.state = stream::DeviceState::kLost;
    status.note = links_.reason();
    return;
  }
  const double silent_s = NanosecondsToSeconds(now_ns - link.last_ns());
  status.report_rate_hz = link.RateHz(now_ns);
  status.jitter_ms = link.JitterMs();
  const double clock_sd_s = timing_.sampled_sd_s();
  status.clock_offset_sd_ms = clock_sd_s < 0 ? -1 : clock_sd_s * 1e3;
  status.state = !kind_->live()             ? stream::DeviceState::kConnecting
                 : silent_s > stale_after_s ? stream::DeviceState::kStale
                                            : stream::DeviceState::kLive;
  status.note = kind_->Note(now_ns);
  if (status.note.empty() && counters_.flooded > 0) {
    status.note = std::to_string(counters_.flooded) + " samples dropped: it sends too many";
  }
}

}  // namespace footing::sensor

#include "daemon/sensor/service/device.h"

#include <algorithm>
#include <utility>

namespace footing::sensor {
namespace {

using stream::DeviceKind;

constexpr double kWiimotePeriodS = 0.01;
constexpr double kBoardPeriodS = 1 / 83.6;  // As recorded on a good link.
constexpr double kBoardSensorPeriodS = 1 / 60.0;
constexpr double kMovePeriodS = 1 / 88.0;  // psmoveapi.
constexpr double kMoveLowBattery = 0.21;   // One bar of five.

bool IsMove(const devices::DeviceIdentity& identity) {
  return identity.vendor == devices::kVendorSony;
}

}  // namespace

DeviceKind Device::kind() const { return move_ ? DeviceKind::kPsMove : handshake_.kind(); }

void Device::Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity,
                    const Stored& stored) {
  attached_ = true;
  detach_reason_.clear();
  handle_ = handle;
  identity_ = identity;
  second_.reset();
  move_.reset();
  if (IsMove(identity)) {
    const auto model = identity.product == devices::kProductZcm2 ? reports::MoveModel::kZcm2
                                                                 : reports::MoveModel::kZcm1;
    move_ = Move{handshake::MoveHandshake(model, stored), decode::PsMove(model)};
  }
  fresh_calibration_.reset();
  handshake_ = handshake::Handshake(options_.handshake, identity.name);
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

void Device::RestartClock() {
  period_s_ = move_                                 ? kMovePeriodS
              : kind() == DeviceKind::kBalanceBoard ? kBoardPeriodS
                                                    : kWiimotePeriodS;
  link::DeviceClockConfig clock_config;
  clock_config.nominal_period_s = period_s_;
  clock_config.sensor_period_s =
      kind() == DeviceKind::kBalanceBoard ? kBoardSensorPeriodS : period_s_;
  clock_ = link::DeviceClock(clock_config);
  statistics_ = link::LinkStatistics(period_s_);
}

/// Everything that belongs to one uninterrupted stream.
void Device::Restart() {
  RestartClock();
  outbox_ = link::Outbox();
  wiimote_ = decode::Wiimote();
  board_ = decode::BalanceBoard(options_.local_gravity_mps2);
  filter_ = signal::KalmanFilter();
  gyroscope_bias_ = calibration::GyroscopeBias();
  chain_.Restart();
  worn_.Restart();
}

void Device::AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  second_ = handle;
  second_identity_ = identity;
  if (identity.bus != devices::Bus::kUsb) {
    std::swap(*second_, handle_);
    std::swap(second_identity_, identity_);
    Restart();
  }
  if (move_) move_->handshake.AskAgain();
}

void Device::Detach(devices::DeviceHandle handle, const std::string& reason) {
  if (second_) {
    if (handle == handle_) {
      handle_ = *second_;
      identity_ = second_identity_;
    }
    second_.reset();
    return;
  }
  attached_ = false;
  detach_reason_ = reason;
}

void Device::SetLeds(std::uint8_t leds) {
  leds_ = leds & 0x0f;
  if (!move_) outbox_.Push(reports::SetLeds(leds_));
}

bool Device::SetSphere(std::uint32_t rgb) {
  if (move_) move_->handshake.set_sphere(rgb);
  return move_.has_value();
}

bool Device::SetCamera(bool on) {
  if (kind() != DeviceKind::kWiimote) return false;
  handshake_.SetCamera(on);
  return true;
}

bool Device::RequestStatus(std::int64_t now_ns) {
  return !move_ && handshake_.RequestStatus(now_ns);
}

void Device::PushOutputs() {
  for (reports::OutputReport& output : outputs_) outbox_.Push(std::move(output));
  outputs_.clear();
}

void Device::Advance(std::int64_t now_ns) {
  if (!attached_ || move_) return;
  handshake_.Advance(now_ns, outputs_);
  PushOutputs();
  if (handshake_.live() && !leds_set_) {
    leds_set_ = true;
    SetLeds(leds_);
  }
}

std::optional<reports::OutputReport> Device::NextOutput(std::int64_t now_ns) {
  if (!attached_) return std::nullopt;
  return move_ ? move_->handshake.NextOutput(now_ns, outbox_.rumble()) : outbox_.Next(now_ns);
}

std::optional<Device::FeatureRequest> Device::NextFeature(std::int64_t now_ns) {
  if (!attached_ || !move_ || !move_->handshake.WantsFeature(now_ns)) return std::nullopt;
  return FeatureRequest{second_.value_or(handle_), reports::kMoveCalibrationFeature,
                        reports::kMoveCalibrationFeatureBytes};
}

Device::Stored Device::TakeFreshCalibration() { return std::exchange(fresh_calibration_, {}); }

void Device::Take(devices::DeviceHandle handle, const devices::IncomingReport& report,
                  TickContent& content) {
  if (handle == handle_) {
    queue_drops_ = report.dropped;
    writes_failed_ = report.writes_failed;
  }
  if (report.feature) {
    if (move_ && move_->handshake.TakeFeature(report.bytes)) {
      fresh_calibration_ = move_->handshake.blob();
    }
    return;
  }
  if (handle != handle_) return;
  if (move_) {
    TakeMove(report, content);
    return;
  }
  const reports::InputReport decoded = reports::Decode(report.bytes);
  if (std::holds_alternative<reports::Undecodable>(decoded.body)) {
    ++undecodable_;
    return;
  }
  const DeviceKind before = kind();
  handshake_.Take(report.received_ns, decoded, outputs_);
  PushOutputs();
  if (kind() != before) RestartClock();
  if (!handshake_.live()) return;
  if (kind() == DeviceKind::kBalanceBoard) {
    const auto* data = std::get_if<reports::Data>(&decoded.body);
    if (data == nullptr) return;
    const auto reading = board_.Take(handshake_.board(), data->extension());
    if (reading) TakeBoard(report, *reading, content);
    return;
  }
  const decode::WiimoteSetup setup = {
      handshake_.acceleration(), handshake_.nunchuk(), handshake_.motion_plus(),
      handshake_.extension_ready() ? handshake_.extension() : stream::Extension::kUnspecified,
      handshake_.extension_epoch()};
  decode::Decoded samples = wiimote_.Take(setup, decoded);
  if (!samples.empty()) TakeDecoded(report, samples, content);
}

void Device::TakeMove(const devices::IncomingReport& report, TickContent& content) {
  if (!move_->handshake.live()) return;
  auto decoded = move_->decoder.Take(move_->handshake.calibration(), report.bytes);
  if (decoded) {
    TakeDecoded(report, *decoded, content);
  } else {
    ++undecodable_;
  }
}

bool Device::HasRoom(const TickContent& content) {
  if (content.motion.size() + content.boards.size() < kMaxSamplesPerTick) return true;
  ++flooded_;
  return false;
}

void Device::TakeDecoded(const devices::IncomingReport& report, decode::Decoded& decoded,
                         TickContent& content) {
  if (!HasRoom(content)) return;
  const std::int64_t before_ns = sampled_ns_;
  if (!decoded.buttons_only) {
    statistics_.Advance(report.received_ns);
    sampled_ns_ = std::max(sampled_ns_, clock_.Advance(report.received_ns, decoded.changed));
  }
  const auto half_ns = static_cast<std::int64_t>(period_s_ * 0.5e9);
  for (std::size_t i = 0; i < decoded.motion_count; ++i) {
    stream::MotionSample& sample = decoded.motion[i];
    const bool older = i + 1 < decoded.motion_count;
    sample.received_ns = report.received_ns;
    sample.sampled_ns =
        older ? std::clamp(sampled_ns_ - half_ns, before_ns, sampled_ns_) : sampled_ns_;
    TakeMotion(sample, !decoded.buttons_only, content);
  }
  const auto stamp = [&](auto& sample) {
    sample.device = number_;
    sample.received_ns = report.received_ns;
    sample.sampled_ns = sampled_ns_;
    sample.simulated = simulated();
  };
  if (decoded.nunchuk) {
    stamp(*decoded.nunchuk);
    decoded.nunchuk->report_count = statistics_.reports();
    content.nunchuks.push_back(*decoded.nunchuk);
  }
  if (decoded.camera) {
    stamp(*decoded.camera);
    content.cameras.push_back(std::move(*decoded.camera));
  }
}

void Device::TakeMotion(stream::MotionSample& sample, bool measured, TickContent& content) {
  sample.device = number_;
  sample.report_count = statistics_.reports();
  sample.simulated = simulated();
  if (measured) filtered_mps2_ = filter_.Advance(sample.sampled_ns, sample.specific_force_mps2);
  sample.filtered_mps2 = filtered_mps2_;
  if (sample.has_angular_velocity) {
    gyroscope_bias_.Take(sample.sampled_ns, sample.specific_force_mps2,
                         sample.angular_velocity_radps);
    sample.gyroscope_bias_radps = gyroscope_bias_.bias_radps();
    sample.angular_velocity_radps -= sample.gyroscope_bias_radps;
  }
  repeats_ += sample.repeated && measured ? 1 : 0;
  clipped_ += sample.clipped_axes != 0 ? 1 : 0;
  content.motion.push_back(sample);
}

void Device::TakeBoard(const devices::IncomingReport& report, const decode::BoardReading& measured,
                       TickContent& content) {
  if (!HasRoom(content)) return;
  statistics_.Advance(report.received_ns);
  sampled_ns_ = std::max(sampled_ns_, clock_.Advance(report.received_ns, measured.changed));
  stream::BoardSample sample;
  sample.device = number_;
  sample.report_count = statistics_.reports();
  sample.received_ns = report.received_ns;
  sample.sampled_ns = sampled_ns_;
  sample.uncalibrated = handshake_.board().origin == stream::CalibrationOrigin::kDefaults;
  sample.simulated = simulated();
  chain_.Take(measured.forces, sample);
  repeats_ += sample.repeated ? 1 : 0;
  content.boards.push_back(sample);
}

std::string Device::Note(std::int64_t now_ns) const {
  if (move_) return move_->handshake.calibration().problem;
  std::string note = handshake_.Note(now_ns);
  if (note.empty() && kind() == DeviceKind::kBalanceBoard) note = board_.Note();
  return note;
}

stream::DeviceStatus Device::Status(std::int64_t now_ns, double stale_after_s) const {
  stream::DeviceStatus status;
  status.device = number_;
  status.serial = identity_.serial;
  status.kind = kind();
  status.rig = binding_.rig;
  status.role = binding_.role;
  status.simulated = simulated();
  status.name = identity_.name;
  status.driver = identity_.driver;
  status.place = identity_.place;
  status.reports = statistics_.reports();
  status.gaps = statistics_.gaps();
  status.repeats = repeats_;
  status.clipped = clipped_;
  status.undecodable = undecodable_;
  status.queue_drops = queue_drops_;
  status.writes_failed = writes_failed_;
  status.rumble = outbox_.rumble();
  status.last_report_ns = statistics_.last_ns();
  status.tared = chain_.tared() && kind() == DeviceKind::kBalanceBoard;
  status.mounted = worn_.rotation_MS().has_value();
  if (move_) {
    status.calibration = status.gyroscope_calibration = move_->handshake.calibration().origin;
    status.battery_fraction = move_->decoder.battery_fraction();
    status.battery_low = status.battery_fraction >= 0 && status.battery_fraction < kMoveLowBattery;
    status.sphere_rgb = move_->handshake.sphere_rgb();
    status.extension = stream::Extension::kNone;
  } else {
    status.calibration = handshake_.calibration_origin();
    status.extension = handshake_.extension();
    status.extension_calibration = handshake_.extension_origin();
    status.gyroscope_calibration = handshake_.gyroscope_origin();
    status.extension_changes = handshake_.extension_changes();
    status.mode_reasserts = handshake_.mode_reasserts();
    status.leds = leds_;
  }
  if (kind() == DeviceKind::kBalanceBoard) {
    // A board's status report says nothing about its battery.
    status.battery_fraction = board_.battery_fraction();
    status.battery_low = board_.battery_low();
  } else if (!move_ && handshake_.status()) {
    status.battery_low = handshake_.status()->battery_low;
    status.battery_fraction = reports::BatteryFraction(handshake_.status()->battery);
  }
  const double silent_s = static_cast<double>(now_ns - statistics_.last_ns()) * 1e-9;
  if (!attached_) {
    status.state = stream::DeviceState::kLost;
    status.note = detach_reason_;
    return status;
  }
  status.report_rate_hz = statistics_.RateHz(now_ns);
  status.jitter_ms = statistics_.JitterMs();
  status.state = !live()                    ? stream::DeviceState::kConnecting
                 : silent_s > stale_after_s ? stream::DeviceState::kStale
                                            : stream::DeviceState::kLive;
  status.note = Note(now_ns);
  if (status.note.empty() && flooded_ > 0) {
    status.note = std::to_string(flooded_) + " samples dropped: it sends too many";
  }
  return status;
}

}  // namespace footing::sensor

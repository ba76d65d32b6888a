#include "daemon/sensor/service/device.h"

#include <utility>

#include "daemon/sensor/calibration/acceleration.h"
#include "daemon/sensor/calibration/board.h"

namespace footing::sensor {
namespace {

using stream::DeviceKind;

constexpr double kWiimotePeriodS = 0.01;
constexpr double kBoardPeriodS = 1 / 83.6;  // As recorded on a good link.

}  // namespace

void Device::Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  attached_ = true;
  detach_reason_.clear();
  handle_ = handle;
  identity_ = identity;
  handshake_ = handshake::Handshake({}, identity.name);
  const double period_s =
      handshake_.kind() == DeviceKind::kBalanceBoard ? kBoardPeriodS : kWiimotePeriodS;
  link::DeviceClockConfig clock_config;
  clock_config.nominal_period_s = period_s;
  clock_ = link::DeviceClock(clock_config);
  statistics_ = link::LinkStatistics(period_s);
  outbox_ = link::Outbox();
  filter_ = signal::KalmanFilter();
  plate_ = board::Plate(plate_config_);
  has_last_counts_ = false;
  leds_set_ = false;
  leds_ = static_cast<std::uint8_t>(1u << ((number_ - 1) % 4));  // As a player's number.
  board_battery_fraction_ = -1;
}

void Device::Detach(const std::string& reason) {
  attached_ = false;
  detach_reason_ = reason;
}

void Device::SetLeds(std::uint8_t leds) {
  leds_ = leds & 0x0f;
  outbox_.Push(reports::SetLeds(leds_));
}

void Device::PushOutputs() {
  for (reports::OutputReport& output : outputs_) outbox_.Push(std::move(output));
  outputs_.clear();
}

void Device::Advance(std::int64_t now_ns) {
  if (!attached_) return;
  handshake_.Advance(now_ns, outputs_);
  PushOutputs();
  if (handshake_.live() && !leds_set_) {
    leds_set_ = true;
    SetLeds(leds_);
  }
}

void Device::Take(const devices::IncomingReport& report, TickContent& content) {
  const reports::InputReport decoded = reports::Decode(report.bytes);
  if (std::holds_alternative<reports::Undecodable>(decoded.body)) {
    ++undecodable_;
    return;
  }
  handshake_.Take(report.received_ns, decoded, outputs_);
  PushOutputs();
  const auto* data = std::get_if<reports::Data>(&decoded.body);
  if (data != nullptr && handshake_.live()) TakeData(report, decoded, *data, content);
}

void Device::TakeData(const devices::IncomingReport& report, const reports::InputReport& decoded,
                      const reports::Data& data, TickContent& content) {
  const bool is_board = kind() == DeviceKind::kBalanceBoard;
  const auto board_counts = reports::DecodeBoard(data.extension());
  // Buttons alone, as under a mode that another program set: valid, but no sample.
  if (is_board ? !board_counts : !data.has_acceleration) return;
  if (content.motion.size() + content.boards.size() >= kMaxSamplesPerTick) {
    ++flooded_;
    return;
  }
  statistics_.Advance(report.received_ns);
  const std::int64_t sampled_ns = clock_.Advance(report.received_ns);
  if (is_board) {
    stream::BoardSample sample;
    sample.received_ns = report.received_ns;
    sample.sampled_ns = sampled_ns;
    TakeBoard(*board_counts, sample);
    content.boards.push_back(sample);
  } else {
    stream::MotionSample sample;
    sample.received_ns = report.received_ns;
    sample.sampled_ns = sampled_ns;
    TakeMotion(decoded, data, sample);
    content.motion.push_back(sample);
  }
}

void Device::TakeMotion(const reports::InputReport& decoded, const reports::Data& data,
                        stream::MotionSample& sample) {
  const calibration::Acceleration acceleration =
      calibration::Calibrate(handshake_.acceleration(), data.acceleration_counts);
  sample.device = number_;
  sample.report_count = statistics_.reports();
  sample.specific_force_mps2 = acceleration.specific_force_S_mps2;
  sample.filtered_mps2 = filter_.Advance(sample.sampled_ns, acceleration.specific_force_S_mps2);
  sample.clipped_axes = acceleration.clipped_axes;
  sample.buttons = decoded.buttons;
  sample.repeated = has_last_counts_ && data.acceleration_counts == last_counts_ &&
                    decoded.buttons == last_buttons_;
  sample.uncalibrated = handshake_.acceleration().origin == stream::CalibrationOrigin::kDefaults;
  sample.simulated = simulated();
  has_last_counts_ = true;
  last_counts_ = data.acceleration_counts;
  last_buttons_ = decoded.buttons;
  repeats_ += sample.repeated ? 1 : 0;
  clipped_ += sample.clipped_axes != 0 ? 1 : 0;
}

void Device::TakeBoard(const reports::BoardCounts& counts, stream::BoardSample& sample) {
  const auto corners = calibration::CornerForces(handshake_.board(), counts);
  const board::CornerForces forces = {corners[reports::kTopLeft], corners[reports::kTopRight],
                                      corners[reports::kBottomLeft],
                                      corners[reports::kBottomRight]};
  const board::PlateReading reading = plate_.Advance(forces);
  sample.device = number_;
  sample.report_count = statistics_.reports();
  sample.top_left_n = forces.top_left_n;
  sample.top_right_n = forces.top_right_n;
  sample.bottom_left_n = forces.bottom_left_n;
  sample.bottom_right_n = forces.bottom_right_n;
  sample.total_n = reading.total_n;
  sample.cop_valid = reading.cop_valid;
  sample.cop_x_m = reading.cop_x_m;
  sample.cop_y_m = reading.cop_y_m;
  sample.contact = reading.contact;
  sample.repeated = reading.repeated;
  sample.uncalibrated = handshake_.board().origin == stream::CalibrationOrigin::kDefaults;
  sample.simulated = simulated();
  repeats_ += sample.repeated ? 1 : 0;
  if (counts.has_battery) board_battery_fraction_ = reports::BoardBatteryFraction(counts.battery);
}

stream::DeviceStatus Device::Status(std::int64_t now_ns, double stale_after_s) const {
  stream::DeviceStatus status;
  status.device = number_;
  status.serial = identity_.serial;
  status.kind = kind();
  status.rig = binding_.rig;
  status.role = binding_.role;
  status.simulated = simulated();
  status.calibration = handshake_.calibration_origin();
  status.name = identity_.name;
  status.reports = statistics_.reports();
  status.gaps = statistics_.gaps();
  status.repeats = repeats_;
  status.clipped = clipped_;
  status.undecodable = undecodable_;
  status.leds = leds_;
  status.rumble = outbox_.rumble();
  status.last_report_ns = statistics_.last_ns();
  if (handshake_.status()) status.battery_low = handshake_.status()->battery_low;
  if (kind() == DeviceKind::kBalanceBoard) {
    status.battery_fraction = board_battery_fraction_;
  } else if (handshake_.status()) {
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
  status.state = !handshake_.live()         ? stream::DeviceState::kConnecting
                 : silent_s > stale_after_s ? stream::DeviceState::kStale
                                            : stream::DeviceState::kLive;
  status.note = handshake_.Note(now_ns);
  if (status.note.empty() && flooded_ > 0) {
    status.note = std::to_string(flooded_) + " samples dropped: it sends too many";
  }
  return status;
}

}  // namespace footing::sensor

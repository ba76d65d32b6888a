#include "daemon/sensor/kinds/joycon.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "common/stream/product_ids.h"

namespace footing::joycon {
namespace {

using reports::JoyconModel;
using reports::JoyconReport;
using reports::Subcommand;

constexpr std::size_t kHandshakeTasks = 7;

constexpr std::uint8_t kOn[] = {0x01};
constexpr std::uint8_t kMotionMode[] = {reports::kJoyconMotion};

}  // namespace

Handshake::Handshake() {
  for (std::size_t task = 0; task < kHandshakeTasks; ++task) Want(static_cast<Task>(task), kTries);
}

reports::OutputReport Handshake::ReportOf(Task task) const {
  const auto read = [](const reports::JoyconBlock& block) {
    return reports::JoyconRead(block.address, block.size);
  };
  switch (task) {
    case kInfo:
      return reports::JoyconCommand(Subcommand::kDeviceInfo, {});
    case kFactoryMotion:
      return read(reports::kJoyconFactoryMotion);
    case kUserMotion:
      return read(reports::kJoyconUserMotion);
    case kFactorySticks:
      return read(reports::kJoyconFactorySticks);
    case kUserSticks:
      return read(reports::kJoyconUserSticks);
    case kSensorOn:
      return reports::JoyconCommand(Subcommand::kMotionSensor, kOn);
    case kMode:
      return reports::JoyconCommand(Subcommand::kReportMode, kMotionMode);
    case kLamps:
      return reports::JoyconCommand(Subcommand::kLamps, std::span(&leds_, 1));
    case kVibration:
      return reports::JoyconCommand(Subcommand::kVibration, kOn);
    case kTaskCount:
      break;
  }
  return {};
}

std::vector<std::uint8_t>* Handshake::BlockOf(Task task) {
  switch (task) {
    case kFactoryMotion:
      return &blocks_.factory_motion;
    case kUserMotion:
      return &blocks_.user_motion;
    case kFactorySticks:
      return &blocks_.factory_sticks;
    case kUserSticks:
      return &blocks_.user_sticks;
    case kInfo:
    case kSensorOn:
    case kMode:
    case kLamps:
    case kVibration:
    case kTaskCount:
      break;
  }
  return nullptr;
}

void Handshake::Advance(std::int64_t now_ns, kinds::Outputs& outputs) {
  if (asked_ && now_ns - asked_ns_ < kTimeoutNs) return;
  asked_.reset();
  if (settled_) WatchStream(now_ns);
  const auto next = std::find_if(states_.begin(), states_.end(),
                                 [](const State& state) { return state.tries_left > 0; });
  const auto task = static_cast<std::size_t>(next - states_.begin());
  if (!settled_ && task >= kHandshakeTasks) {
    settled_ = true;
    calibration_ = calibration::ParseJoycon(blocks_);
    samples_ns_ = sensor_asked_ns_ = block_asked_ns_ = now_ns;
  }
  if (next == states_.end()) return;
  --next->tries_left;
  asked_ = static_cast<Task>(task);
  asked_ns_ = now_ns;
  outputs.push_back(ReportOf(*asked_));
}

/// Wants again what has come undone.
void Handshake::WatchStream(std::int64_t now_ns) {
  if (now_ns - samples_ns_ >= silent_ns_) {
    Want(kMode, 1);
    ++mode_reasserts_;
    samples_ns_ = now_ns;
    silent_ns_ = std::min(2 * silent_ns_, kMostSilentNs);
  }
  if (!sensor_works_ && now_ns - sensor_asked_ns_ >= kSensorAgainNs) {
    Want(kSensorOn, 1);
    sensor_asked_ns_ = now_ns;
  }
  if (now_ns - block_asked_ns_ < kBlockAgainNs) return;
  block_asked_ns_ = now_ns;
  for (const Task block : {kFactoryMotion, kUserMotion, kFactorySticks, kUserSticks}) {
    if (!states_[block].answered) return Want(block, 1);
  }
}

void Handshake::TakeReply(const reports::JoyconReply& reply) {
  answered_ = true;
  if (!asked_) return;
  const reports::OutputReport asked = ReportOf(*asked_);
  constexpr std::size_t kSubcommandAt = 10;
  if (asked[kSubcommandAt] != reply.subcommand) return;
  std::vector<std::uint8_t>* const block = BlockOf(*asked_);
  if (block != nullptr && reply.acknowledged) {
    // Another program's read of another block may be answered in between.
    constexpr std::size_t kAddressAt = kSubcommandAt + 1;
    const reports::JoyconBlock wanted = {
        static_cast<std::uint32_t>(asked[kAddressAt] | asked[kAddressAt + 1] << 8),
        asked[kAddressAt + 4]};
    const auto bytes = reports::BlockIn(reply, wanted);
    if (bytes.empty()) return;
    block->assign(bytes.begin(), bytes.end());
    if (settled_) calibration_ = calibration::ParseJoycon(blocks_);
  }
  states_[*asked_] = {0, true};
  asked_.reset();
}

void Handshake::TakeSamples(std::int64_t now_ns, bool sensor_works) {
  samples_ns_ = now_ns;
  silent_ns_ = kSilentNs;
  sensor_works_ = sensor_works;
}

void Handshake::SetLamps(std::uint8_t leds) {
  leds_ = leds & 0x0f;
  Want(kLamps, kTries);
  if (asked_ == kLamps) asked_.reset();  // Its answer would be that to the earlier ones.
}

void Handshake::AllowRumble() {
  if (!rumble_wanted_) Want(kVibration, kTries);
  rumble_wanted_ = true;
}

namespace {

/// A rate that changes by more than this between two samples, 210 degrees/s in 5 ms, is none: a
/// hard swing of the wrist reaches 100.
constexpr int kJumpCounts = 3000;
constexpr double kJumpWeight = 0.1;
constexpr double kManyJumps = 0.5, kFewJumps = 0.2;

struct ButtonPair {
  std::uint32_t from;  ///< Bit of reports::JoyconButton.
  std::uint32_t to;
};

constexpr std::uint32_t kWiimoteA = 0x0008, kWiimoteB = 0x0004, kWiimoteHome = 0x0080;
/// The Wiimote's buttons that serve for these: a trigger below for B, so that either hand has one.
constexpr ButtonPair kAsWiimote[] = {
    {reports::kJoyconA, kWiimoteA},       {reports::kJoyconL, kWiimoteA},
    {reports::kJoyconR, kWiimoteA},       {reports::kJoyconB, kWiimoteB},
    {reports::kJoyconZl, kWiimoteB},      {reports::kJoyconZr, kWiimoteB},
    {reports::kJoyconX, 0x0002},          {reports::kJoyconY, 0x0001},
    {reports::kJoyconMinus, 0x0010},      {reports::kJoyconPlus, 0x1000},
    {reports::kJoyconHome, kWiimoteHome}, {reports::kJoyconCapture, kWiimoteHome},
    {reports::kJoyconLeft, 0x0100},       {reports::kJoyconRight, 0x0200},
    {reports::kJoyconDown, 0x0400},       {reports::kJoyconUp, 0x0800},
};
constexpr ButtonPair kAsGamepad[] = {
    {reports::kJoyconA, stream::kGamepadA},
    {reports::kJoyconB, stream::kGamepadB},
    {reports::kJoyconX, stream::kGamepadX},
    {reports::kJoyconY, stream::kGamepadY},
    {reports::kJoyconL, stream::kGamepadL},
    {reports::kJoyconR, stream::kGamepadR},
    {reports::kJoyconZl, stream::kGamepadZl},
    {reports::kJoyconZr, stream::kGamepadZr},
    {reports::kJoyconMinus, stream::kGamepadMinus},
    {reports::kJoyconPlus, stream::kGamepadPlus},
    {reports::kJoyconHome, stream::kGamepadHome},
    {reports::kJoyconUp, stream::kGamepadUp},
    {reports::kJoyconDown, stream::kGamepadDown},
    {reports::kJoyconLeft, stream::kGamepadLeft},
    {reports::kJoyconRight, stream::kGamepadRight},
    {reports::kJoyconLeftStick, stream::kGamepadLeftStick},
    {reports::kJoyconRightStick, stream::kGamepadRightStick},
};

std::uint32_t Mapped(std::uint32_t buttons, std::span<const ButtonPair> pairs) {
  std::uint32_t mapped = 0;
  for (const ButtonPair& pair : pairs) {
    if ((buttons & pair.from) != 0) mapped |= pair.to;
  }
  return mapped;
}

bool IsJump(const reports::JoyconSample& before, const reports::JoyconSample& after) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(after.angular_velocity[axis] - before.angular_velocity[axis]) > kJumpCounts) {
      return true;
    }
  }
  return false;
}

}  // namespace

void Decoder::UpdateSensor(const JoyconReport& report) {
  const reports::JoyconSample kNone;
  const bool off = std::all_of(report.samples.begin(), report.samples.end(),
                               [&](const auto& sample) { return sample == kNone; });
  if (off) {
    sensor_ = Sensor::kOff;
    last_.reset();
    jumps_ = 0;
    return;
  }
  const reports::JoyconSample* before = last_ ? &*last_ : nullptr;
  for (const reports::JoyconSample& sample : report.samples) {
    if (before != nullptr) {
      jumps_ += kJumpWeight * ((IsJump(*before, sample) ? 1 : 0) - jumps_);
    }
    before = &sample;
  }
  const double limit = sensor_ == Sensor::kOtherMode ? kFewJumps : kManyJumps;
  sensor_ = jumps_ > limit ? Sensor::kOtherMode : Sensor::kWorks;
}

decode::Decoded Decoder::Take(const calibration::JoyconCalibration& calibration,
                              std::int64_t received_ns, const JoyconReport& report) {
  decode::Decoded decoded;
  const auto own_ns = timer_.Advance(received_ns, report.timer);
  UpdateSensor(report);
  if (sensor_ != Sensor::kOff) TakeMotion(calibration, report, decoded);
  if (own_ns) SetOwnTimes(*own_ns, decoded);
  TakeStick(calibration, report, decoded);
  if (model_ == JoyconModel::kPro) TakeGamepad(calibration, report, decoded);
  last_buttons_ = report.buttons;
  return decoded;
}

void Decoder::SetOwnTimes(std::int64_t newest_ns, decode::Decoded& decoded) {
  const auto count = static_cast<std::int64_t>(decoded.motion.size());
  if (count == 0) return;
  // Some adapters are sent reports sooner than every 15 ms, and none of their samples repeats.
  const std::int64_t spacing_ns =
      std::clamp<std::int64_t>((newest_ns - newest_ns_) / count, 0, reports::kJoyconTickNs);
  for (std::int64_t i = 0; i < count; ++i) {
    decoded.motion[static_cast<std::size_t>(i)].sampled_ns =
        newest_ns - (count - 1 - i) * spacing_ns;
  }
  decoded.own_times = true;
  newest_ns_ = newest_ns;
}

void Decoder::TakeMotion(const calibration::JoyconCalibration& calibration,
                         const JoyconReport& report, decode::Decoded& decoded) {
  for (std::size_t i = 0; i < report.samples.size(); ++i) {
    const auto reading = calibration::Calibrate(calibration, model_, report.samples[i]);
    stream::MotionSample& sample = decoded.motion.emplace_back();
    sample.specific_force_mps2 = reading.specific_force_S_mps2;
    sample.clipped_axes = reading.clipped_axes;
    sample.has_angular_velocity = sensor_ == Sensor::kWorks;
    if (sample.has_angular_velocity) {
      sample.angular_velocity_radps = reading.angular_velocity_S_radps;
      sample.angular_velocity_clipped = reading.angular_velocity_clipped;
    }
    sample.buttons = Mapped(report.buttons, kAsWiimote);
    sample.uncalibrated = calibration.origin == stream::CalibrationOrigin::kDefaults;
    sample.gyroscope_uncalibrated = sample.uncalibrated;
    const bool same = last_ && *last_ == report.samples[i];
    sample.repeated = same && report.buttons == last_buttons_;
    decoded.changed = decoded.changed || !same;
    last_ = report.samples[i];
  }
}

void Decoder::TakeStick(const calibration::JoyconCalibration& calibration,
                        const JoyconReport& report, decode::Decoded& decoded) {
  const std::size_t side = model_ == JoyconModel::kRight ? 1 : 0;
  const Eigen::Vector2d at = calibration::StickOf(calibration.sticks[side], report.sticks[side]);
  stream::NunchukSample& sample = decoded.nunchuk.emplace();
  sample.stick_x = at.x();
  sample.stick_y = at.y();
  sample.c = (report.buttons & (reports::kJoyconL | reports::kJoyconR)) != 0;
  sample.z = (report.buttons & (reports::kJoyconZl | reports::kJoyconZr)) != 0;
  if (!decoded.motion.empty()) {
    const stream::MotionSample& newest = decoded.motion.back();
    sample.specific_force_mps2 = newest.specific_force_mps2;
    sample.clipped_axes = newest.clipped_axes;
  }
  const bool moved = !last_stick_ || *last_stick_ != report.sticks[side];
  sample.repeated = !decoded.changed && !moved && report.buttons == last_buttons_;
  sample.uncalibrated = !calibration.stick_known[side];
  decoded.changed = decoded.changed || !sample.repeated;
  last_stick_ = report.sticks[side];
}

void Decoder::TakeGamepad(const calibration::JoyconCalibration& calibration,
                          const JoyconReport& report, decode::Decoded& decoded) {
  stream::GamepadSample& sample = decoded.gamepad.emplace();
  const Eigen::Vector2d left = calibration::StickOf(calibration.sticks[0], report.sticks[0]);
  const Eigen::Vector2d right = calibration::StickOf(calibration.sticks[1], report.sticks[1]);
  sample.left_x = left.x();
  sample.left_y = left.y();
  sample.right_x = right.x();
  sample.right_y = right.y();
  sample.buttons = Mapped(report.buttons, kAsGamepad);
  sample.left_trigger = (sample.buttons & stream::kGamepadL) != 0 ? 1 : 0;
  sample.right_trigger = (sample.buttons & stream::kGamepadR) != 0 ? 1 : 0;
  sample.uncalibrated = !calibration.stick_known[0] || !calibration.stick_known[1];
  sample.repeated = last_gamepad_ && decode::SameReading(*last_gamepad_, sample);
  last_gamepad_ = sample;
}

namespace {

constexpr int kLowBattery = 1;  // One bar of four.
constexpr double kFullBattery = 4;

JoyconModel ModelOf(const decode::Product& product) {
  switch (product.product) {
    case stream::kProductJoyConRight:
      return JoyconModel::kRight;
    case stream::kProductSwitchPro:
      return JoyconModel::kPro;
    default:
      return JoyconModel::kLeft;
  }
}

}  // namespace

bool Joycon::Matches(const decode::Product& product) {
  return stream::IsOfSwitch(product.vendor, product.product);
}

Joycon::Joycon(const decode::Product& product) : model_(ModelOf(product)), decoder_(model_) {}

stream::DeviceKind Joycon::kind() const {
  switch (model_) {
    case JoyconModel::kLeft:
      return stream::DeviceKind::kJoyConLeft;
    case JoyconModel::kRight:
      return stream::DeviceKind::kJoyConRight;
    case JoyconModel::kPro:
      return stream::DeviceKind::kSwitchProController;
  }
  return stream::DeviceKind::kUnspecified;
}

decode::Placement Joycon::placement() const {
  return model_ == JoyconModel::kPro ? decode::Placement::kByChoice : decode::Placement::kOnBody;
}

stream::DeviceRole Joycon::own_role() const {
  switch (model_) {
    case JoyconModel::kLeft:
      return stream::DeviceRole::kLeftHand;
    case JoyconModel::kRight:
      return stream::DeviceRole::kRightHand;
    case JoyconModel::kPro:
      break;
  }
  return stream::DeviceRole::kUnspecified;
}

std::optional<decode::Decoded> Joycon::Take(std::int64_t received_ns, reports::Bytes bytes,
                                            kinds::Outputs& outputs) {
  const auto report = reports::DecodeJoycon(bytes);
  if (!report) return std::nullopt;
  decode::Decoded decoded;
  if (report->id != reports::kJoyconSimple) {
    battery_ = report->battery;
    charging_ = report->charging;
  }
  if (report->reply) handshake_.TakeReply(*report->reply);
  if (report->has_samples) {
    decoded = decoder_.Take(handshake_.calibration(), received_ns, *report);
    handshake_.TakeSamples(received_ns, decoder_.sensor() == Decoder::Sensor::kWorks);
  }
  handshake_.Advance(received_ns, outputs);  // The best moment: right after a report.
  return live() ? decoded : decode::Decoded();
}

link::Writing Joycon::writing() const {
  // SDL: the motor every 30 ms at most, and again every 50 ms while it shakes.
  return {reports::kJoyconWriteIntervalNs, 30'000'000, 50'000'000, reports::JoyconRumbleOnly,
          reports::SetJoyconRumble};
}

std::optional<reports::OutputReport> Joycon::NextOutput(std::int64_t now_ns, link::Outbox& outbox) {
  if (outbox.rumble()) handshake_.AllowRumble();
  auto report = outbox.Next(now_ns);
  if (report) (*report)[1] = packet_++ & 0x0f;
  return report;
}

void Joycon::AddTo(stream::DeviceStatus& status) const {
  Kind::AddTo(status);
  if (live()) {
    status.calibration = status.gyroscope_calibration = handshake_.calibration().origin;
  }
  status.mode_reasserts = handshake_.mode_reasserts();
  status.battery_fraction = battery_ < 0 ? -1 : battery_ / kFullBattery;
  status.battery_low = battery_ >= 0 && battery_ <= kLowBattery && !charging_;
}

std::string Joycon::Note(std::int64_t /*now_ns*/) const {
  if (!live()) return "";
  if (handshake_.mute()) {
    return "it answers no subcommand; end other programs that use it (Steam), then switch it off "
           "and "
           "on";
  }
  switch (decoder_.sensor()) {
    case Decoder::Sensor::kOff:
      return "no motion sensor: its samples are zeros, so none are published; it is a copy without "
             "one, or another program (Steam) keeps it off";
    case Decoder::Sensor::kOtherMode:
      return "its gyroscope does not send rates, so none are published: another program (Steam) "
             "keeps it in another mode; end that one";
    case Decoder::Sensor::kWorks:
      break;
  }
  return handshake_.calibration().problem;
}

}  // namespace footing::joycon

// The sequencer's part at the extension port: what is plugged in, and what comes and goes while
// data flow.
#include <algorithm>

#include "common/base/units.h"
#include "daemon/sensor/reports/sequencer.h"

namespace footing::handshake {
namespace {

using reports::Extension;
using stream::CalibrationOrigin;

bool IsActiveMotionPlus(Extension extension) {
  return extension == Extension::kMotionPlus || extension == Extension::kMotionPlusNunchuk ||
         extension == Extension::kMotionPlusClassic;
}

}  // namespace

stream::Extension HandshakeSequencer::extension() const {
  if (!live_) return stream::Extension::kUnspecified;
  if (!plan_->remote) return stream::Extension::kNone;
  const Extension child = port_.child();
  if (motion_plus_.active()) {
    if (child == Extension::kNunchuk) return stream::Extension::kMotionPlusNunchuk;
    if (child == Extension::kClassic) return stream::Extension::kMotionPlusClassic;
    return stream::Extension::kMotionPlus;
  }
  if (!port_.has_child()) return stream::Extension::kNone;
  if (child == Extension::kNunchuk) return stream::Extension::kNunchuk;
  if (child == Extension::kClassic) return stream::Extension::kClassic;
  return stream::Extension::kUnknown;
}

CalibrationOrigin HandshakeSequencer::extension_origin() const {
  return live_ && port_.child() == Extension::kNunchuk ? port_.nunchuk.origin
                                                       : CalibrationOrigin::kUnspecified;
}

CalibrationOrigin HandshakeSequencer::gyroscope_origin() const {
  return live_ && motion_plus_.active() ? motion_plus_.calibration.origin
                                        : CalibrationOrigin::kUnspecified;
}

void HandshakeSequencer::EnterAfterAcceleration() {
  // Without a status nobody knows: look.
  const bool plugged = !status_.newest || status_.newest->extension || !plan_->remote;
  if (!answered_) {
    Enter(Step::kMode);
  } else if (plugged) {
    Enter(Step::kExtensionKey);
  } else {
    EnterAfterChild();
  }
}

void HandshakeSequencer::EnterAfterIdentity() {
  if (plan_->remote) {
    if (port_.child() == Extension::kNunchuk) {
      Enter(Step::kNunchukBlock);
    } else {
      EnterAfterChild();
    }
  } else if (blocks_.size() < plan_->blocks.size()) {
    EnterBlock();
  } else {
    EnterMode();
  }
}

void HandshakeSequencer::EnterAfterChild() {
  if (live_ && config_.motion_plus && plan_->remote && !motion_plus_.given_up()) {
    Enter(Step::kMotionPlusKey);
  } else {
    EnterCameraOrMode();
  }
}

void HandshakeSequencer::EnterCameraOrMode() {
  if (camera_.NeedsSetUp(CameraFormat())) {
    Enter(Step::kCameraPower);
  } else {
    EnterMode();
  }
}

void HandshakeSequencer::TakeIdentity(const std::vector<std::uint8_t>& bytes) {
  const Extension found = reports::IdentifyExtension(bytes);
  // Not ready, or a MotionPlus that the key should have switched off.
  const bool unsettled = found == Extension::kNotReady || IsActiveMotionPlus(found);
  if (unsettled && port_.AskAgain(config_.question.tries)) {
    Enter(Step::kExtensionKey);
    question_.Pause(config_.port.settle_s);
    return;
  }
  if (IsActiveMotionPlus(found)) {
    // It stays on; the port is checked again later.
    motion_plus_.TakeFound();
    port_.set_child(found == Extension::kMotionPlusNunchuk   ? Extension::kNunchuk
                    : found == Extension::kMotionPlusClassic ? Extension::kClassic
                                                             : Extension::kNotReady);
    EnterCameraOrMode();
    return;
  }
  for (const Plan* plan : plans_) {
    const bool ready = found != Extension::kNotReady;
    if (ready && !plan->remote && bytes[4] == plan->identity[0] && bytes[5] == plan->identity[1]) {
      plan_ = plan;
    }
  }
  if (plan_->remote) port_.set_child(found);
  EnterAfterIdentity();
}

void HandshakeSequencer::TakeMotionPlusIdentity(const std::vector<std::uint8_t>& bytes) {
  const bool found = reports::IdentifyExtension(bytes) == Extension::kMotionPlusInactive;
  const bool others = bytes.size() > 2 && bytes[2] == 0xa4;  // A reply to the kernel driver's read.
  if (!found && others && question_.tries_left()) {
    question_.Retry();
    return;
  }
  motion_plus_.TakeInactive(found, now_ns_);
  if (motion_plus_.EndPoll()) {
    Enter(Step::kLive);
    if (found) port_check_.Request(now_ns_);
  } else if (found && !motion_plus_.given_up()) {
    Enter(Step::kMotionPlusBlock);
  } else {
    EnterCameraOrMode();
  }
}

void HandshakeSequencer::TakeVerification(const std::vector<std::uint8_t>& bytes) {
  const bool active = IsActiveMotionPlus(reports::IdentifyExtension(bytes));
  if (motion_plus_.TakeVerification(active, now_ns_, config_.question.tries)) {
    Enter(Step::kMotionPlusActivate);
    return;
  }
  check_after_ = !active;
  EnterCameraOrMode();
}

void HandshakeSequencer::StartOver() {
  port_.StartOver();
  motion_plus_.StartOver();
  Enter(Step::kExtensionKey);
}

void HandshakeSequencer::Watch(std::int64_t now_ns, Outputs& outputs) {
  switch (keep_alive_.Advance(now_ns)) {
    case KeepAlive::Action::kSetMode:
      if (step() != Step::kMode && writes_.Take(now_ns)) {
        outputs.push_back(reports::SetMode(mode_, true));
      }
      break;
    case KeepAlive::Action::kAskStatus:
      RequestStatus(now_ns);
      break;
    case KeepAlive::Action::kNone:
      break;
  }
  WatchStatus(now_ns, outputs);
  if (step() == Step::kLive && plan_->remote) WatchPort(now_ns, outputs);
}

void HandshakeSequencer::WatchStatus(std::int64_t now_ns, Outputs& outputs) {
  if (config_.status_interval_s > 0 &&
      now_ns - status_.asked_ns() >= SecondsToNanoseconds(config_.status_interval_s)) {
    RequestStatus(now_ns);
  }
  if (status_.due() && writes_.Take(now_ns)) {
    status_.SetSent();
    outputs.push_back(reports::RequestStatus());
  }
}

void HandshakeSequencer::WatchPort(std::int64_t now_ns, Outputs& outputs) {
  if (port_check_.requested()) {
    if (port_check_.Take(now_ns)) StartOver();
  } else if (camera_.changed) {
    camera_.changed = false;
    if (camera_.wanted) {
      Enter(Step::kCameraPower);
      return;
    }
    camera_.format = 0;
    outputs.push_back({0x13, 0x00});
    outputs.push_back({0x1a, 0x00});
    EnterMode();
  } else if (config_.motion_plus &&
             motion_plus_.StartPoll(now_ns, SecondsToNanoseconds(config_.motion_plus_poll_s))) {
    Enter(Step::kMotionPlusIdentity);
  }
}

void HandshakeSequencer::TakeStatus(std::int64_t now_ns, const reports::Status& status) {
  status_.newest = status;
  if (step() == Step::kStatus) {
    Proceed();
    return;
  }
  if (!live_) return;
  keep_alive_.TakeStatus(now_ns);
  const bool wanted = status_.TakeWanted();
  if (!plan_->remote || port_.disturbed(now_ns)) return;
  if (!status.extension && extension_found()) port_.set_unready();
  // Otherwise compared when it is live again.
  if (step() != Step::kLive && !motion_plus_.polling()) return;
  if (status.extension == extension_found() && wanted) return;
  motion_plus_.Suspect();
  port_check_.Request(now_ns);
}

void HandshakeSequencer::TakeData(std::int64_t now_ns, const reports::Data& data) {
  if (step() == Step::kMode && question_.asked() && data.id == mode_) BecomeLive();
  if (!live_ || data.id != mode_) return;
  keep_alive_.TakeData(now_ns);
  if (port_.ready() && step() == Step::kLive) WatchExtension(now_ns, data);
}

void HandshakeSequencer::WatchExtension(std::int64_t now_ns, const reports::Data& data) {
  const reports::Bytes bytes = data.extension();
  if (motion_plus_.active()) {
    const auto connected = reports::ChildConnected(bytes);
    if (connected) port_.TakeSense(now_ns);
    // A child that comes or goes shows nowhere else.
    if (connected && motion_plus_.ChildChanged(*connected, port_.has_child())) {
      port_check_.Request(now_ns);
    }
  } else if (port_.child() != Extension::kNunchuk || reports::DecodeNunchuk(bytes)) {
    port_.TakeSense(now_ns);
  }
  if (port_.Senseless(now_ns)) {
    port_.TakeSense(now_ns);
    motion_plus_.Suspect();
    port_check_.Request(now_ns);
  }
}

}  // namespace footing::handshake

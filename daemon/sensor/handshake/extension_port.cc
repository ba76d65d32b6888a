// Handshake: what is plugged in, and what comes and goes while data flow.
#include <algorithm>
#include <utility>

#include "common/units/units.h"
#include "daemon/sensor/handshake/handshake.h"

namespace footing::handshake {
namespace {

using reports::Extension;

constexpr double kSenselessS = 1;  // Extension bytes without sense for so long: look again.
constexpr double kQuietS = 10;     // An extension settled for so long is looked at at once.
constexpr double kUndoneSoonS =
    10;                         // A MotionPlus that was on for longer was switched off by chance.
constexpr int kUndoneMost = 5;  // Switched off by somebody else so often in a row: theirs.
constexpr int kChildBitPackets = 4;  // In a row: rubbish packets have the bit at random.

bool IsActiveMotionPlus(Extension extension) {
  return extension == Extension::kMotionPlus || extension == Extension::kMotionPlusNunchuk ||
         extension == Extension::kMotionPlusClassic;
}

}  // namespace

stream::Extension Handshake::extension() const {
  if (!live_) return stream::Extension::kUnspecified;
  if (is_board()) return stream::Extension::kNone;
  if (motion_plus_active_) {
    if (child_ == Extension::kNunchuk) return stream::Extension::kMotionPlusNunchuk;
    if (child_ == Extension::kClassic) return stream::Extension::kMotionPlusClassic;
    return stream::Extension::kMotionPlus;
  }
  if (!has_child()) return stream::Extension::kNone;
  if (child_ == Extension::kNunchuk) return stream::Extension::kNunchuk;
  if (child_ == Extension::kClassic) return stream::Extension::kClassic;
  return stream::Extension::kUnknown;
}

Step Handshake::AfterAcceleration() const {
  if (!answered_) return Step::kMode;
  // Without a status nobody knows: look.
  const bool plugged = !status_ || status_->extension || named_board_;
  return plugged ? Step::kExtensionKey : AfterChild();
}

Step Handshake::AfterIdentity() const {
  if (is_board()) return has_board_ ? Step::kMode : Step::kBoardBlock;
  return child_ == Extension::kNunchuk ? Step::kNunchukBlock : AfterChild();
}

Step Handshake::AfterChild() const {
  if (live_ && config_.motion_plus && !is_board() && !motion_plus_given_up()) {
    return Step::kMotionPlusKey;
  }
  return config_.camera && camera_format_ != CameraFormat() ? Step::kCameraPower : Step::kMode;
}

bool Handshake::motion_plus_given_up() const { return motion_plus_undone_ >= kUndoneMost; }

void Handshake::EnterAfterMotionPlus() {
  if (config_.camera && camera_format_ != CameraFormat()) {
    Enter(Step::kCameraPower);
  } else {
    EnterMode();
  }
}

void Handshake::TakeIdentity(const std::vector<std::uint8_t>& bytes) {
  const Extension found = reports::IdentifyExtension(bytes);
  // Not ready, or a MotionPlus that the key should have switched off.
  const bool unsettled = found == Extension::kNotReady || IsActiveMotionPlus(found);
  if (unsettled && ++identity_tries_ < config_.tries) {
    Enter(Step::kExtensionKey);
    pause_s_ = config_.settle_s;
    return;
  }
  if (IsActiveMotionPlus(found)) {
    // It stays on: use it as it is, without calibration, and come back.
    motion_plus_active_ = true;
    motion_plus_ = calibration::ParseMotionPlus({});
    child_ = found == Extension::kMotionPlusNunchuk   ? Extension::kNunchuk
             : found == Extension::kMotionPlusClassic ? Extension::kClassic
                                                      : Extension::kNotReady;
    EnterAfterMotionPlus();
    return;
  }
  if (found == Extension::kBalanceBoard) kind_ = stream::DeviceKind::kBalanceBoard;
  if (!is_board()) child_ = found;
  const Step next = AfterIdentity();
  if (next == Step::kMode) {
    EnterMode();
  } else {
    Enter(next);
  }
}

void Handshake::TakeMotionPlusIdentity(const std::vector<std::uint8_t>& bytes) {
  const bool found = reports::IdentifyExtension(bytes) == Extension::kMotionPlusInactive;
  const bool others = bytes.size() > 2 && bytes[2] == 0xa4;  // A reply to the kernel driver's read.
  if (!found && others && tries_ < config_.tries) {
    asked_ = false;
    return;
  }
  if (std::exchange(motion_plus_lost_, false) && found) {
    const bool soon = now_ns_ - activated_ns_ < SecondsToNanoseconds(kUndoneSoonS);
    motion_plus_undone_ = soon ? motion_plus_undone_ + 1 : 1;
  }
  if (polling_) {
    polling_ = false;
    Enter(Step::kLive);
    if (found) WantRedo(now_ns_);
  } else if (found && !motion_plus_given_up()) {
    Enter(Step::kMotionPlusBlock);
  } else {
    EnterAfterMotionPlus();
  }
}

void Handshake::TakeVerification(const std::vector<std::uint8_t>& bytes) {
  motion_plus_active_ = IsActiveMotionPlus(reports::IdentifyExtension(bytes));
  if (!motion_plus_active_ && ++activations_ < config_.tries) {
    Enter(Step::kMotionPlusActivate);
    return;
  }
  redo_after_ = !motion_plus_active_;
  if (motion_plus_active_) activated_ns_ = now_ns_;
  EnterAfterMotionPlus();
}

void Handshake::StartOver() {
  extension_ready_ = false;
  motion_plus_active_ = false;
  polling_ = false;
  identity_tries_ = 0;
  activations_ = 0;
  Enter(Step::kExtensionKey);
}

void Handshake::WantRedo(std::int64_t now_ns) {
  if (redo_due_) return;
  if (now_ns - redone_ns_ > SecondsToNanoseconds(kQuietS)) redo_wait_s_ = 0;
  redo_due_ = true;
  redo_ns_ = now_ns + SecondsToNanoseconds(std::max(redo_wait_s_, config_.settle_s));
  redo_wait_s_ = std::clamp(2 * redo_wait_s_, config_.redo_min_s, config_.redo_max_s);
}

void Handshake::Watch(std::int64_t now_ns, Outputs& outputs) {
  switch (keep_alive_.Advance(now_ns)) {
    case KeepAlive::Action::kSetMode:
      if (step_ != Step::kMode && writes_.Take(now_ns)) {
        outputs.push_back(reports::SetMode(mode_, true));
      }
      break;
    case KeepAlive::Action::kAskStatus:
      RequestStatus(now_ns);
      break;
    case KeepAlive::Action::kNone:
      break;
  }
  if (config_.status_interval_s > 0 &&
      now_ns - status_asked_ns_ >= SecondsToNanoseconds(config_.status_interval_s)) {
    RequestStatus(now_ns);
  }
  if (status_due_ && writes_.Take(now_ns)) {
    status_due_ = false;
    status_wanted_ = true;
    outputs.push_back(reports::RequestStatus());
  }
  if (step_ != Step::kLive || is_board()) return;
  if (redo_due_) {
    if (now_ns < redo_ns_) return;
    redo_due_ = false;
    StartOver();
  } else if (camera_due_) {
    camera_due_ = false;
    if (config_.camera) {
      Enter(Step::kCameraPower);
    } else {
      camera_format_ = 0;
      outputs.push_back({0x13, 0x00});
      outputs.push_back({0x1a, 0x00});
      EnterMode();
    }
  } else if (config_.motion_plus && !motion_plus_active_ && !motion_plus_given_up() &&
             now_ns >= poll_ns_) {
    poll_ns_ = now_ns + SecondsToNanoseconds(config_.motion_plus_poll_s);
    polling_ = true;
    Enter(Step::kMotionPlusIdentity);
  }
}

void Handshake::TakeStatus(std::int64_t now_ns, const reports::Status& status) {
  status_ = status;
  if (step_ == Step::kStatus) {
    Proceed();
    return;
  }
  if (!live_) return;
  keep_alive_.TakeStatus(now_ns);
  const bool wanted = std::exchange(status_wanted_, false);
  if (is_board() || now_ns < dead_until_ns_) return;
  const bool found = has_child() || motion_plus_active_;
  if (!status.extension) extension_ready_ = extension_ready_ && !found;
  if (step_ != Step::kLive && !polling_) return;  // Compared when it is live again.
  if (status.extension == found && wanted) return;
  motion_plus_lost_ = motion_plus_lost_ || motion_plus_active_;
  WantRedo(now_ns);
}

void Handshake::TakeData(std::int64_t now_ns, const reports::Data& data) {
  if (step_ == Step::kMode && asked_ && data.id == mode_) BecomeLive();
  if (!live_ || data.id != mode_) return;
  keep_alive_.TakeData(now_ns);
  if (extension_ready_ && step_ == Step::kLive) WatchExtension(now_ns, data);
}

void Handshake::WatchExtension(std::int64_t now_ns, const reports::Data& data) {
  const reports::Bytes bytes = data.extension();
  if (motion_plus_active_) {
    const auto connected = reports::ChildConnected(bytes);
    if (connected) {
      extension_data_ns_ = now_ns;
      child_bit_differs_ = *connected == has_child() ? 0 : child_bit_differs_ + 1;
    }
    // A child that comes or goes shows nowhere else.
    if (child_bit_differs_ >= kChildBitPackets) {
      child_bit_differs_ = 0;
      WantRedo(now_ns);
    }
  } else if (child_ != Extension::kNunchuk || reports::DecodeNunchuk(bytes)) {
    extension_data_ns_ = now_ns;
  }
  if (now_ns - extension_data_ns_ > SecondsToNanoseconds(kSenselessS)) {
    extension_data_ns_ = now_ns;
    motion_plus_lost_ = motion_plus_lost_ || motion_plus_active_;
    WantRedo(now_ns);
  }
}

}  // namespace footing::handshake

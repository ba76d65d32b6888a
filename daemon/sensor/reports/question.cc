#include "daemon/sensor/reports/question.h"

#include <utility>

#include "common/base/units.h"

namespace footing::handshake {
namespace {

using reports::MemoryRead;

constexpr double kNoAckTimeoutS = 0.05;  // Of a device that never acknowledged.

}  // namespace

void Question::Enter(Step step, std::optional<MemoryRead> read) {
  step_ = step;
  asked_ = false;
  tries_ = 0;
  read_ = std::move(read);
  read_again_ = false;
}

Question::Wait Question::Advance(std::int64_t now_ns) {
  if (!asked_) return Wait::kNotAsked;
  const bool by_ack = EndsWithAcknowledgement(step_);
  const double timeout_s = !by_ack         ? config_.reply_timeout_s
                           : acknowledges_ ? config_.ack_timeout_s
                                           : kNoAckTimeoutS;
  if (now_ns - asked_ns_ < SecondsToNanoseconds(timeout_s)) return Wait::kWaiting;
  if (tries_ < (by_ack && !acknowledges_ ? 1 : config_.tries)) return Wait::kAskAgain;
  if (by_ack && !acknowledged_) acknowledges_ = false;
  return Wait::kGiveUp;
}

bool Question::MayAsk(std::int64_t now_ns) {
  if (pause_s_ > 0) {
    not_before_ns_ = now_ns + SecondsToNanoseconds(pause_s_);
    pause_s_ = 0;
  }
  return now_ns >= not_before_ns_;
}

void Question::SetAsked(std::int64_t now_ns) {
  asked_ = true;
  asked_ns_ = now_ns;
  ++tries_;
}

std::optional<reports::OutputReport> Question::ReadRequest() {
  if (!read_) return std::nullopt;
  read_->Restart();
  return read_->Request();
}

Question::Reading Question::Take(const reports::MemoryData& memory) {
  if (!read_ || !asked_) return Reading::kNone;
  switch (read_->Take(memory)) {
    case MemoryRead::Progress::kForeign:
    case MemoryRead::Progress::kMore:
      return Reading::kNone;
    case MemoryRead::Progress::kDone:
      return Reading::kDone;
    case MemoryRead::Progress::kRefused:
      return Reading::kRefused;
  }
  return Reading::kNone;
}

bool Question::Take(const reports::Acknowledgement& acknowledgement) {
  acknowledged_ = acknowledges_ = true;
  if (!asked_ || !EndsWithAcknowledgement(step_) ||
      acknowledgement.report != AcknowledgedReport(step_)) {
    return false;
  }
  // 7 and 8: nothing there; the identity read next decides. Any other error means busy, and
  // the time-out asks again.
  return acknowledgement.error == 0 || acknowledgement.error >= 7;
}

bool Question::ReadAgain(stream::CalibrationOrigin origin) {
  if (origin != stream::CalibrationOrigin::kDefaults || read_again_ || !tries_left()) return false;
  read_again_ = true;
  asked_ = false;
  return true;
}

}  // namespace footing::handshake

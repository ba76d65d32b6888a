#pragma once

#include <cstdint>
#include <optional>

#include "common/stream/device.h"
#include "daemon/sensor/reports/plan.h"
#include "daemon/sensor/reports/step.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/memory_read.h"

namespace footing::handshake {

struct QuestionConfig {
  double reply_timeout_s = 0.5;  ///< A status or memory read not answered is asked again.
  double ack_timeout_s = 0.2;    ///< Some devices never acknowledge a write.
  int tries = 3;                 ///< Of each question; then the next step is taken without it.
};

/// The one question that is out: when it was asked, how often, and whether the answer is complete.
class Question {
 public:
  enum class Wait {
    kNotAsked,
    kWaiting,
    kAskAgain,  ///< Not answered in time.
    kGiveUp,    ///< Not answered by any of its tries.
  };
  enum class Reading { kNone, kDone, kRefused };

  explicit Question(const QuestionConfig& config) : config_(config) {}

  void Enter(Step step) { Enter(step, ReadOf(step)); }
  /// With the memory that the step reads.
  void Enter(Step step, std::optional<reports::MemoryRead> read);
  /// Before it is asked for the next time.
  void Pause(double seconds) { pause_s_ = seconds; }
  /// It is asked again at once.
  void Retry() { asked_ = false; }

  Step step() const { return step_; }
  bool asked() const { return asked_; }
  int tries() const { return tries_; }
  bool tries_left() const { return tries_ < config_.tries; }

  Wait Advance(std::int64_t now_ns);
  /// False during a pause.
  bool MayAsk(std::int64_t now_ns);
  void SetAsked(std::int64_t now_ns);
  /// The request of a step that reads memory, from the start.
  std::optional<reports::OutputReport> ReadRequest();

  Reading Take(const reports::MemoryData& memory);
  /// Of the memory read.
  const std::vector<std::uint8_t>& bytes() const { return read_->bytes(); }
  /// True when it answers the question.
  bool Take(const reports::Acknowledgement& acknowledgement);
  /// True when a calibration block that makes no sense is to be read once more.
  bool ReadAgain(stream::CalibrationOrigin origin);

 private:
  QuestionConfig config_;
  Step step_ = Step::kStatus;
  bool asked_ = false;
  std::int64_t asked_ns_ = 0;
  int tries_ = 0;
  double pause_s_ = 0;
  std::int64_t not_before_ns_ = 0;
  std::optional<reports::MemoryRead> read_;
  bool read_again_ = false;
  bool acknowledges_ = true;   // Until it did not.
  bool acknowledged_ = false;  // It ever did.
};

}  // namespace footing::handshake

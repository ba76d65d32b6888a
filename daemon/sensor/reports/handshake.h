#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/stream/device.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/output_report.h"

namespace footing::handshake {

/// A block of memory that is read once.
struct Block {
  reports::Space space = reports::Space::kRegisters;
  std::uint32_t address = 0;
  std::uint16_t size = 0;
};

/// Properties of one kind of device in the handshake. A remote has an accelerometer, a camera and
/// an extension port where accessories come and go; of any other kind, what answers at the port is
/// the device itself.
struct Plan {
  bool remote = false;
  std::uint8_t mode = 0;  ///< Id of the data reports; a remote's follows what is plugged in.
  /// Bytes 4 and 5 of the identity of what answers at the port: recognises the kind where its
  /// product name is missing.
  std::array<std::uint8_t, 2> identity = {};
  std::span<const Block> blocks = {};  ///< Read after the identity, in this order.
};

/// The questions of a handshake, in the order in which they are asked.
enum class Step {
  kStatus,
  kAccelerationBlocks,
  // Extension port.
  kExtensionKey,
  kExtensionPlain,
  kExtensionIdentity,
  kNunchukBlock,
  kOwnBlock,  ///< One of the plan's blocks.
  // MotionPlus: found and read while inactive, since it hides what it was plugged over.
  kMotionPlusKey,
  kMotionPlusIdentity,
  kMotionPlusBlock,
  kMotionPlusActivate,
  kMotionPlusVerify,
  // Infrared camera.
  kCameraPower,
  kCameraLogic,
  kCameraStart,
  kCameraGain,
  kCameraLimits,
  kCameraFormat,
  kCameraGo,
  kMode,
  kLive,
};

/// The memory read of a step, if it has one.
std::optional<reports::MemoryRead> ReadOf(Step step);

/// The constant report that a step sends; empty for reads, the mode, the activation and the
/// camera's format.
reports::OutputReport FixedOutput(Step step);

/// Steps that end with an acknowledgement, and go on without one.
bool EndsWithAcknowledgement(Step step);

/// Id of the report that such a step's acknowledgement names.
std::uint8_t AcknowledgedReport(Step step);

/// Timeouts of the questions of a handshake.
struct QuestionConfig {
  double reply_timeout_s = 0.5;  ///< A status or memory read not answered is asked again.
  double ack_timeout_s = 0.2;    ///< Some devices never acknowledge a write.
  int tries = 3;  ///< Tries for each question; then the next step is taken without it.
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
  /// Bytes of the memory read.
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

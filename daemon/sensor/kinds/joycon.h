#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/joycon_report.h"

/// The Switch's controllers over Bluetooth: Joy-Con (L), Joy-Con (R) and Pro Controller.
namespace footing::joycon {

/// Brings a controller to what is wanted of it, and keeps it there: one subcommand at a time, again
/// when its answer does not come. Subcommands get lost now and then, other programs write to the
/// same device (the kernel's hid-nintendo a dozen at its start, Steam at any time), and copies
/// leave some unanswered. Time is an argument.
class Handshake {
 public:
  static constexpr std::int64_t kTimeoutNs = 200'000'000;  ///< Answers take 15 to 60 ms.
  static constexpr int kTries = 5;
  static constexpr std::int64_t kSilentNs = 200'000'000;  ///< Without samples: mode set again,
  static constexpr std::int64_t kMostSilentNs = 2'000'000'000;  ///< more and more slowly.
  static constexpr std::int64_t kSensorAgainNs = 3'000'000'000;
  static constexpr std::int64_t kBlockAgainNs = 5'000'000'000;

  Handshake();

  /// Sends what is due.
  void Advance(std::int64_t now_ns, kinds::Outputs& outputs);
  void TakeReply(const reports::JoyconReply& reply);
  /// A report with samples came; `sensor_works`: they are the accelerations and rates asked for.
  void TakeSamples(std::int64_t now_ns, bool sensor_works);

  void SetLamps(std::uint8_t leds);
  /// The motor is wanted.
  void AllowRumble();

  /// Calibration is known as far as it can be, and samples have been asked for.
  bool settled() const { return settled_; }
  const calibration::JoyconCalibration& calibration() const { return calibration_; }
  std::uint64_t mode_reasserts() const { return mode_reasserts_; }
  /// It has answered nothing.
  bool mute() const { return settled_ && !answered_; }

 private:
  enum Task : std::size_t {
    kInfo,
    kFactoryMotion,
    kUserMotion,
    kFactorySticks,
    kUserSticks,
    kSensorOn,
    kMode,  // Until here it is the handshake.
    kLamps,
    kVibration,
    kTaskCount
  };
  struct State {
    int tries_left = 0;  ///< 0: not wanted, or given up.
    bool answered = false;
  };

  void Want(Task task, int tries) { states_[task].tries_left = tries; }
  void WatchStream(std::int64_t now_ns);
  reports::OutputReport ReportOf(Task task) const;
  std::vector<std::uint8_t>* BlockOf(Task task);

  std::array<State, kTaskCount> states_;
  std::optional<Task> asked_;
  std::int64_t asked_ns_ = 0;
  calibration::JoyconBlocks blocks_;
  calibration::JoyconCalibration calibration_;
  bool settled_ = false;
  bool answered_ = false;
  std::uint8_t leds_ = 0;
  bool rumble_wanted_ = false;
  std::int64_t samples_ns_ =
      0;  ///< Arrival of the newest report with samples, or when they were asked for.
  std::int64_t silent_ns_ = kSilentNs;
  std::uint64_t mode_reasserts_ = 0;
  bool sensor_works_ = true;
  std::int64_t sensor_asked_ns_ = 0;
  std::int64_t block_asked_ns_ = 0;
};

/// Samples of the reports. A plain value.
class Decoder {
 public:
  /// State of the motion sensor.
  enum class Sensor {
    kWorks,
    kOff,        ///< Zeros throughout: switched off, or a copy without one.
    kOtherMode,  ///< Something else than rates in their place: 40 02 packs an attitude there.
  };

  explicit Decoder(reports::JoyconModel model) : model_(model) {}

  /// Samples of a report that has them.
  decode::Decoded Take(const calibration::JoyconCalibration& calibration, std::int64_t received_ns,
                       const reports::JoyconReport& report);
  Sensor sensor() const { return sensor_; }

 private:
  void UpdateSensor(const reports::JoyconReport& report);
  void TakeMotion(const calibration::JoyconCalibration& calibration,
                  const reports::JoyconReport& report, decode::Decoded& decoded);
  void SetOwnTimes(std::int64_t newest_ns, decode::Decoded& decoded);
  void TakeStick(const calibration::JoyconCalibration& calibration,
                 const reports::JoyconReport& report, decode::Decoded& decoded);
  void TakeGamepad(const calibration::JoyconCalibration& calibration,
                   const reports::JoyconReport& report, decode::Decoded& decoded);

  reports::JoyconModel model_;
  reports::JoyconTimer timer_;
  std::int64_t newest_ns_ = 0;  ///< By the timer, of the report before.
  Sensor sensor_ = Sensor::kWorks;
  double jumps_ = 0;  ///< Share of impossible jumps between the newest samples' rates.
  std::optional<reports::JoyconSample> last_;
  std::uint32_t last_buttons_ = 0;
  std::optional<reports::JoyconStick> last_stick_;
  std::optional<stream::GamepadSample> last_gamepad_;
};

/// One controller.
class Joycon : public kinds::Kind {
 public:
  static bool Matches(const decode::Product& product);

  explicit Joycon(const decode::Product& product);

  stream::DeviceKind kind() const override;
  decode::Placement placement() const override;
  /// Timer bytes of real ones are up to 1 % off.
  decode::Timing timing() const override { return {0.015, 0.005, 0.08, 0.015}; }
  stream::DeviceRole own_role() const override;
  bool live() const override { return handshake_.settled(); }

  void Restart() override { decoder_ = Decoder(model_); }
  void Advance(std::int64_t now_ns, kinds::Outputs& outputs) override {
    handshake_.Advance(now_ns, outputs);
  }
  std::optional<decode::Decoded> Take(std::int64_t received_ns, reports::Bytes report,
                                      kinds::Outputs& outputs) override;

  link::Writing writing() const override;
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns,
                                                  link::Outbox& outbox) override;
  reports::OutputReport MotorOff() const override { return reports::JoyconRumbleOnly(); }
  bool has_lamps() const override { return true; }
  void SetLamps(std::uint8_t leds, kinds::Outputs& /*outputs*/) override {
    handshake_.SetLamps(leds);
  }

  void AddTo(stream::DeviceStatus& status) const override;
  std::string Note(std::int64_t now_ns) const override;

 private:
  reports::JoyconModel model_;
  Handshake handshake_;
  Decoder decoder_;
  std::uint8_t packet_ = 0;
  int battery_ = -1;  ///< 0 to 4; -1 unknown.
  bool charging_ = false;
};

}  // namespace footing::joycon

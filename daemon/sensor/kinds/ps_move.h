#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/move_calibration.h"
#include "daemon/sensor/reports/move_report.h"

namespace footing::ps_move {

/// Finds a PS Move's calibration (stored by serial, else asked for by feature reports, which some
/// kernels answer over USB only) and keeps its sphere alight. A Move needs no more: it sends its
/// data as soon as it is there. Time is an argument.
class CalibrationHandshake {
 public:
  static constexpr std::int64_t kTimeoutNs = 500'000'000;
  static constexpr int kMaxRefusals = 3;
  /// The sphere goes out unless its report is repeated, and chokes on more (psmoveapi).
  static constexpr std::int64_t kRepeatNs = 2'000'000'000;
  static constexpr std::int64_t kSpacingNs = 120'000'000;

  /// `stored`: the blob kept from an earlier time, if any.
  CalibrationHandshake(reports::MoveModel model,
                       const std::optional<std::vector<std::uint8_t>>& stored);

  /// Data may be decoded: the calibration is settled.
  bool live() const { return settled_; }
  /// The blob is to be read (again): the device appeared on another link.
  void AskAgain();
  /// True when the calibration feature report is to be asked for now.
  bool WantsFeature(std::int64_t now_ns);
  /// Its answer; empty when the device refused. True when the blob is whole and new: store it.
  bool TakeFeature(reports::Bytes feature);
  const std::vector<std::uint8_t>& blob() const { return blob_.bytes(); }

  /// The lights' report, when one is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns, bool rumble);
  void set_sphere(std::uint32_t rgb) { sphere_rgb_ = rgb & 0xffffff; }
  std::uint32_t sphere_rgb() const { return sphere_rgb_; }
  const calibration::MoveCalibration& calibration() const { return calibration_; }

 private:
  void Refuse();

  reports::MoveModel model_;
  calibration::MoveCalibration calibration_;
  calibration::MoveBlob blob_;
  bool settled_ = false;
  bool asking_ = true;
  bool asked_ = false;
  std::int64_t asked_ns_ = 0;
  int refusals_ = 0;
  int answers_ = 0;

  std::uint32_t sphere_rgb_ = 0;
  bool sent_ = false;
  std::int64_t sent_ns_ = 0;
  std::uint32_t sent_rgb_ = 0;
  bool sent_rumble_ = false;
};

/// A PS Move's input reports: a ZCM1's give two motion samples, half a report apart. A plain value.
class Decoder {
 public:
  explicit Decoder(reports::MoveModel model) : model_(model) {}

  /// None when it is not an input report of this model.
  std::optional<decode::Decoded> Take(const calibration::MoveCalibration& calibration,
                                      reports::Bytes report);

  /// 0 to 1; -1 while charging or unknown.
  double battery_fraction() const { return battery_fraction_; }

 private:
  reports::MoveModel model_;
  std::optional<reports::MoveSample> last_;
  std::uint32_t last_buttons_ = 0;
  double battery_fraction_ = -1;
};

/// A PS Move. It may be on two links at once: Bluetooth carries the samples, USB the calibration.
class PsMove : public kinds::Kind {
 public:
  static bool Matches(const decode::Product& product);

  /// `stored`: a calibration read at an earlier time, if any.
  PsMove(const decode::Product& product, const std::optional<std::vector<std::uint8_t>>& stored);

  stream::DeviceKind kind() const override { return stream::DeviceKind::kPsMove; }
  decode::Placement placement() const override { return decode::Placement::kOnBody; }
  decode::Timing timing() const override { return {1 / 88.0, 1 / 88.0}; }  // psmoveapi.
  bool live() const override { return handshake_.live(); }

  std::optional<decode::Decoded> Take(std::int64_t received_ns, reports::Bytes report,
                                      kinds::Outputs& outputs) override;
  /// The report of lights and motor, when it is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns,
                                                  link::Outbox& outbox) override {
    return handshake_.NextOutput(now_ns, outbox.rumble());
  }
  reports::OutputReport MotorOff() const override { return reports::MoveLights(0, 0); }

  bool has_second_link() const override { return true; }
  /// Its calibration may be readable there.
  void OnSecondLink() override { handshake_.AskAgain(); }
  std::optional<decode::FeatureRequest> NextFeature(std::int64_t now_ns) override;
  kinds::Stored TakeFeature(reports::Bytes feature) override;

  bool SetSphere(std::uint32_t rgb) override;
  void AddTo(stream::DeviceStatus& status) const override;
  std::string Note(std::int64_t /*now_ns*/) const override {
    return handshake_.calibration().problem;
  }

 private:
  CalibrationHandshake handshake_;
  Decoder decoder_;
};

}  // namespace footing::ps_move

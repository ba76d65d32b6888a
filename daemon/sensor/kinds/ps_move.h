#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind_options.h"
#include "daemon/sensor/kinds/calibration_handshake.h"
#include "daemon/sensor/kinds/ps_move_decoder.h"

namespace footing::ps_move {

/// A PS Move. It may be on two links at once: Bluetooth carries the samples, USB the calibration.
class PsMove {
 public:
  static constexpr stream::DeviceKind kKind = stream::DeviceKind::kPsMove;
  static constexpr decode::Placement kPlacement = decode::Placement::kOnBody;
  static constexpr decode::Timing kTiming = {1 / 88.0, 1 / 88.0};  // psmoveapi.
  static constexpr bool kHasSecondLink = true;

  static bool Matches(const decode::Product& product);

  /// `stored`: a calibration read at an earlier time, if any.
  PsMove(const decode::Product& product, const std::optional<std::vector<std::uint8_t>>& stored);

  bool live() const { return handshake_.live(); }
  /// None when the report is not one of this model's.
  std::optional<decode::Decoded> Take(reports::Bytes report);
  /// The report of lights and motor, when it is due.
  std::optional<reports::OutputReport> NextOutput(std::int64_t now_ns, bool rumble) {
    return handshake_.NextOutput(now_ns, rumble);
  }
  static reports::OutputReport MotorOff() { return reports::MoveLights(0, 0); }

  /// It appeared on a second link, where its calibration may be readable.
  void TakeSecondLink() { handshake_.AskAgain(); }
  std::optional<decode::FeatureRequest> NextFeature(std::int64_t now_ns);
  /// The whole calibration, when this piece completed one to be stored.
  std::optional<std::vector<std::uint8_t>> TakeFeature(reports::Bytes feature);

  void SetSphere(std::uint32_t rgb) { handshake_.set_sphere(rgb); }
  void AddTo(stream::DeviceStatus& status) const;
  std::string Note() const { return handshake_.calibration().problem; }

 private:
  CalibrationHandshake handshake_;
  Decoder decoder_;
};

}  // namespace footing::ps_move

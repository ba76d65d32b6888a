#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/sensor/reports/move.h"
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

}  // namespace footing::ps_move

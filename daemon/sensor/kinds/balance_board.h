#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/base/units.h"
#include "common/board/geometry.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/wiimote_protocol.h"
#include "daemon/sensor/reports/board_calibration.h"
#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/sequencer.h"

namespace footing::balance_board {

/// A Balance Board's extension bytes to forces; watches for sensors that can't be right. A plain
/// value.
class Decoder {
 public:
  /// Rated loads of one cell and of the whole board, kg. More is passed on and reported.
  static constexpr double kCellRangeKg = 34;
  static constexpr double kTotalRangeKg = 150;
  /// A corner that stays on one count while the others change this often is stuck.
  static constexpr int kStuckChanges = 500;

  explicit Decoder(double local_gravity_mps2 = kStandardGravityMps2)
      : local_gravity_mps2_(local_gravity_mps2) {}

  /// None for reports that are too short for four corners.
  std::optional<decode::Decoded> Take(const calibration::BoardCalibration& calibration,
                                      reports::Bytes extension);

  /// 0 to 1 from byte 10; -1 until a report had it.
  double battery_fraction() const { return battery_fraction_; }
  bool battery_low() const { return battery_low_; }
  /// Which sensor is stuck or over its range in the newest report; empty when none.
  std::string Note() const;

 private:
  void Watch(const reports::BoardCounts& counts);

  double local_gravity_mps2_;
  bool started_ = false;
  std::array<std::uint16_t, reports::kCorners> last_{};
  std::array<int, reports::kCorners> still_{};  // Changes of other corners since this one changed.
  bool over_range_ = false;
  double battery_fraction_ = -1;
  bool battery_low_ = false;
};

/// A Balance Board. It has the Wiimote's product id: its name or what answers at its port says what
/// it is.
class BalanceBoard : public kinds::Speaker {
 public:
  static constexpr handshake::Block kBlocks[] = {
      {reports::Space::kRegisters, calibration::kBoardBlockAddress, calibration::kBoardBlockBytes},
      {reports::Space::kRegisters, calibration::kBoardTemperatureAddress,
       calibration::kBoardTemperatureBytes}};
  static constexpr handshake::Plan kPlan = {false, 0x34, {0x04, 0x02}, kBlocks};

  static bool Matches(const decode::Product& product) {
    return product.name.find("RVL-WBC") != std::string::npos;
  }

  explicit BalanceBoard(const decode::KindOptions& options)
      : local_gravity_mps2_(options.local_gravity_mps2), decoder_(local_gravity_mps2_) {}

  stream::DeviceKind kind() const override { return stream::DeviceKind::kBalanceBoard; }
  decode::Placement placement() const override { return decode::Placement::kUnderFeet; }
  /// As recorded on a good link.
  decode::Timing timing() const override { return {1 / 83.6, 1 / 60.0}; }

  void Restart() override { decoder_ = Decoder(local_gravity_mps2_); }
  void TakeBlocks(const handshake::HandshakeSequencer& sequencer) override;
  decode::Decoded Take(const handshake::HandshakeSequencer& sequencer,
                       const reports::InputReport& report) override;
  void AddTo(const handshake::HandshakeSequencer& sequencer,
             stream::DeviceStatus& status) const override;
  std::string Note() const override;

 private:
  double local_gravity_mps2_;
  bool has_blocks_ = false;
  calibration::BoardCalibration calibration_ = calibration::DefaultBoard();
  Decoder decoder_;
};

}  // namespace footing::balance_board

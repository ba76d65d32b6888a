#pragma once

#include <optional>
#include <string>

#include "daemon/sensor/reports/board.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/kinds/kind_options.h"
#include "daemon/sensor/reports/sequencer.h"
#include "daemon/sensor/kinds/balance_board_decoder.h"

namespace footing::balance_board {

/// A Balance Board. It has the Wiimote's product id: its name or what answers at its port says what
/// it is.
class BalanceBoard {
 public:
  static constexpr stream::DeviceKind kKind = stream::DeviceKind::kBalanceBoard;
  static constexpr decode::Placement kPlacement = decode::Placement::kUnderFeet;
  /// As recorded on a good link.
  static constexpr decode::Timing kTiming = {1 / 83.6, 1 / 60.0};
  static constexpr handshake::Block kBlocks[] = {
      {reports::Space::kRegisters, calibration::kBoardBlockAddress, calibration::kBoardBlockBytes},
      {reports::Space::kRegisters, calibration::kBoardTemperatureAddress,
       calibration::kBoardTemperatureBytes}};
  static constexpr handshake::Plan kPlan = {false, 0x34, {0x04, 0x02}, kBlocks};

  static bool Matches(const decode::Product& product) {
    return product.name.find("RVL-WBC") != std::string::npos;
  }

  BalanceBoard(const decode::KindOptions& options, handshake::HandshakeSequencer sequencer)
      : sequencer_(std::move(sequencer)),
        local_gravity_mps2_(options.local_gravity_mps2),
        decoder_(local_gravity_mps2_) {}

  handshake::HandshakeSequencer& sequencer() { return sequencer_; }
  const handshake::HandshakeSequencer& sequencer() const { return sequencer_; }
  /// A new uninterrupted stream begins.
  void Restart() { decoder_ = Decoder(local_gravity_mps2_); }
  decode::Decoded Take(const reports::InputReport& report);
  /// The sequencer advanced: the calibration blocks may be there now.
  void TakeBlocks();
  const calibration::BoardCalibration& calibration() const { return calibration_; }

  void AddTo(stream::DeviceStatus& status) const;
  std::string Note() const;

 private:
  handshake::HandshakeSequencer sequencer_;
  double local_gravity_mps2_;
  bool has_blocks_ = false;
  calibration::BoardCalibration calibration_ = calibration::DefaultBoard();
  Decoder decoder_;
};

}  // namespace footing::balance_board

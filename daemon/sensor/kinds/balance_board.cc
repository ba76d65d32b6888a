#include "daemon/sensor/kinds/balance_board.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::balance_board {
namespace {

constexpr const char* kCornerNames[] = {"top right", "bottom right", "top left", "bottom left"};
/// The first of four bars; under it the board falls silent soon.
constexpr std::uint8_t kLowBattery = 0x6a;

}  // namespace

std::optional<decode::Decoded> Decoder::Take(const calibration::BoardCalibration& calibration,
                                             reports::Bytes extension) {
  const auto counts = reports::DecodeBoard(extension);
  if (!counts) return std::nullopt;
  const auto corners = calibration::CornerForces(calibration, *counts, local_gravity_mps2_);
  decode::Decoded decoded;
  decode::BoardReading& reading = decoded.board.emplace();
  reading.forces = {corners[reports::kTopLeft], corners[reports::kTopRight],
                    corners[reports::kBottomLeft], corners[reports::kBottomRight]};
  reading.uncalibrated = calibration.origin == stream::CalibrationOrigin::kDefaults;
  decoded.changed = !started_ || counts->corners != last_;
  Watch(*counts);
  double total_n = 0;
  bool cell_over = false;
  for (const double corner_n : corners) {
    total_n += corner_n;
    cell_over = cell_over || corner_n > KilogramsToNewtons(kCellRangeKg);
  }
  over_range_ = cell_over || total_n > KilogramsToNewtons(kTotalRangeKg);
  if (counts->has_battery) {
    battery_fraction_ = reports::BoardBatteryFraction(counts->battery);
    battery_low_ = counts->battery < kLowBattery;
  }
  return decoded;
}

void Decoder::Watch(const reports::BoardCounts& counts) {
  if (started_ && counts.corners != last_) {
    for (std::size_t i = 0; i < reports::kCorners; ++i) {
      still_[i] = counts.corners[i] == last_[i] ? std::min(still_[i] + 1, kStuckChanges) : 0;
    }
  }
  started_ = true;
  last_ = counts.corners;
}

std::string Decoder::Note() const {
  for (std::size_t i = 0; i < reports::kCorners; ++i) {
    if (still_[i] < kStuckChanges) continue;
    return std::string("the ") + kCornerNames[i] +
           " sensor never changes: it is stuck or broken; do not trust this board";
  }
  if (over_range_) {
    return "load over its range (34 kg a corner, 150 kg in all): forces are less exact";
  }
  return "";
}

void BalanceBoard::TakeBlocks(const handshake::HandshakeSequencer& sequencer) {
  const auto& blocks = sequencer.blocks();
  if (has_blocks_ || blocks.size() < std::size(kBlocks)) return;
  has_blocks_ = true;
  calibration_ = calibration::ParseBoard(blocks[0], blocks[1]);
}

decode::Decoded BalanceBoard::Take(const handshake::HandshakeSequencer&,
                                   const reports::InputReport& report) {
  const auto* data = std::get_if<reports::Data>(&report.body);
  if (data == nullptr) return {};
  return decoder_.Take(calibration_, data->extension()).value_or(decode::Decoded());
}

void BalanceBoard::AddTo(const handshake::HandshakeSequencer& sequencer,
                         stream::DeviceStatus& status) const {
  if (sequencer.live()) status.calibration = calibration_.origin;
  // A board's status report says nothing about its battery.
  status.battery_fraction = decoder_.battery_fraction();
  status.battery_low = decoder_.battery_low();
}

std::string BalanceBoard::Note() const {
  return calibration_.problem.empty() ? decoder_.Note() : calibration_.problem;
}

}  // namespace footing::balance_board

#include "daemon/sensor/kinds/balance_board.h"

namespace footing::balance_board {

void BalanceBoard::TakeBlocks() {
  const auto& blocks = sequencer_.blocks();
  if (has_blocks_ || blocks.size() < std::size(kBlocks)) return;
  has_blocks_ = true;
  calibration_ = calibration::ParseBoard(blocks[0], blocks[1]);
}

decode::Decoded BalanceBoard::Take(const reports::InputReport& report) {
  const auto* data = std::get_if<reports::Data>(&report.body);
  if (data == nullptr) return {};
  return decoder_.Take(calibration_, data->extension()).value_or(decode::Decoded());
}

void BalanceBoard::AddTo(stream::DeviceStatus& status) const {
  if (sequencer_.live()) status.calibration = calibration_.origin;
  // A board's status report says nothing about its battery.
  status.battery_fraction = decoder_.battery_fraction();
  status.battery_low = decoder_.battery_low();
}

std::string BalanceBoard::Note() const {
  return calibration_.problem.empty() ? decoder_.Note() : calibration_.problem;
}

}  // namespace footing::balance_board

#include "tests/vm/made_device.h"

#include "common/device_models/balance_board.h"
#include "common/device_models/wiimote.h"
#include "common/units/units.h"
#include "tests/vm/ramp.h"

namespace footing::vm {
namespace {

MadeDevice::Reports List(std::optional<device_models::Report> report) {
  if (!report) return {};
  return {*std::move(report)};
}

class MadeWiimote : public MadeDevice {
 public:
  explicit MadeWiimote(std::uint64_t seed) : wiimote_(seed) {}
  const device_models::Identity& identity() const override { return wiimote_.identity(); }
  Reports HandleOutput(std::int64_t, std::span<const std::uint8_t> report) override {
    return wiimote_.HandleOutput(report);
  }
  Reports Sample(std::int64_t, std::uint64_t sample) override {
    return List(wiimote_.Sample({kForceRampMps2.At(sample), 0, -kStandardGravityMps2}));
  }
  Reports Status() override { return {wiimote_.controller().UnaskedStatus()}; }

 private:
  device_models::Wiimote wiimote_;
};

class MadeBoard : public MadeDevice {
 public:
  explicit MadeBoard(std::uint64_t seed) : board_(seed) {}
  const device_models::Identity& identity() const override { return board_.identity(); }
  Reports HandleOutput(std::int64_t, std::span<const std::uint8_t> report) override {
    return board_.HandleOutput(report);
  }
  Reports Sample(std::int64_t, std::uint64_t sample) override {
    return List(board_.Sample({kCornerRampN.At(sample), 150, 160, 170}));
  }
  Reports Status() override { return {board_.controller().UnaskedStatus()}; }

 private:
  device_models::BalanceBoard board_;
};

}  // namespace

std::unique_ptr<MadeDevice> MakeDevice(const std::string& kind, std::uint64_t seed) {
  if (kind == "wiimote") return std::make_unique<MadeWiimote>(seed);
  if (kind == "board") return std::make_unique<MadeBoard>(seed);
  return nullptr;
}

}  // namespace footing::vm

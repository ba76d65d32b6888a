#include "tests/vm/made_device.h"

#include "common/base/units.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/wiimote.h"
#include "tests/vm/ramp.h"
#include "tests/vm/report_descriptor.h"

namespace footing::vm {
namespace {

using virtual_devices::MoveModel;

constexpr std::size_t kMoveFeatureBytes = 49;

MadeDevice::Reports List(std::optional<virtual_devices::Report> report) {
  if (!report) return {};
  return {*std::move(report)};
}

class MadeWiimote : public MadeDevice {
 public:
  MadeWiimote(std::uint64_t seed, bool plus)
      : wiimote_(seed, {.tr = plus, .motion_plus_inside = plus}) {
    if (plus) wiimote_.Plug(virtual_devices::Accessory::kNunchuk, 0);
    sensors_.angular_velocity_S_radps = {0.5, -0.4, 0.3};
    sensors_.nunchuk.stick_x = 0.5;
  }
  const virtual_devices::Identity& identity() const override { return wiimote_.identity(); }
  Reports HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report) override {
    return wiimote_.HandleOutput(now_ns, report);
  }
  Reports Sample(std::int64_t now_ns, std::uint64_t sample) override {
    sensors_.specific_force_S_mps2.x() = kForceRampMps2.At(sample);
    return wiimote_.Sample(now_ns, sensors_);
  }
  Reports Status() override { return {wiimote_.controller().UnaskedStatus()}; }
  std::span<const std::uint8_t> descriptor() const override { return kReportDescriptor; }

 private:
  virtual_devices::Wiimote wiimote_;
  virtual_devices::WiimoteSensors sensors_;
};

class MadeBoard : public MadeDevice {
 public:
  explicit MadeBoard(std::uint64_t seed) : board_(seed) {}
  const virtual_devices::Identity& identity() const override { return board_.identity(); }
  Reports HandleOutput(std::int64_t, std::span<const std::uint8_t> report) override {
    return board_.HandleOutput(report);
  }
  Reports Sample(std::int64_t, std::uint64_t sample) override {
    return List(board_.Sample({kCornerRampN.At(sample), 150, 160, 170}));
  }
  Reports Status() override { return {board_.controller().UnaskedStatus()}; }
  std::span<const std::uint8_t> descriptor() const override { return kReportDescriptor; }

 private:
  virtual_devices::BalanceBoard board_;
};

class MadeMove : public MadeDevice {
 public:
  MadeMove(std::uint64_t seed, MoveModel model)
      : move_(seed, model), samples_a_report_(model == MoveModel::kZcm1 ? 2 : 1) {}
  const virtual_devices::Identity& identity() const override { return move_.identity(); }
  Reports HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report) override {
    return move_.HandleOutput(now_ns, report);
  }
  Reports Sample(std::int64_t now_ns, std::uint64_t sample) override {
    virtual_devices::MoveSensors sensors;
    sensors.specific_force_S_mps2.x() = kMoveRampMps2.At(samples_a_report_ * sample);
    return move_.Sample(now_ns, sensors);
  }
  std::optional<virtual_devices::Report> Feature(std::uint8_t id) override {
    return move_.Feature(id, kMoveFeatureBytes);
  }
  std::span<const std::uint8_t> descriptor() const override {
    if (samples_a_report_ == 2) return kZcm1Descriptor;
    return kZcm2Descriptor;
  }

 private:
  virtual_devices::PsMove move_;
  std::uint64_t samples_a_report_;
};

class MadeJoycon : public MadeDevice {
 public:
  explicit MadeJoycon(std::uint64_t seed) : joycon_(seed, virtual_devices::JoyconModel::kLeft) {}
  const virtual_devices::Identity& identity() const override { return joycon_.identity(); }
  Reports HandleOutput(std::int64_t now_ns, std::span<const std::uint8_t> report) override {
    return joycon_.HandleOutput(now_ns, report);
  }
  Reports Sample(std::int64_t now_ns, std::uint64_t sample) override {
    virtual_devices::JoyconBurst burst;
    for (std::size_t i = 0; i < burst.size(); ++i) {
      burst[i].specific_force_S_mps2.x() = kForceRampMps2.At(burst.size() * sample + i);
    }
    return joycon_.Sample(now_ns, burst);
  }
  std::int64_t period_ns() const override { return 15'000'000; }
  std::span<const std::uint8_t> descriptor() const override { return kJoyconDescriptor; }

 private:
  virtual_devices::Joycon joycon_;
};

}  // namespace

std::vector<std::string> Kinds() {
  return {"wiimote", "wiimote_plus", "board", "move_zcm1", "move_zcm2", "joycon"};
}

std::unique_ptr<MadeDevice> MakeDevice(const std::string& kind, std::uint64_t seed) {
  if (kind == "wiimote") return std::make_unique<MadeWiimote>(seed, false);
  if (kind == "wiimote_plus") return std::make_unique<MadeWiimote>(seed, true);
  if (kind == "board") return std::make_unique<MadeBoard>(seed);
  if (kind == "move_zcm1") return std::make_unique<MadeMove>(seed, MoveModel::kZcm1);
  if (kind == "move_zcm2") return std::make_unique<MadeMove>(seed, MoveModel::kZcm2);
  if (kind == "joycon") return std::make_unique<MadeJoycon>(seed);
  return nullptr;
}

}  // namespace footing::vm

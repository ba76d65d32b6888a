#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/device_faults/fault.h"
#include "tests/device_faults/move_model.h"

namespace footing::device_faults {
namespace {

using virtual_devices::MoveModel;

void SetFloat(std::vector<std::uint8_t>& blob, std::size_t at, float value) {
  std::memcpy(&blob.at(at), &value, sizeof(value));
}

class MoveFault : public Fault {
 protected:
  /// At rest and turning as the model is.
  void ExpectTrue(const Device& device, std::size_t at_least, double tolerance) {
    EXPECT_GE(Motion(device).size(), at_least);
    for (const auto& sample : Motion(device)) {
      ASSERT_NEAR(sample.specific_force_mps2().x(), 0, 9.8 * tolerance);
      ASSERT_NEAR(sample.specific_force_mps2().y(), 0, 9.8 * tolerance);
      ASSERT_NEAR(sample.specific_force_mps2().z(), -9.80665, 9.8 * tolerance);
      ASSERT_TRUE(sample.has_angular_velocity_radps());
      ASSERT_NEAR(sample.angular_velocity_radps().z(), 3, 3 * tolerance);
    }
  }
  static std::shared_ptr<MoveOnLink> Turning(std::uint64_t seed,
                                             MoveModel model = MoveModel::kZcm1) {
    auto move = std::make_shared<MoveOnLink>(seed, model);
    move->sensors.angular_velocity_S_radps = {0, 0, 3};
    return move;
  }
  /// The one file of a stored calibration.
  std::filesystem::path Stored() {
    std::filesystem::path found;
    const std::filesystem::path folder = bench.folder() + "/state/footing";
    if (!std::filesystem::exists(folder)) return found;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
      const std::string name = file.path().filename();
      if (name.starts_with("calibration") && name.ends_with(".json")) found = file.path();
    }
    return found;
  }
};

#define FOOTING_MOVE_FAULT(name)    \
  class name : public MoveFault {}; \
  TEST_F(name, IsSurvived)

FOOTING_MOVE_FAULT(Fault25MoveCalibrationsWithoutSense) {
  // The gyroscope's factors, floats at 6a of a ZCM1: NaN and infinite.
  auto factors = Turning(25);
  SetFloat(factors->move->blob(), 0x6a, std::numeric_limits<float>::quiet_NaN());
  SetFloat(factors->move->blob(), 0x6e, std::numeric_limits<float>::infinity());
  SetFloat(factors->move->blob(), 0x72, -std::numeric_limits<float>::infinity());
  // Every span is zero: 1 g below and above, and each turn, are the same count.
  auto spans = Turning(2501), spans2 = Turning(2502, MoveModel::kZcm2);
  for (auto* blob : {&spans->move->blob(), &spans2->move->blob()}) {
    for (std::size_t at = 2; at < blob->size(); ++at) (*blob)[at] = at % 2 == 0 ? 0x00 : 0x80;
  }
  auto ones = Turning(2503), missing = Turning(2504);
  std::fill(ones->move->blob().begin() + 2, ones->move->blob().end(), 0xff);
  missing->calibration_readable = false;
  Device& good = bench.Plug(factors);
  Device* bad[] = {&bench.Plug(spans), &bench.Plug(spans2), &bench.Plug(ones),
                   &bench.Plug(missing)};
  ASSERT_TRUE(bench.Start());
  // Without the factors the rest of the blob is right.
  ASSERT_TRUE(bench.UntilLive(good));
  ASSERT_TRUE(bench.UntilSamples(good, 40));
  EXPECT_EQ(Status(good).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  ExpectTrue(good, 40, 0.02);
  for (Device* device : bad) {
    ASSERT_TRUE(bench.UntilLive(*device));
    ASSERT_TRUE(bench.UntilSamples(*device, 40));
    EXPECT_EQ(Status(*device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
    EXPECT_FALSE(Status(*device).note().empty());
    ExpectTrue(*device, 40, 0.35);  // By typical values.
    for (const auto& sample : Motion(*device)) {
      EXPECT_TRUE(sample.uncalibrated());
      EXPECT_TRUE(sample.gyroscope_uncalibrated());
    }
  }
  EXPECT_NE(Status(*bad[3]).note().find("USB"), std::string::npos);
  EXPECT_TRUE(Stored().empty() || Stored().string().find(good.serial().substr(15)) !=
                                      std::string::npos);  // Only sense is kept.
}

FOOTING_MOVE_FAULT(Fault26StoredCalibrationDamagedOrOfAnother) {
  auto model = Turning(26);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  ASSERT_TRUE(bench.Until([&] { return !Stored().empty(); }));
  const std::filesystem::path file = Stored();
  const auto restart = [&] {
    EXPECT_EQ(bench.Stop(), 0);
    bench.seen().Forget();
    EXPECT_TRUE(bench.Restart());
    EXPECT_TRUE(bench.UntilLive(device));
    EXPECT_TRUE(bench.UntilSamples(device, 40));
  };
  // From here on it cannot be read from the device, as over Bluetooth on some kernels.
  model->calibration_readable = false;
  restart();
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_STORED);
  ExpectTrue(device, 40, 0.02);
  std::ifstream whole_file(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(whole_file), {}};
  std::string of_another = whole, flipped = whole;
  for (std::size_t at = of_another.find(device.serial()); at != std::string::npos;
       at = of_another.find(device.serial(), at)) {
    of_another.replace(at, device.serial().size(), "52:00:00:00:00:01");
  }
  ASSERT_NE(of_another, whole);
  const std::size_t hex = whole.find("\"hex\"");
  ASSERT_NE(hex, std::string::npos);
  flipped[hex + 60] = flipped[hex + 60] == '7' ? '8' : '7';
  const std::string damaged[] = {whole.substr(0, whole.size() / 2), "", of_another, flipped};
  for (const std::string& content : damaged) {
    std::filesystem::remove(file.string() + ".damaged");
    std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
    const std::size_t said = bench.LogLines("is not used");
    restart();
    EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS) << content;
    EXPECT_EQ(bench.LogLines("is not used"), said + 1) << content;
    EXPECT_FALSE(Status(device).note().empty());
    ExpectTrue(device, 40, 0.35);
    for (const auto& sample : Motion(device)) EXPECT_TRUE(sample.uncalibrated());
  }
  // Read once more, all is well again.
  model->calibration_readable = true;
  restart();
  EXPECT_EQ(Status(device).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
  EXPECT_EQ(Stored(), file);
  ExpectTrue(device, 40, 0.02);
}

FOOTING_MOVE_FAULT(Fault40OneMoveOnUsbAndBluetooth) {
  auto radio = Turning(40);
  radio->calibration_readable = false;
  Device& first = bench.Plug(radio);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(first));
  EXPECT_EQ(Status(first).calibration(), v1::CALIBRATION_ORIGIN_DEFAULTS);
  // On the cable it is the same one, and its calibration can be read. It sends there too.
  auto cable = std::make_shared<MoveOnLink>(
      std::make_shared<virtual_devices::PsMove>(40, MoveModel::kZcm1), true);  // Two views of one.
  cable->sensors = radio->sensors;
  cable->sensors.angular_velocity_S_radps = {0, 0, -5};  // Not to be heard.
  Device* second = &bench.Plug(cable);
  ASSERT_TRUE(
      bench.Until([&] { return Status(first).calibration() == v1::CALIBRATION_ORIGIN_DEVICE; }));
  EXPECT_GE(cable->calibration_asked, 3);
  bench.Run(0.1);
  bench.seen().Forget();
  std::size_t sent = 0;
  first.outgoing = [&sent](const Report& report) {
    ++sent;
    return std::vector<Report>{report};
  };
  bench.Run(1);
  EXPECT_EQ(bench.seen().devices(), 1u);
  EXPECT_EQ(bench.LogLines("attached as device"), 1u);
  // The radio's samples alone: two a report; what is on its way is some ticks' worth.
  EXPECT_GT(sent, 40u);
  ExpectTrue(first, 2 * sent - 20, 0.02);
  EXPECT_LE(Motion(first).size(), 2 * sent + 20);
  // Unplugged from the cable it goes on; then it is gone.
  bench.Unplug(*second);
  bench.Run(0.2);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(first, 40));
  EXPECT_EQ(Status(first).state(), v1::DEVICE_STATE_LIVE);
  ExpectTrue(first, 40, 0.02);
  const std::string serial = first.serial();
  bench.Unplug(first);
  ASSERT_TRUE(bench.UntilState(serial, v1::DEVICE_STATE_LOST));
  // The other way round: first the cable, then the radio.
  bench.Plug(cable);
  ASSERT_TRUE(bench.UntilState(serial, v1::DEVICE_STATE_LIVE));
  Device& radio_again = bench.Plug(radio);
  ASSERT_TRUE(bench.Until([&] { return bench.LogLines("is on a second link") >= 2; }));
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(radio_again, 40));
  ExpectTrue(radio_again, 40, 0.02);
  EXPECT_EQ(bench.seen().devices(), 1u);
  EXPECT_EQ(Status(radio_again).calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
}

}  // namespace
}  // namespace footing::device_faults

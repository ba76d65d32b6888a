#include "clients/stream/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "common/base/units.h"
#include "common/recording/recorded_session.h"
#include "common/virtual/devices/joycon.h"
#include "tests/clients/stream/virtual_line.h"
#include "tests/common/made_recording.h"
#include "tests/common/temporary_folder.h"

namespace footing::stream_client {
namespace {

/// A Wiimote that is swung, a board that is leant on, a PS Move that turns.
std::vector<SimulatedDevice> MakeDevices() {
  std::vector<SimulatedDevice> devices;
  devices.emplace_back(
      virtual_devices::Wiimote(4),
      [](double t_s) {
        virtual_devices::WiimoteSensors felt;
        felt.specific_force_S_mps2.x() = 8 * std::sin(2 * std::numbers::pi * 1.5 * t_s);
        return felt;
      },
      stream::DeviceRole::kLeftHand,
      virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, 2));
  devices.emplace_back(
      virtual_devices::BalanceBoard(7),
      [](double t_s) {
        const double shift_n = 40 * std::sin(2 * std::numbers::pi * 0.4 * t_s);
        return virtual_devices::CornerForces{150 + shift_n, 150 - shift_n, 160, 170};
      },
      stream::DeviceRole::kLeftBoard,
      virtual_devices::BoardLink(virtual_devices::LinkQuality::kGood, 3));
  devices.emplace_back(
      virtual_devices::PsMove(9, virtual_devices::MoveModel::kZcm1),
      [](double t_s) {
        virtual_devices::MoveSensors felt;
        felt.angular_velocity_S_radps.z() = std::sin(3 * t_s);
        felt.specific_force_S_mps2.y() = 6 * std::sin(2 * std::numbers::pi * 1.2 * t_s);
        return felt;
      },
      stream::DeviceRole::kRightHand,
      virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, 5));
  return devices;
}

void Write(const std::string& path, const std::vector<v1::Tick>& ticks, bool with_identity) {
  test::MadeRecording recording(path);
  recording.Begin("footingd");
  for (v1::Tick tick : ticks) {
    for (v1::DeviceStatus& status : *tick.mutable_status()->mutable_devices()) {
      if (with_identity) break;
      status.clear_bus();
      status.clear_vendor();
      status.clear_product();
    }
    for (v1::RawReport& raw : *tick.mutable_raw()->mutable_reports()) {
      if (!with_identity) raw.clear_feature();
    }
    recording.Add(tick);
  }
}

/// Every measured value with when it was received, by serial.
struct Measured {
  std::map<std::string, std::map<std::int64_t, std::vector<double>>> samples;
  std::map<std::string, v1::DeviceStatus> status;
  v1::FeatureFrame last_features;
};

Measured Measure(const std::vector<v1::Tick>& ticks) {
  Measured measured;
  std::map<std::uint32_t, std::string> serials;
  for (const v1::Tick& tick : ticks) {
    for (const auto& status : tick.status().devices()) {
      serials[status.device()] = status.serial();
      measured.status[status.serial()] = status;
    }
  }
  for (const v1::Tick& tick : ticks) {
    for (const auto& one : tick.motion().samples()) {
      measured.samples[serials[one.device()]][one.received_ns()] = {
          one.specific_force_mps2().x(), one.specific_force_mps2().y(),
          one.specific_force_mps2().z(), one.magnetic_field().x()};
    }
    for (const auto& one : tick.boards().samples()) {
      measured.samples[serials[one.device()]][one.received_ns()] = {
          one.top_left_n(), one.top_right_n(), one.bottom_left_n(), one.bottom_right_n()};
    }
    if (tick.features().rigs_size() > 0) measured.last_features = tick.features();
  }
  return measured;
}

void ExpectSame(const Measured& before, const Measured& after) {
  ASSERT_EQ(before.samples.size(), 3u);
  for (const auto& [serial, samples] : before.samples) {
    ASSERT_EQ(after.samples.count(serial), 1u) << serial;
    const auto& again = after.samples.at(serial);
    std::size_t compared = 0;
    for (const auto& [received_ns, values] : samples) {
      if (received_ns < kStartNs + SecondsToNanoseconds(1.5)) continue;  // While it is set up.
      const auto found = again.lower_bound(received_ns - 1000);
      ASSERT_TRUE(found != again.end() && found->first < received_ns + 1000)
          << serial << " at " << received_ns;
      EXPECT_EQ(found->second, values) << serial;
      ++compared;
    }
    EXPECT_GT(compared, 300u) << serial;
    const v1::DeviceStatus &a = before.status.at(serial), &b = after.status.at(serial);
    EXPECT_EQ(a.kind(), b.kind());
    EXPECT_EQ(a.role(), b.role());
    EXPECT_EQ(a.calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
    EXPECT_EQ(b.calibration(), v1::CALIBRATION_ORIGIN_DEVICE);
    EXPECT_EQ(a.product(), b.product());
  }
  const auto &a = before.last_features.rigs(0), &b = after.last_features.rigs(0);
  ASSERT_EQ(a.devices_size(), 2);
  ASSERT_EQ(b.devices_size(), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(a.devices(i).frequency_valid());
    EXPECT_EQ(a.devices(i).frequency_valid(), b.devices(i).frequency_valid());
    EXPECT_NEAR(a.devices(i).frequency_hz(), b.devices(i).frequency_hz(), 1e-6);
    EXPECT_NEAR(a.devices(i).amplitude_mps2(), b.devices(i).amplitude_mps2(), 1e-6);
    EXPECT_NEAR(a.devices(i).roll_rad(), b.devices(i).roll_rad(), 1e-3);
  }
}

class Replay : public testing::Test {
 protected:
  std::vector<v1::Tick> original_ = VirtualLine(MakeDevices()).Run(8);
  test::TemporaryFolder folder_;
  std::string path_ = folder_.Path("a.mcap");
};

TEST_F(Replay, EveryKindOfDeviceMeasuresTheSameAgain) {
  Write(path_, original_, true);
  auto plan = PlanReplay(path_, {});
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  ASSERT_EQ(plan->devices.size(), 3u);
  EXPECT_NEAR(plan->duration_s, 8, 0.3);
  ExpectSame(Measure(original_), Measure(VirtualLine(std::move(plan->devices)).Run(8)));
}

TEST_F(Replay, ARecordingWithoutIdentitiesReplaysByTheKindsOfItsDevices) {
  Write(path_, original_, false);
  auto plan = PlanReplay(path_, {});
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  ExpectSame(Measure(original_), Measure(VirtualLine(std::move(plan->devices)).Run(8)));
}

TEST_F(Replay, ADeviceThatComesLaterAndIsLostAttachesAndDetachesThen) {
  std::vector<v1::Tick> ticks;
  for (const v1::Tick& tick : original_) {
    v1::Tick one = tick;
    auto& reports = *one.mutable_raw()->mutable_reports();
    const double time_s = NanosecondsToSeconds(one.host_ns() - kStartNs);
    // Only reports between 2 s and 5 s remain of device 1.
    for (int i = reports.size(); i-- > 0;) {
      if (reports[i].device() == 1 && (time_s < 2 || time_s > 5)) reports.DeleteSubrange(i, 1);
    }
    for (v1::DeviceStatus& status : *one.mutable_status()->mutable_devices()) {
      if (status.device() == 1 && time_s > 5) status.set_state(v1::DEVICE_STATE_LOST);
    }
    ticks.push_back(one);
  }
  Write(path_, ticks, true);
  const auto plan = PlanReplay(path_, {});
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  for (const SimulatedDevice& device : plan->devices) {
    const bool wiimote = device.identity().name == "Nintendo RVL-CNT-01";
    EXPECT_NEAR(device.attaches_s(), wiimote ? 2 : 0, 0.1);
    EXPECT_NEAR(wiimote ? device.detaches_s() : 5, 5, 0.1);
    EXPECT_EQ(std::isinf(device.detaches_s()), !wiimote);
  }
}

TEST_F(Replay, WithoutRawReportsItIsRefused) {
  std::vector<v1::Tick> ticks = original_;
  for (v1::Tick& tick : ticks) tick.clear_raw();
  Write(path_, ticks, true);
  const auto plan = PlanReplay(path_, {});
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.error().kind, ErrorKind::kInvalidData);
}

TEST(RecordedDevice, AReadThatWasNeverRecordedIsRefused) {
  RecordedDevice device({}, 0, 1, {}, {});
  const virtual_devices::Report read = {0x17, 0x04, 0xa4, 0x00, 0xfa, 0x00, 0x06};
  const auto answers = device.HandleOutput(0, read);
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0][0], 0x21);
  EXPECT_EQ(answers[0][3] & 0x0f, 7);
  EXPECT_EQ(answers[0][4], 0x00);
  EXPECT_EQ(answers[0][5], 0xfa);
  EXPECT_FALSE(device.has_handshake());
}

TEST(RecordedDevice, RepeatedRequestsGetTheirAnswersInOrder) {
  const virtual_devices::Report status = {0x15, 0x00}, mode = {0x12, 0x04, 0x31};
  std::vector<RecordedReport> reports;
  const auto add = [&](double time_s, virtual_devices::Report bytes, bool to_device) {
    reports.push_back({time_s, std::move(bytes), to_device, false});
  };
  add(0, status, true);
  add(0.01, {0x20, 0, 0, 1}, false);
  add(0.02, mode, true);
  add(0.03, {0x22, 0, 0, 0x12, 0}, false);
  add(0.04, {0x31, 0, 0, 1, 2, 3}, false);
  add(0.05, status, true);
  add(0.06, {0x20, 0, 0, 2}, false);
  add(0.07, {0x20, 0, 0, 3}, false);  // Unasked.
  RecordedDevice device({}, 0, 1, reports, {});
  EXPECT_EQ(device.HandleOutput(0, status)[0][3], 1);
  EXPECT_EQ(device.HandleOutput(0, mode)[0][0], 0x22);
  EXPECT_EQ(device.HandleOutput(0, virtual_devices::Report{0x15, 0x01})[0][3], 2);  // Motor on.
  EXPECT_EQ(device.HandleOutput(0, status)[0][3], 2);
  EXPECT_EQ(device.NextTime(), 0.04);
  EXPECT_EQ(device.Take()[0], 0x31);
  EXPECT_EQ(device.Take()[3], 3);
  EXPECT_FALSE(device.NextTime().has_value());
}

TEST(RecordedDevice, AJoyconsSubcommandsAreKnownWhateverPacketAndMotor) {
  virtual_devices::Joycon joycon(3, virtual_devices::JoyconModel::kLeft);
  const auto read = [](std::uint8_t packet, std::uint8_t motor, std::uint8_t address) {
    virtual_devices::Report report(49, 0);
    report[0] = 0x01;
    report[1] = packet;
    report[3] = motor;
    report[10] = 0x10;
    report[11] = address;
    report[12] = 0x60;
    report[15] = 18;
    return report;
  };
  std::vector<RecordedReport> reports;
  for (const std::uint8_t address : {0x20, 0x3d}) {
    const auto request = read(1, 1, address);
    reports.push_back({0.01, request, true, false});
    reports.push_back({0.02, joycon.HandleOutput(0, request)[0], false, false});
  }
  virtual_devices::Report samples(49, 0);
  samples[0] = 0x30;
  reports.push_back({0.03, samples, false, false});
  RecordedDevice device(joycon.identity(), 0, 1, reports, {});
  EXPECT_TRUE(device.has_handshake());
  const auto answers = device.HandleOutput(0, read(9, 0x81, 0x3d));
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_EQ(answers[0], reports[3].bytes);
  EXPECT_TRUE(device.HandleOutput(0, read(9, 1, 0x11)).empty());
  EXPECT_EQ(device.NextTime(), 0.03);
}

}  // namespace
}  // namespace footing::stream_client

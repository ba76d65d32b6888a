// The Switch's controllers: golden bytes, recorded traffic, and the simulated device from its
// handshake to its samples.
#include "daemon/sensor/kinds/joycon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/devices/joycon.h"
#include "common/virtual/devices/link_model.h"
#include "daemon/sensor/kinds/kind.h"
#include "daemon/sensor/reports/device_clock.h"
#include "tests/sensor/reports/sampled_time_error.h"

namespace footing::joycon {
namespace {

using reports::JoyconModel;
using virtual_devices::JoyconSensors;
using Bytes = std::vector<std::uint8_t>;

Bytes FromHex(const std::string& text) {
  Bytes bytes;
  std::string digits;
  for (const char c : text) {
    if (c != ' ') digits += c;
  }
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// Calibration blocks and info reply of real units, from Yamakaky/joy (MIT).
const Bytes kUserLeft = FromHex("b2a1 14ff 9dff 5300 0040 0040 0040 f5ff f0ff 0200 e73b e73b e73b");
const Bytes kUserRight =
    FromHex("b2a1 45ff 32ff ae01 0040 0040 0040 2000 c9ff ecff 3b34 3b34 3b34");

double GainOf(int coefficient, int offset) {
  return DegreesToRadians(936.0) / (coefficient - offset);
}

TEST(JoyconCalibration, TheUsersBlockOfRealUnitsGivesTheirOwnGyroscopes) {
  calibration::JoyconBlocks blocks;
  blocks.user_motion = kUserLeft;
  const auto left = calibration::ParseJoycon(blocks);
  EXPECT_EQ(left.origin, stream::CalibrationOrigin::kDevice);
  EXPECT_EQ(left.gyroscope_zero_counts, (std::array<double, 3>{-11, -16, 2}));
  EXPECT_DOUBLE_EQ(left.gyroscope_gain_radps[0], GainOf(15335, -11));
  blocks.user_motion = kUserRight;
  const auto right = calibration::ParseJoycon(blocks);
  EXPECT_DOUBLE_EQ(right.gyroscope_gain_radps[1], GainOf(13371, -55));
  // The newer gyroscope is less sensitive by 14.7 %: 936 / 13371 against 936 / 15335.
  EXPECT_NEAR(right.gyroscope_gain_radps[2] / left.gyroscope_gain_radps[2], 1.147, 0.002);
}

TEST(JoyconCalibration, ImpossibleBlocksGiveWay) {
  calibration::JoyconBlocks blocks;
  blocks.factory_motion.assign(kUserRight.begin() + 2, kUserRight.end());
  blocks.user_motion = Bytes(26, 0);  // A copy that has the mark and nothing behind it.
  blocks.user_motion[0] = 0xb2;
  blocks.user_motion[1] = 0xa1;
  const auto copy = calibration::ParseJoycon(blocks);
  EXPECT_EQ(copy.origin, stream::CalibrationOrigin::kDeviceCopy);
  EXPECT_EQ(copy.gyroscope_zero_counts[0], 32);
  for (const Bytes& block : {Bytes(24, 0xff), Bytes(24, 0), Bytes(5, 1), Bytes()}) {
    blocks = {};
    blocks.factory_motion = block;
    blocks.user_motion = Bytes(26, 0xff);
    const auto none = calibration::ParseJoycon(blocks);
    EXPECT_EQ(none.origin, stream::CalibrationOrigin::kDefaults);
    EXPECT_FALSE(none.problem.empty());
    EXPECT_DOUBLE_EQ(none.gyroscope_gain_radps[0], GainOf(13371, 0));
  }
}

TEST(JoyconCalibration, AxesAreThoseOfTheSensorFrame) {
  const calibration::JoyconCalibration typical = calibration::ParseJoycon({});
  // Recorded face up at rest: the left unit's raw z is +1 g, the right one's -1 g.
  const auto up = [&](JoyconModel model, std::int16_t z) {
    return calibration::Calibrate(typical, model, {{0, 0, z}, {0, 0, 0}}).specific_force_S_mps2;
  };
  EXPECT_TRUE(up(JoyconModel::kLeft, 4096).isApprox(Eigen::Vector3d(0, 0, -9.80665)));
  EXPECT_TRUE(up(JoyconModel::kPro, 4096).isApprox(Eigen::Vector3d(0, 0, -9.80665)));
  EXPECT_TRUE(up(JoyconModel::kRight, -4096).isApprox(Eigen::Vector3d(0, 0, -9.80665)));
  // Left side up shows on raw y of the left unit, on minus raw y of the right one; front up on raw
  // x of both. Rates go the same ways.
  const reports::JoyconSample sample = {{4096, 8192, 0}, {1000, 2000, 3000}};
  const auto left = calibration::Calibrate(typical, JoyconModel::kLeft, sample);
  const auto right = calibration::Calibrate(typical, JoyconModel::kRight, sample);
  EXPECT_TRUE(left.specific_force_S_mps2.isApprox(9.80665 * Eigen::Vector3d(2, 1, 0)));
  EXPECT_TRUE(right.specific_force_S_mps2.isApprox(9.80665 * Eigen::Vector3d(-2, 1, 0)));
  const double count = GainOf(13371, 0);
  EXPECT_TRUE(left.angular_velocity_S_radps.isApprox(count * Eigen::Vector3d(2000, 1000, -3000)));
  EXPECT_TRUE(right.angular_velocity_S_radps.isApprox(count * Eigen::Vector3d(-2000, 1000, 3000)));
  // 7.9 g is measured, 8 g is the end; the bit is that of S: raw y is its x.
  EXPECT_EQ(calibration::Calibrate(typical, JoyconModel::kLeft, {{0, 32358, 0}, {}}).clipped_axes,
            0u);
  EXPECT_EQ(calibration::Calibrate(typical, JoyconModel::kLeft, {{0, -32768, 0}, {}}).clipped_axes,
            1u);
}

TEST(JoyconReport, RumbleAndSubcommandAreTheDocumentedBytes) {
  EXPECT_EQ(reports::JoyconRumbleOnly(), FromHex("10 00 00014040 00014040"));
  Bytes mode = FromHex("01 00 00014040 00014040 03 30");
  mode.resize(49, 0);
  const std::uint8_t argument[] = {0x30};
  EXPECT_EQ(reports::JoyconCommand(reports::Subcommand::kReportMode, argument), mode);
  Bytes read = FromHex("01 00 00014040 00014040 10 20600000 18");
  read.resize(49, 0);
  EXPECT_EQ(reports::JoyconRead(0x6020, 0x18), read);
}

TEST(JoyconReport, NothingIsReadBehindAShortOne) {
  for (const std::uint8_t id : {0x21, 0x30, 0x31, 0x33}) {
    Bytes report(49, 0x55);
    report[0] = id;
    EXPECT_TRUE(reports::DecodeJoycon(report));
    report.pop_back();
    EXPECT_FALSE(reports::DecodeJoycon(report));
  }
  EXPECT_TRUE(reports::DecodeJoycon(Bytes{0x3f}));
  EXPECT_FALSE(reports::DecodeJoycon(Bytes{0x20, 0, 0}));
  EXPECT_FALSE(reports::DecodeJoycon(Bytes{}));
}

/// A line of recorded traffic.
struct Line {
  bool from_device = false;
  double time_s = 0;
  Bytes bytes;  ///< As hidraw has them.
};

std::vector<Line> ReadTrace(const std::string& path) {
  std::ifstream file(path);
  std::vector<Line> lines;
  for (std::string text; std::getline(file, text);) {
    std::istringstream words(text);
    std::string direction, time, hex;
    words >> direction >> time >> hex;
    Line line;
    line.from_device = direction == ">";
    line.time_s = 3600 * std::stod(time) + 60 * std::stod(time.substr(time.find(':') + 1)) +
                  std::stod(time.substr(time.rfind(':') + 1));
    line.bytes = FromHex(hex);
    line.bytes.erase(line.bytes.begin());
    lines.push_back(line);
  }
  return lines;
}

struct Trace {
  const char* file;
  JoyconModel model;
  int samples_reports, replies;
  bool rates;  ///< In mode 40 01.
};
constexpr Trace kTraces[] = {{"joycon_l.log", JoyconModel::kLeft, 317, 14, false},
                             {"procontroller.log", JoyconModel::kPro, 704, 15, true},
                             {"pair.log", JoyconModel::kRight, 1153, 56, false},
                             {"homescreen.log", JoyconModel::kRight, 219, 16, false}};

class Recorded : public testing::TestWithParam<Trace> {
 protected:
  void SetUp() override {
    const char* data = std::getenv("FOOTING_TEST_DATA");
    if (data == nullptr || *data == '\0') GTEST_SKIP() << "FOOTING_TEST_DATA names no folder";
    lines_ = ReadTrace(std::string(data) + "/joycon/" + GetParam().file);
  }
  std::vector<Line> lines_;
};
INSTANTIATE_TEST_SUITE_P(Traces, Recorded, testing::ValuesIn(kTraces));

double Distance(const reports::JoyconSample& a, const reports::JoyconSample& b) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    square += std::pow(a.acceleration[i] - b.acceleration[i], 2);
  }
  return std::sqrt(square);
}

TEST_P(Recorded, EveryReportDecodesAndTheFirstSampleIsTheNewest) {
  int reports_with_samples = 0, replies = 0, newest_first = 0, oldest_first = 0;
  std::optional<reports::JoyconReport> before;
  for (const Line& line : lines_) {
    if (!line.from_device) continue;
    const auto report = reports::DecodeJoycon(line.bytes);
    ASSERT_TRUE(report) << line.time_s;
    replies += report->reply ? 1 : 0;
    if (!report->has_samples) continue;
    ++reports_with_samples;
    const auto& now = report->samples;
    if (before && static_cast<std::uint8_t>(report->timer - before->timer) == 3) {
      // As decoded, older first, against the other order.
      const double gap = Distance(before->samples[2], now[0]);
      const double other = Distance(before->samples[0], now[2]);
      newest_first += gap < other ? 1 : 0;
      oldest_first += gap > other ? 1 : 0;
    }
    before = report;
  }
  EXPECT_EQ(reports_with_samples, GetParam().samples_reports);
  EXPECT_EQ(replies, GetParam().replies);
  RecordProperty("newest_first", newest_first);
  RecordProperty("oldest_first", oldest_first);
  // At rest the order is noise's; a device in motion shows it.
  EXPECT_GT(newest_first, oldest_first);
}

TEST_P(Recorded, GravityAtRestIsOneGAndTheGyroscopesModeIsSeen) {
  const auto kind = std::make_unique<Decoder>(GetParam().model);
  const calibration::JoyconCalibration typical = calibration::ParseJoycon({});
  std::vector<stream::MotionSample> window;
  double sum_g = 0;
  int rests = 0, with_rates = 0, with_motion = 0;
  for (const Line& line : lines_) {
    const auto report = reports::DecodeJoycon(line.bytes);
    if (!line.from_device || !report || !report->has_samples) continue;
    const auto decoded = kind->Take(typical, SecondsToNanoseconds(line.time_s), *report);
    for (std::size_t i = 0; i < decoded.motion.size(); ++i) {
      ++with_motion;
      with_rates += decoded.motion[i].has_angular_velocity ? 1 : 0;
      window.push_back(decoded.motion[i]);
    }
    constexpr std::size_t kWindow = 30;
    if (window.size() < kWindow) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& one : window) mean += one.specific_force_mps2 / static_cast<double>(kWindow);
    double variance = 0;
    for (const auto& one : window) {
      variance +=
          (one.specific_force_mps2 - mean).squaredNorm() / static_cast<double>(window.size());
    }
    constexpr double kStillMps2 = 0.06;
    if (std::sqrt(variance) < kStillMps2) {
      sum_g += mean.norm() / kStandardGravityMps2;
      ++rests;
    }
    window.clear();
  }
  ASSERT_GT(with_motion, 500);
  if (rests > 0) {
    const double mean_g = sum_g / rests;
    RecordProperty("rest_mg", static_cast<int>(std::round(1000 * mean_g)));
    RecordProperty("rests", rests);
    EXPECT_GT(mean_g, 0.98);
    EXPECT_LT(mean_g, 1.02);
  }
  // Packed attitudes are published as no rates but for the first three reports of each connection.
  if (GetParam().rates) {
    EXPECT_EQ(with_rates, with_motion);
  } else {
    EXPECT_LT(with_rates, 120);
  }
}

/// A kind and its simulated device, 5 ms a step: a report every 15 ms, and answers that take one.
class Conversation {
 public:
  static constexpr std::int64_t kStepNs = 5'000'000;

  explicit Conversation(virtual_devices::JoyconModel model, std::uint64_t seed = 1)
      : device(seed, model), random_(seed) {
    const auto& own = device.identity();
    kind = kinds::MakeKind({}, {own.vendor, own.product, own.name}, {});
    outbox = link::Outbox(kind->writing());
  }

  void Run(double seconds) {
    const std::int64_t end_ns = now_ns + SecondsToNanoseconds(seconds);
    while (now_ns < end_ns) Step();
  }
  /// The time until it is live, s; at most 20.
  double UntilLive() {
    while (!kind->live() && now_ns < 21'000'000'000) Step();
    return NanosecondsToSeconds(now_ns - 1'000'000'000);
  }
  stream::DeviceStatus Status() const {
    stream::DeviceStatus status;
    kind->AddTo(status);
    return status;
  }

  virtual_devices::Joycon device;
  std::unique_ptr<kinds::Kind> kind;
  link::Outbox outbox;
  JoyconSensors sensors;
  double loss = 0;  ///< Share of subcommands, and of answers, that get lost.
  std::function<bool(std::span<const std::uint8_t>)> swallows = [](auto) { return false; };
  std::vector<Bytes> written;
  std::optional<decode::Decoded> newest;
  int samples = 0;
  std::int64_t now_ns = 1'000'000'000;

 private:
  void Step() {
    now_ns += kStepNs;
    kinds::Outputs outputs;
    kind->Advance(now_ns, outputs);
    const bool report_due = now_ns % (3 * kStepNs) == 0;
    if (report_due) {
      for (const Bytes& answer : std::exchange(answers_, {})) {
        if (random_.Uniform() >= loss) Take(answer, outputs);
      }
      for (const Bytes& report : device.Sample(now_ns, sensors)) Take(report, outputs);
    }
    for (auto& output : outputs) EXPECT_TRUE(outbox.Push(std::move(output)));
    const auto output = kind->NextOutput(now_ns, outbox);
    if (!output) return;
    written.push_back(*output);
    EXPECT_EQ((*output)[1], (written.size() - 1) % 16) << "packet number";
    if (swallows(*output) || random_.Uniform() < loss) return;
    for (const Bytes& answer : device.HandleOutput(now_ns, *output)) answers_.push_back(answer);
  }
  void Take(const Bytes& report, kinds::Outputs& outputs) {
    const auto decoded = kind->Take(now_ns, report, outputs);
    ASSERT_TRUE(decoded);
    if (decoded->empty()) return;
    newest = decoded;
    samples += static_cast<int>(decoded->motion.size());
  }

  noise::Random random_;
  std::vector<Bytes> answers_;
};

constexpr virtual_devices::JoyconModel kModels[] = {virtual_devices::JoyconModel::kLeft,
                                                    virtual_devices::JoyconModel::kRight,
                                                    virtual_devices::JoyconModel::kPro};

class EachModel : public testing::TestWithParam<virtual_devices::JoyconModel> {};
INSTANTIATE_TEST_SUITE_P(Models, EachModel, testing::ValuesIn(kModels));

TEST_P(EachModel, IsSetUpAndMeasuresWhatItFeels) {
  Conversation one(GetParam(), 7);
  one.sensors.specific_force_S_mps2 = {20, -30, 60};  // 6.1 g downwards: a Wiimote ends at 4.9.
  one.sensors.angular_velocity_S_radps = {3, -5, 20};
  one.sensors.stick_x = 1;
  one.sensors.stick_y = -0.5;
  EXPECT_LT(one.UntilLive(), 0.6);
  one.Run(1);
  EXPECT_EQ(one.Status().calibration, stream::CalibrationOrigin::kDevice);
  EXPECT_EQ(one.Status().battery_fraction, 1);
  EXPECT_EQ(one.kind->Note(one.now_ns), "");
  EXPECT_NEAR(one.samples, 200, 6);
  ASSERT_TRUE(one.newest);
  ASSERT_EQ(one.newest->motion.size(), 3u);
  for (const auto& sample : one.newest->motion) {
    EXPECT_LT((sample.specific_force_mps2 - Eigen::Vector3d(20, -30, 60)).norm(), 0.003);
    EXPECT_LT((sample.angular_velocity_radps - Eigen::Vector3d(3, -5, 20)).norm(), 0.002);
    EXPECT_EQ(sample.clipped_axes, 0u);
    EXPECT_FALSE(sample.uncalibrated);
  }
  ASSERT_TRUE(one.newest->own_times);
  const auto& motion = one.newest->motion;
  EXPECT_EQ(motion[2].sampled_ns - motion[1].sampled_ns, 5'000'000);
  EXPECT_EQ(motion[1].sampled_ns - motion[0].sampled_ns, 5'000'000);
  ASSERT_TRUE(one.newest->nunchuk);
  EXPECT_EQ(one.newest->nunchuk->stick_x, 1);
  EXPECT_NEAR(one.newest->nunchuk->stick_y, -0.5, 0.001);
  EXPECT_GE(one.device.least_interval_ns(), 25'000'000);
}

TEST(Joycon, OlderSamplesComeFirst) {
  Decoder decoder(JoyconModel::kLeft);
  virtual_devices::Joycon device(1, virtual_devices::JoyconModel::kLeft);
  device.set_mode(0x30);
  device.set_sensor_mode(1);
  virtual_devices::JoyconBurst burst;
  for (std::size_t i = 0; i < 3; ++i)
    burst[i].specific_force_S_mps2 = {0, static_cast<double>(i), -9.8};
  const auto report = reports::DecodeJoycon(device.Sample(0, burst)[0]);
  const auto decoded = decoder.Take(calibration::ParseJoycon({}), 0, *report);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(decoded.motion[i].specific_force_mps2.y(), static_cast<double>(i), 0.002);
  }
}

TEST(Joycon, IsLiveWithinTwoSecondsWithATenthOfAllSubcommandsLost) {
  std::vector<double> times;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Conversation one(kModels[seed % 3], seed);
    one.loss = 0.1;  // In either direction: a fifth of the exchanges fail.
    times.push_back(one.UntilLive());
    one.loss = 0;
    one.Run(0.1);
    EXPECT_EQ(one.Status().calibration, stream::CalibrationOrigin::kDevice) << seed;
    EXPECT_GT(one.samples, 0) << seed;
    EXPECT_GE(one.device.least_interval_ns(), 25'000'000) << seed;
  }
  std::sort(times.begin(), times.end());
  RecordProperty("median_ms", static_cast<int>(1000 * times[150]));
  RecordProperty("longest_ms", static_cast<int>(1000 * times.back()));
  EXPECT_LE(times.back(), 2);
}

TEST(Joycon, ButtonsAreThoseOfAWiimote) {
  Conversation one(virtual_devices::JoyconModel::kRight);
  one.sensors.buttons = reports::kJoyconA | reports::kJoyconZr | reports::kJoyconPlus;
  one.UntilLive();
  one.Run(0.1);
  ASSERT_TRUE(one.newest);
  EXPECT_EQ(one.newest->motion[2].buttons, 0x0008u | 0x0004u | 0x1000u);
  EXPECT_TRUE(one.newest->nunchuk->z);
  EXPECT_FALSE(one.newest->gamepad);
}

TEST(Joycon, AProControllerIsAGamepadToo) {
  Conversation one(virtual_devices::JoyconModel::kPro);
  one.sensors.buttons = reports::kJoyconX | reports::kJoyconL | reports::kJoyconUp;
  one.sensors.stick_x = -1;
  one.UntilLive();
  one.Run(0.1);
  ASSERT_TRUE(one.newest && one.newest->gamepad);
  EXPECT_EQ(one.newest->gamepad->buttons,
            stream::kGamepadX | stream::kGamepadL | stream::kGamepadUp);
  EXPECT_EQ(one.newest->gamepad->left_x, -1);
}

TEST(Joycon, TheMotorIsAllowedShakenAgainAndStopped) {
  Conversation one(virtual_devices::JoyconModel::kLeft);
  one.UntilLive();
  one.outbox.SetRumble(true);
  one.Run(0.5);
  EXPECT_TRUE(one.device.rumble());
  Bytes shaking = FromHex("10 00 00814060 00814060");
  shaking[1] = one.written.back()[1];  // The packet number.
  EXPECT_EQ(one.written.back(), shaking);
  const std::size_t before = one.written.size();
  one.Run(1);
  EXPECT_NEAR(static_cast<double>(one.written.size() - before), 20, 1);  // Every 50 ms.
  one.outbox.SetRumble(false);
  one.Run(0.1);
  EXPECT_FALSE(one.device.rumble());
  const std::size_t stopped = one.written.size();
  one.Run(1);
  EXPECT_EQ(one.written.size(), stopped);
  EXPECT_GE(one.device.least_interval_ns(), 25'000'000);
}

TEST(Joycon, LampsArriveEvenWhenSubcommandsGetLost) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Conversation one(virtual_devices::JoyconModel::kRight, seed);
    one.UntilLive();
    one.loss = 0.2;
    kinds::Outputs none;
    one.kind->SetLamps(0b0110, none);
    one.Run(1.5);
    EXPECT_EQ(one.device.leds(), 0b0110) << seed;
  }
}

TEST(Joycon, WhatAnotherProgramChangedIsSetAgain) {
  Conversation one(virtual_devices::JoyconModel::kLeft);
  one.UntilLive();
  one.Run(1);
  one.device.set_mode(0x3f);
  one.Run(0.3);
  EXPECT_EQ(one.device.mode(), 0x30);
  EXPECT_EQ(one.Status().mode_reasserts, 1u);
  for (const std::uint8_t mode : {0, 2}) {
    one.Run(3);
    one.device.set_sensor_mode(mode);
    one.Run(0.4);
    EXPECT_EQ(one.device.sensor_mode(), 1);
    // Again right away: not before 3 s are over.
    one.device.set_sensor_mode(mode);
    one.Run(1);
    EXPECT_NE(one.kind->Note(one.now_ns), "");
    EXPECT_EQ(one.device.sensor_mode(), mode);
    one.Run(2.5);
    EXPECT_EQ(one.device.sensor_mode(), 1);
    EXPECT_EQ(one.kind->Note(one.now_ns), "");
    EXPECT_TRUE(one.newest->motion[2].has_angular_velocity);
  }
}

TEST(Joycon, ACopyWithoutMotionSensorKeepsItsStick) {
  Conversation one(virtual_devices::JoyconModel::kRight);
  one.swallows = [](auto report) { return report.size() > 10 && report[10] == 0x40; };
  one.sensors.stick_x = 1;
  EXPECT_LT(one.UntilLive(), 3);
  one.Run(30);
  EXPECT_EQ(one.samples, 0);
  EXPECT_EQ(one.newest->nunchuk->stick_x, 1);
  EXPECT_NE(one.kind->Note(one.now_ns).find("no motion sensor"), std::string::npos);
  // Asked again every 3 s at most.
  const auto asked = std::count_if(one.written.begin(), one.written.end(), [](const Bytes& report) {
    return report.size() > 10 && report[10] == 0x40;
  });
  EXPECT_LE(asked, 5 + 30 / 3 + 1);
}

TEST(Joycon, AMuteOneIsLeftInPeace) {
  Conversation one(virtual_devices::JoyconModel::kLeft);
  one.swallows = [](auto) { return true; };
  one.Run(60);
  EXPECT_TRUE(one.kind->live());
  EXPECT_NE(one.kind->Note(one.now_ns), "");
  // Seven subcommands five times, then the mode every 2 s and a block every 5 s.
  EXPECT_LE(one.written.size(), 35u + 30u + 12u + 4u);
  one.swallows = [](auto) { return false; };
  one.Run(25);
  EXPECT_EQ(one.Status().calibration, stream::CalibrationOrigin::kDevice);
  EXPECT_GT(one.samples, 1000);
}

TEST(Joycon, SampleTimesKeepToTheDevicesOwnClockOverALink) {
  for (const double rate : {0.995, 1.0, 1.005}) {
    virtual_devices::LinkModel link(
        virtual_devices::JoyconLink(virtual_devices::LinkQuality::kGood, 3), 0);
    noise::Random random(4);
    link::OwnClock clock(0.015);
    reports::JoyconTimer timer;
    link::SampledTimeError error;
    for (int i = 0; i < 4000; ++i) {
      const auto arrival = link.Next();
      if (random.Uniform() < 0.1) continue;  // Lost; the timer byte shows it.
      const auto own_ns = static_cast<std::int64_t>(rate * static_cast<double>(arrival.sampled_ns));
      const auto count = static_cast<std::uint8_t>(own_ns / 5'000'000);
      const auto timer_ns = timer.Advance(arrival.arrives_ns, count);
      if (!timer_ns) continue;
      clock.Take(arrival.arrives_ns, *timer_ns);
      if (i > 400) error.Add(clock.HostNs(*timer_ns), arrival.sampled_ns);
    }
    RecordProperty("rms_us_" + std::to_string(static_cast<int>(1000 * rate)),
                   static_cast<int>(1000 * error.rms_ms()));
    EXPECT_LT(error.rms_ms(), 2) << rate;
    EXPECT_LT(error.p99_ms(), 6) << rate;
  }
}

TEST(Joycon, ATimerThatCountsOtherwiseIsNotTrusted) {
  reports::JoyconTimer timer;
  int trusted = 0;
  for (int i = 0; i < 400; ++i) {
    // One count a report in place of three.
    if (timer.Advance(i * std::int64_t{15'000'000}, static_cast<std::uint8_t>(i))) ++trusted;
  }
  EXPECT_LT(trusted, 80);  // The first second.
}

}  // namespace
}  // namespace footing::joycon

#include "clients/stream/sensor_packets.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::int64_t kStepNs = 10'000'000;

/// Bytes of a packet in network order.
class Big {
 public:
  template <typename Value>
  Big& Add(Value value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(Value)>>(value);
    bytes_.append(bytes.rbegin(), bytes.rend());
    return *this;
  }
  Big& Add(const std::string& part) {
    bytes_ += part;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string SlimeVr(std::uint32_t type, const std::string& rest) {
  return Big().Add(type).Add(std::uint64_t{7}).Add(rest).bytes();
}

std::string Floats(std::initializer_list<double> values) {
  Big big;
  for (const double value : values) big.Add(static_cast<float>(value));
  return big.bytes();
}

std::string Rotation(std::uint8_t sensor, const Quaterniond& q) {
  return Big().Add(sensor).Add(std::uint8_t{1}).bytes() + Floats({q.x(), q.y(), q.z(), q.w()}) +
         std::string(1, '\0');
}

/// A report's first sample, in the sensor's axes.
struct Sample {
  bool has_rate = false;
  int battery_percent = 0;
  Vector3d specific_force_mps2, rate_radps;
};

Sample In(const SensorReport& one) {
  EXPECT_EQ(one.report.size(), 43u);
  EXPECT_EQ(one.report[0], 1);
  EXPECT_EQ(one.report[14], 1);
  std::array<float, 6> numbers;
  std::memcpy(numbers.data(), one.report.data() + 19, sizeof(numbers));
  return {one.report[1] == 2,
          one.report[3],
          {numbers[0], numbers[1], numbers[2]},
          {numbers[3], numbers[4], numbers[5]}};
}

class SensorPacketsTest : public testing::Test {
 protected:
  SensorPacket Take(const std::string& bytes, const std::string& from = "192.168.1.7") {
    now_ns_ += kStepNs;
    return packets_.Take(from, now_ns_, osc::AsBytes(bytes));
  }

  SensorPackets packets_;
  std::int64_t now_ns_ = 1'000'000'000;
};

TEST_F(SensorPacketsTest, ATrackersHandshakeIsAnswered) {
  const auto packet = Take(SlimeVr(3, std::string(40, '\0')));
  ASSERT_EQ(packet.replies.size(), 1u);
  EXPECT_EQ(packet.replies[0].size(), 64u);
  EXPECT_THAT(packet.replies[0], testing::StartsWith("\x03Hey OVR =D 5"));
  const auto info = Take(SlimeVr(15, std::string("\x01\x01\x02", 3)));
  EXPECT_THAT(info.replies, testing::Contains(std::string("\0\0\0\x0f\x01\x01", 6)));
}

TEST_F(SensorPacketsTest, ATrackerThatTurnsHasGravityAndItsRate) {
  // About an axis askew, from a mounting askew: 2 rad/s in its own axes.
  const Vector3d axis_S = Vector3d(1, 2, -0.5).normalized();
  const Quaterniond mounted(AngleAxisd(0.7, Vector3d(0.2, 1, 0.4).normalized()));
  SensorPacket packet;
  Quaterniond R_WS;
  for (int i = 0; i < 40; ++i) {
    R_WS = mounted * AngleAxisd(2.0 * 0.01 * i, axis_S);
    packet = Take(SlimeVr(17, Rotation(0, R_WS)));
  }
  ASSERT_EQ(packet.reports.size(), 1u);
  EXPECT_EQ(packet.reports[0].sensor, "192.168.1.7");
  const Sample sample = In(packet.reports[0]);
  ASSERT_TRUE(sample.has_rate);
  EXPECT_LT((sample.rate_radps - 2 * axis_S).norm(), 1e-4);
  const Vector3d up_S = R_WS.conjugate() * Vector3d(0, 0, kStandardGravityMps2);
  EXPECT_LT((sample.specific_force_mps2 - up_S).norm(), 1e-4);
}

TEST_F(SensorPacketsTest, ABundleOfTwoSensorsIsTwo) {
  const std::string first = Rotation(0, Quaterniond::Identity());
  const std::string second = Rotation(1, Quaterniond(AngleAxisd(kPi / 2, Vector3d::UnitX())));
  Big bundle;
  for (const auto& part : {first, second}) {
    bundle.Add(static_cast<std::uint16_t>(4 + part.size())).Add(std::uint32_t{17}).Add(part);
  }
  const auto packet = Take(SlimeVr(100, bundle.bytes()));
  ASSERT_EQ(packet.reports.size(), 2u);
  EXPECT_EQ(packet.reports[1].sensor, "192.168.1.7/1");
  EXPECT_NEAR(In(packet.reports[0]).specific_force_mps2.z(), kStandardGravityMps2, 1e-4);
  EXPECT_NEAR(In(packet.reports[1]).specific_force_mps2.y(), kStandardGravityMps2, 1e-4);
}

TEST_F(SensorPacketsTest, RotationAndAccelerationInOnePacketAddUp) {
  Big packed;
  packed.Add(std::uint8_t{0});
  for (const int part : {0, 0, 0, 32767, 128, -256, 0}) packed.Add(static_cast<std::int16_t>(part));
  auto packet = Take(SlimeVr(23, packed.bytes()));
  ASSERT_EQ(packet.reports.size(), 1u);
  EXPECT_FALSE(In(packet.reports[0]).has_rate) << "one rotation has none";
  Take(SlimeVr(12, Floats({3.9, 0.4})));
  packet = Take(SlimeVr(23, packed.bytes()));
  ASSERT_EQ(packet.reports.size(), 1u);
  const Sample sample = In(packet.reports[0]);
  EXPECT_LT((sample.specific_force_mps2 - Vector3d(1, -2, kStandardGravityMps2)).norm(), 1e-4);
  EXPECT_EQ(sample.battery_percent, 40);
}

TEST_F(SensorPacketsTest, PhonesSendOverOsc) {
  const auto say = [this](const std::string& address, double x, double y, double z) {
    const osc::Argument arguments[] = {static_cast<float>(x), static_cast<float>(y),
                                       static_cast<float>(z)};
    return Take(osc::WriteMessage(address, arguments));
  };
  EXPECT_TRUE(say("/gyroscope", 0.1, 0.2, 0.3).reports.empty());
  auto packet = say("/accelerometer", 0.001, -0.001, 9.79);  // Sensors2OSC's own example.
  ASSERT_EQ(packet.reports.size(), 1u);
  EXPECT_TRUE(In(packet.reports[0]).has_rate);
  EXPECT_NEAR(In(packet.reports[0]).rate_radps.y(), 0.2, 1e-6);
  EXPECT_NEAR(In(packet.reports[0]).specific_force_mps2.z(), 9.79, 1e-6);
  packet = say("/phone/accel", 0, 0, -0.5);
  EXPECT_TRUE(packet.reports.empty()) << "without gravity it is not a specific force";
  say("/phone/gravity", 0, 0, -1);
  packet = say("/phone/accel", 0, 0, -0.5);
  ASSERT_EQ(packet.reports.size(), 1u);
  EXPECT_NEAR(In(packet.reports[0]).specific_force_mps2.z(), 1.5 * kStandardGravityMps2, 1e-5);
}

TEST_F(SensorPacketsTest, ABoardsOwnReportGoesOnAsItIs) {
  std::string report(15 + 2 * 28, '\0');
  report[0] = 1;
  report[14] = 2;
  const auto packet = Take(report, "::1");
  ASSERT_EQ(packet.reports.size(), 1u);
  EXPECT_EQ(std::string(packet.reports[0].report.begin(), packet.reports[0].report.end()), report);
  report.pop_back();
  EXPECT_FALSE(Take(report).is_known);
}

TEST_F(SensorPacketsTest, WhatIsNotFiniteOrCutGivesNothing) {
  for (const std::string& bytes :
       {std::string(), std::string("x"), std::string(3, '\0'), std::string(11, '\0'),
        SlimeVr(17, Rotation(0, Quaterniond::Identity()).substr(0, 17)),
        SlimeVr(17, Rotation(0, Quaterniond(0, 0, 0, 0))),
        SlimeVr(17, Big().Add(std::uint8_t{0}).Add(std::uint8_t{1}).bytes() +
                        Floats({NAN, 0, 0, 1}) + "x"),
        SlimeVr(100, std::string("\xff\xff\0\0\0\x11", 6)), SlimeVr(101, "\x01"),
        SlimeVr(23, std::string(14, '\0')), std::string("/accelerometer\0\0,ff\0", 20),
        std::string(2000, '\1')}) {
    EXPECT_TRUE(Take(bytes).reports.empty());
  }
}

TEST_F(SensorPacketsTest, ANumberThatNoSensorMeasuresGivesNothing) {
  const auto say = [this](const std::string& address, float x) {
    const osc::Argument arguments[] = {x, 0.0F, 0.0F};
    return Take(osc::WriteMessage(address, arguments));
  };
  say("/phone/gravity", 0);
  // Finite, and times g beyond what a float holds.
  EXPECT_TRUE(say("/phone/accel", 1e38F).reports.empty());
  say("/phone/gravity", -1e38F);
  const auto packet = say("/phone/accel", 0);
  ASSERT_EQ(packet.reports.size(), 1u);
  EXPECT_EQ(In(packet.reports[0]).specific_force_mps2.x(), 0);
}

TEST_F(SensorPacketsTest, WhoMeasuresNothingTakesNoPlace) {
  for (std::size_t i = 0; i < SensorPackets::kMostSensors; ++i) {
    const std::string from = std::to_string(i);
    Take(SlimeVr(0, ""), from);
    Take(SlimeVr(4, Floats({0, 0, 9})), from);
    Take(SlimeVr(12, Floats({3.9, 0.4})), from);
    Take(osc::WriteMessage("/light", std::array<osc::Argument, 3>{1.0F, 1.0F, 1.0F}), from);
  }
  EXPECT_EQ(Take(SlimeVr(17, Rotation(0, Quaterniond::Identity())), "new").reports.size(), 1u);
}

TEST_F(SensorPacketsTest, SensorsAreBounded) {
  std::size_t reports = 0;
  for (int i = 0; i < 100; ++i) {
    reports +=
        Take(SlimeVr(17, Rotation(0, Quaterniond::Identity())), std::to_string(i)).reports.size();
  }
  EXPECT_EQ(reports, SensorPackets::kMostSensors);
  packets_.Forget("3");
  EXPECT_EQ(Take(SlimeVr(17, Rotation(0, Quaterniond::Identity())), "new").reports.size(), 1u);
}

}  // namespace
}  // namespace footing::stream_client

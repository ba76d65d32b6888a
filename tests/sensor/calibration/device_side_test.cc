#include <gtest/gtest.h>

#include <variant>

#include "common/device_models/balance_board.h"
#include "common/device_models/wiimote.h"
#include "daemon/sensor/calibration/acceleration.h"
#include "daemon/sensor/calibration/board.h"
#include "daemon/sensor/calibration/motion_plus.h"
#include "daemon/sensor/calibration/nunchuk.h"
#include "daemon/sensor/reports/camera.h"
#include "daemon/sensor/reports/extension.h"
#include "daemon/sensor/reports/input_report.h"

/// What the device models send, read by the decoders: both are written from the protocol's
/// descriptions, apart from each other, and the blocks are those of real units.
namespace footing::calibration {
namespace {

using device_models::ExtensionBytes;

constexpr device_models::NunchukBlock kRealNunchuk = {
    0x7d, 0x7a, 0x7e, 0x0a, 0xb0, 0xaf, 0xb1, 0x12, 0xe5, 0x21, 0x7c, 0xe7, 0x23, 0x7a, 0xfc, 0x51};
constexpr device_models::MotionPlusBlock kRealMotionPlusA = {
    0x7b, 0xec, 0x76, 0xca, 0x76, 0x2c, 0x32, 0xdc, 0xcc, 0xd7, 0x2e, 0xa8, 0xc8, 0x77, 0x5e, 0x02,
    0x76, 0x0f, 0x79, 0x3d, 0x77, 0x9b, 0x39, 0x43, 0xca, 0xa8, 0x31, 0xc8, 0x2d, 0x1c, 0xbc, 0x33};
constexpr device_models::MotionPlusBlock kRealMotionPlusB = {
    0x79, 0xbe, 0x77, 0x5a, 0x77, 0x38, 0x2f, 0x90, 0xcd, 0x3b, 0x2f, 0xfd, 0xc8, 0x29, 0x9c, 0x75,
    0x7d, 0xd4, 0x78, 0xef, 0x78, 0x8a, 0x35, 0xa6, 0xc9, 0x9b, 0x33, 0x50, 0x2d, 0x00, 0xbd, 0x23};

void ExpectNear(const Eigen::Vector3d& got, const Eigen::Vector3d& expected, double bound) {
  EXPECT_LE((got - expected).cwiseAbs().maxCoeff(), bound)
      << got.transpose() << " for " << expected.transpose();
}

TEST(DeviceSide, ANunchuksStickButtonsAndForceAreReadBack) {
  const auto calibration = ParseNunchuk(kRealNunchuk);
  ASSERT_EQ(calibration.origin, stream::CalibrationOrigin::kDevice);
  const double count_mps2 = 9.80665 / 200;
  for (const Eigen::Vector3d& force : {Eigen::Vector3d(0, 0, -9.81), Eigen::Vector3d(9.81, 0, 0),
                                       Eigen::Vector3d(3, -12, 7.5), Eigen::Vector3d(-9, 9, 9)}) {
    device_models::NunchukSensors sensors;
    sensors.stick_x = -0.5;
    sensors.stick_y = 0.75;
    sensors.c = true;
    sensors.specific_force_S_mps2 = force;
    const ExtensionBytes plain = device_models::NunchukBytes(kRealNunchuk, sensors);
    const auto counts = reports::DecodeNunchuk(plain);
    ASSERT_TRUE(counts);
    EXPECT_TRUE(counts->c);
    EXPECT_FALSE(counts->z);
    const auto reading = Calibrate(calibration, *counts);
    ExpectNear(reading.specific_force_S_mps2, force, count_mps2);
    EXPECT_NEAR(reading.stick_x, -0.5, 0.01);
    EXPECT_NEAR(reading.stick_y, 0.75, 0.01);
    // Behind a MotionPlus the lowest bit of each axis is lost.
    const auto passed = reports::DecodePassedNunchuk(device_models::PassedNunchuk(plain));
    ASSERT_TRUE(passed);
    EXPECT_TRUE(passed->c);
    EXPECT_FALSE(passed->z);
    ExpectNear(Calibrate(calibration, *passed).specific_force_S_mps2, force, 2 * count_mps2);
  }
}

TEST(DeviceSide, AMotionPlusTurningIsReadBackInBothRanges) {
  for (const auto& block : {kRealMotionPlusA, kRealMotionPlusB}) {
    const auto calibration = ParseMotionPlus(block);
    ASSERT_EQ(calibration.origin, stream::CalibrationOrigin::kDevice) << calibration.problem;
    for (const double rate_radps : {0.01, 0.5, 3.0, 6.0, 12.0, 20.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sign : {-1.0, 1.0}) {
          Eigen::Vector3d turn(0.02, -0.03, 0.04);
          turn[axis] = sign * rate_radps;
          const auto bytes = device_models::MotionPlusBytes(block, turn, false);
          ASSERT_EQ(reports::PacketOf(bytes), reports::PassedPacket::kMotionPlus);
          const auto counts = reports::DecodeMotionPlus(bytes);
          ASSERT_TRUE(counts);
          // A count of the fast range is some 0.25 degrees/s, of the slow one 0.07.
          ExpectNear(Calibrate(calibration, *counts).angular_velocity_S_radps, turn, 0.003);
        }
      }
    }
  }
}

TEST(DeviceSide, AWiimotesForceIsReadBackInEveryModeThatHasIt) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    device_models::Wiimote wiimote(seed);
    const auto blocks =
        wiimote.controller().memory().eeprom().subspan(kAccelerationBlockAddress, 20);
    const auto calibration = ParseAcceleration(blocks);
    ASSERT_EQ(calibration.origin, stream::CalibrationOrigin::kDevice);
    for (const std::uint8_t mode : {0x31, 0x33, 0x35, 0x37}) {
      wiimote.HandleOutput(device_models::Report{0x12, 0x04, mode});
      const Eigen::Vector3d force(4, -7, 11);
      const auto report = wiimote.Sample(force, reports::kA);
      ASSERT_TRUE(report);
      const auto decoded = reports::Decode(*report);
      EXPECT_EQ(decoded.buttons, reports::kA);
      const auto& data = std::get<reports::Data>(decoded.body);
      ASSERT_TRUE(data.has_acceleration);
      ExpectNear(Calibrate(calibration, data.acceleration_counts).specific_force_S_mps2, force,
                 0.1);
    }
  }
}

TEST(DeviceSide, WhatTheCameraSeesIsReadBackInEveryFormat) {
  device_models::Wiimote wiimote(1);
  device_models::WiimoteSensors sensors;
  sensors.camera[0] = device_models::CameraPoint{1000, 700, 5};
  sensors.camera[2] = device_models::CameraPoint{3, 258, 1};
  const auto write = [&wiimote](std::uint8_t at, std::uint8_t value) {
    device_models::Report report(22, 0);
    report[0] = 0x16;
    report[1] = 0x04;
    report[2] = 0xb0;
    report[4] = at;
    report[5] = 1;
    report[6] = value;
    wiimote.HandleOutput(report);
  };
  wiimote.HandleOutput(device_models::Report{0x13, 0x04});
  wiimote.HandleOutput(device_models::Report{0x1a, 0x04});
  write(0x30, 8);
  for (const auto& [mode, format] : {std::pair<std::uint8_t, std::uint8_t>{0x36, 1}, {0x33, 3}}) {
    write(0x33, format);
    wiimote.HandleOutput(device_models::Report{0x12, 0x04, mode});
    const auto report = wiimote.Sample(0, sensors).at(0);
    const auto decoded = reports::Decode(report);
    const auto points = reports::DecodeCamera(std::get<reports::Data>(decoded.body).camera());
    ASSERT_EQ(points.size(), 2u) << int{mode};
    EXPECT_EQ(points[0].x, 1000);
    EXPECT_EQ(points[0].y, 700);
    EXPECT_EQ(points[1].x, 3);
    EXPECT_EQ(points[1].y, 258);
  }
}

TEST(DeviceSide, ABoardsLoadIsReadBackWarmAndCold) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    device_models::BalanceBoard board(seed);
    const auto page = board.controller().memory().extension();
    const auto calibration = ParseBoard(page.subspan(0x20, 32), page.subspan(0x60, 2));
    ASSERT_EQ(calibration.origin, stream::CalibrationOrigin::kDevice) << calibration.problem;
    const auto write = [&board](std::uint8_t at, std::uint8_t value) {
      device_models::Report report(22, 0);
      report[0] = 0x16;
      report[1] = 0x04;
      report[2] = 0xa4;
      report[4] = at;
      report[5] = 1;
      report[6] = value;
      board.HandleOutput(report);
    };
    write(0xf0, 0x55);
    write(0xfb, 0x00);
    board.HandleOutput(device_models::Report{0x12, 0x04, 0x34});
    for (const int temperature : {0x0a, 0x19, 0x23}) {
      board.set_temperature(static_cast<std::uint8_t>(temperature));
      for (const double gravity_mps2 : {9.78, 9.80665, 9.83}) {
        board.set_gravity(gravity_mps2);
        const auto report = board.Sample({-20, 100, 300, 450});
        const auto decoded = reports::Decode(*report);
        const auto counts = reports::DecodeBoard(std::get<reports::Data>(decoded.body).extension());
        ASSERT_TRUE(counts);
        const auto forces = CornerForces(calibration, *counts, gravity_mps2);
        EXPECT_NEAR(forces[reports::kTopLeft], -20, 0.06);
        EXPECT_NEAR(forces[reports::kTopRight], 100, 0.06);
        EXPECT_NEAR(forces[reports::kBottomLeft], 300, 0.06);
        EXPECT_NEAR(forces[reports::kBottomRight], 450, 0.06);
      }
    }
  }
}

}  // namespace
}  // namespace footing::calibration

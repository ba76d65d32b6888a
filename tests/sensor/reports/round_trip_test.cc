// What a device model feels comes back out of the decoders: two readings of the same tables, made
// apart from each other, with calibrations of real units and many drawn ones.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "common/virtual/devices/balance_board.h"
#include "common/virtual/devices/ps_move.h"
#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/reports/acceleration.h"
#include "daemon/sensor/reports/board.h"
#include "daemon/sensor/reports/calibration_motion_plus.h"
#include "daemon/sensor/reports/move.h"
#include "daemon/sensor/reports/nunchuk.h"
#include "daemon/sensor/reports/camera.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;
using virtual_devices::Report;

constexpr double kRoundTripG = kStandardGravityMps2;
constexpr int kUnits = 40;
constexpr int kMotions = 50;

double Draw(std::mt19937& random, double bound) {
  return std::uniform_real_distribution<double>(-bound, bound)(random);
}
Eigen::Vector3d DrawVector(std::mt19937& random, double bound) {
  return {Draw(random, bound), Draw(random, bound), Draw(random, bound)};
}

reports::Data DataOf(const Report& report) {
  return std::get<reports::Data>(reports::Decode(report).body);
}

std::vector<std::uint8_t> RoundTripBytes(std::span<const std::uint8_t> page, std::size_t at,
                                         std::size_t size) {
  return {page.begin() + static_cast<std::ptrdiff_t>(at),
          page.begin() + static_cast<std::ptrdiff_t>(at + size)};
}

TEST(RoundTrip, WiimoteAccelerationComesBackWithinACount) {
  std::mt19937 random(1);
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    virtual_devices::Wiimote wiimote(seed);
    const auto calibration =
        ParseAcceleration(RoundTripBytes(wiimote.controller().memory().eeprom(), 0x16, 20));
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (const std::uint8_t mode : {0x31, 0x33, 0x35, 0x37, 0x3e}) {
      wiimote.HandleOutput(0, Report{0x12, 0x04, mode});
      for (int i = 0; i < kMotions; ++i) {
        virtual_devices::WiimoteSensors sensors;
        sensors.specific_force_S_mps2 = DrawVector(random, 3.5 * kRoundTripG);
        reports::Interleaver interleaver;
        std::optional<reports::Data> data;
        while (!data) data = interleaver.Take(DataOf(wiimote.Sample(0, sensors).at(0)));
        const auto back = Calibrate(calibration, data->acceleration_counts);
        // Half of 2 counts; of an interleaved pair all of 4. A g has at least 103.
        const double bound = (mode == 0x3e ? 4.0 : 1.0) / 103 * kRoundTripG;
        EXPECT_LE(
            (back.specific_force_S_mps2 - sensors.specific_force_S_mps2).cwiseAbs().maxCoeff(),
            bound + 1e-9);
      }
    }
  }
}

TEST(RoundTrip, CameraPointsComeBackInEveryFormat) {
  virtual_devices::Wiimote wiimote(1);
  const auto write = [&](std::uint8_t at, std::uint8_t value) {
    Report report(22, 0);
    report[0] = 0x16;
    report[1] = 0x04;
    report[2] = 0xb0;
    report[4] = at;
    report[5] = 1;
    report[6] = value;
    wiimote.HandleOutput(0, report);
  };
  wiimote.HandleOutput(0, Report{0x13, 0x04});
  wiimote.HandleOutput(0, Report{0x1a, 0x04});
  write(0x30, 0x08);
  std::mt19937 random(2);
  const std::pair<std::uint8_t, std::uint8_t> kModes[] = {
      {0x36, 1}, {0x37, 1}, {0x33, 3}, {0x3e, 5}};
  for (const auto& [mode, format] : kModes) {
    write(0x33, format);
    wiimote.HandleOutput(0, Report{0x12, 0x04, mode});
    for (int i = 0; i < kMotions; ++i) {
      virtual_devices::WiimoteSensors sensors;
      for (auto& point : sensors.camera) {
        if (random() % 4 == 0) continue;
        point = virtual_devices::CameraPoint{static_cast<int>(random() % 1023),
                                             static_cast<int>(random() % 768),
                                             static_cast<int>(random() % 15)};
      }
      reports::Interleaver interleaver;
      std::optional<reports::Data> data;
      while (!data) data = interleaver.Take(DataOf(wiimote.Sample(0, sensors).at(0)));
      const auto back = reports::DecodeCamera(data->camera());
      std::size_t seen = 0;
      for (const auto& point : sensors.camera) {
        if (!point) continue;
        ASSERT_LT(seen, back.size()) << int{mode};
        EXPECT_EQ(back[seen].x, point->x);
        EXPECT_EQ(back[seen].y, point->y);
        EXPECT_TRUE(format == 1 || back[seen].size == static_cast<unsigned>(point->size));
        ++seen;
      }
      EXPECT_EQ(seen, back.size());
    }
  }
}

TEST(RoundTrip, NunchukComesBackWithinACountAlsoThroughAMotionPlus) {
  std::mt19937 random(3);
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto block = virtual_devices::DrawNunchukBlock(seed);
    const auto page = virtual_devices::NunchukPage(block);
    const auto calibration = ParseNunchuk(RoundTripBytes(page, 0x20, 32));
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (int i = 0; i < kMotions; ++i) {
      virtual_devices::NunchukSensors sensors;
      sensors.specific_force_S_mps2 = DrawVector(random, 2 * kRoundTripG);
      sensors.stick_x = Draw(random, 1);
      sensors.stick_y = Draw(random, 1);
      sensors.c = random() % 2;
      sensors.z = random() % 2;
      const auto plain = virtual_devices::NunchukBytes(block, sensors);
      const auto passed = virtual_devices::PassedNunchuk(plain);
      for (const bool through : {false, true}) {
        const auto counts =
            through ? reports::DecodePassedNunchuk(passed) : reports::DecodeNunchuk(plain);
        ASSERT_TRUE(counts);
        const auto back = Calibrate(calibration, *counts);
        EXPECT_EQ(counts->c, sensors.c);
        EXPECT_EQ(counts->z, sensors.z);
        EXPECT_NEAR(back.stick_x, sensors.stick_x, 0.51 / 80);
        EXPECT_NEAR(back.stick_y, sensors.stick_y, 0.51 / 80);
        // Half a count, and the lowest bit when it is lost; a g has at least 196.
        EXPECT_LE(
            (back.specific_force_S_mps2 - sensors.specific_force_S_mps2).cwiseAbs().maxCoeff(),
            (through ? 1.5 : 0.5) / 196 * kRoundTripG + 1e-9);
      }
    }
  }
}

TEST(RoundTrip, MotionPlusComesBackWithinACountOfItsRange) {
  constexpr double kDegree = std::numbers::pi / 180;
  std::mt19937 random(4);
  int fast = 0;
  int slow = 0;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const auto block = virtual_devices::DrawMotionPlusBlock(seed);
    const auto calibration = ParseMotionPlus(block);
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (int i = 0; i < kMotions; ++i) {
      // Mixed: each axis crosses the border of its range at another time.
      const Eigen::Vector3d turn = DrawVector(random, 1200 * kDegree);
      const auto counts =
          reports::DecodeMotionPlus(virtual_devices::MotionPlusBytes(block, turn, i % 2));
      ASSERT_TRUE(counts);
      EXPECT_EQ(counts->extension_connected, i % 2 == 1);
      const Eigen::Vector3d back = Calibrate(calibration, *counts).angular_velocity_S_radps;
      const std::size_t kAxisOf[] = {reports::kPitch, reports::kRoll, reports::kYaw};
      for (int axis = 0; axis < 3; ++axis) {
        const bool is_slow = counts->slow[kAxisOf[axis]];
        ++(is_slow ? slow : fast);
        // Half a count is 2 of the block's 16 bits.
        const double bound = is_slow ? 2 * 270 / 12500.0 : 2 * 1200 / 17500.0;
        EXPECT_NEAR(back[axis], turn[axis], bound * kDegree + 1e-9);
      }
    }
  }
  EXPECT_GT(slow, 500);
  EXPECT_GT(fast, 500);
}

TEST(RoundTrip, BoardForcesComeBackWithinACountInWarmAndCold) {
  std::mt19937 random(5);
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    virtual_devices::BalanceBoard board(seed);
    auto& memory = board.controller().memory();
    (void)memory.Write(true, 0xa400f0, {{0x55}});
    (void)memory.Write(true, 0xa400fb, {{0x00}});
    board.HandleOutput(Report{0x12, 0x04, 0x34});
    const auto calibration = ParseBoard(RoundTripBytes(memory.extension(), 0x20, 32),
                                        RoundTripBytes(memory.extension(), 0x60, 2));
    ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
    for (int i = 0; i < kMotions; ++i) {
      board.set_temperature(static_cast<std::uint8_t>(1 + random() % 60));
      board.set_battery(static_cast<std::uint8_t>(0x60 + random() % 0x40));
      virtual_devices::CornerForces forces;
      for (double* corner : {&forces.top_right_n, &forces.bottom_right_n, &forces.top_left_n,
                             &forces.bottom_left_n}) {
        *corner = 250 + Draw(random, 300);  // From -5 to 56 kg.
      }
      const auto counts = reports::DecodeBoard(DataOf(board.Sample(forces).value()).extension());
      ASSERT_TRUE(counts);
      const auto back = CornerForces(calibration, *counts);
      const double bound_n =
          0.5 * 0.0116 * kRoundTripG * 1.05;  // Half of a count of at most 11.6 g.
      EXPECT_NEAR(back[reports::kTopRight], forces.top_right_n, bound_n);
      EXPECT_NEAR(back[reports::kBottomRight], forces.bottom_right_n, bound_n);
      EXPECT_NEAR(back[reports::kTopLeft], forces.top_left_n, bound_n);
      EXPECT_NEAR(back[reports::kBottomLeft], forces.bottom_left_n, bound_n);
    }
  }
}

TEST(RoundTrip, SixtyKilogramsAreSixtyAtTheEquator) {
  virtual_devices::BalanceBoard board(3);
  auto& memory = board.controller().memory();
  (void)memory.Write(true, 0xa400f0, {{0x55}});
  (void)memory.Write(true, 0xa400fb, {{0x00}});
  board.HandleOutput(Report{0x12, 0x04, 0x34});
  const auto calibration = ParseBoard(RoundTripBytes(memory.extension(), 0x20, 32),
                                      RoundTripBytes(memory.extension(), 0x60, 2));
  constexpr double kEquatorMps2 = 9.780;
  const double corner_n = 15 * kEquatorMps2;
  const auto counts = reports::DecodeBoard(
      DataOf(board.Sample({corner_n, corner_n, corner_n, corner_n}).value()).extension());
  double sum_n = 0;
  for (const double force_n : CornerForces(calibration, *counts, kEquatorMps2)) sum_n += force_n;
  EXPECT_NEAR(sum_n / kRoundTripG, 60, 4 * 0.006);
}

TEST(RoundTrip, MoveComesBackWithinACountInBothHalves) {
  std::mt19937 random(6);
  for (const auto model : {reports::MoveModel::kZcm1, reports::MoveModel::kZcm2}) {
    const bool first = model == reports::MoveModel::kZcm1;
    for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
      virtual_devices::PsMove move(
          seed, first ? virtual_devices::MoveModel::kZcm1 : virtual_devices::MoveModel::kZcm2);
      MoveBlob blob(model);
      move.Feature(0x10, 49);  // The first that the host sees need not be the first piece.
      for (int piece = 0; piece < 3; ++piece) EXPECT_TRUE(blob.Take(*move.Feature(0x10, 49)));
      ASSERT_TRUE(blob.complete());
      EXPECT_EQ(blob.bytes(), move.blob());
      const auto calibration = ParseMove(model, blob.bytes());
      ASSERT_EQ(calibration.origin, CalibrationOrigin::kDevice) << calibration.problem;
      std::optional<virtual_devices::MoveSensors> last;
      for (int i = 0; i < kMotions; ++i) {
        virtual_devices::MoveSensors sensors;
        sensors.specific_force_S_mps2 = DrawVector(random, 4 * kRoundTripG);
        sensors.angular_velocity_S_radps = DrawVector(random, 20);
        sensors.magnetic_field_S_counts = DrawVector(random, 2000);
        sensors.trigger = std::abs(Draw(random, 1));
        sensors.buttons = random() & 0x1909f0;
        sensors.temperature_raw = static_cast<std::uint16_t>(random() % 4096);
        const auto report = reports::DecodeMove(model, move.Sample(i * 11'000'000, sensors).at(0));
        ASSERT_TRUE(report);
        EXPECT_EQ(report->buttons, sensors.buttons);
        EXPECT_EQ(report->sequence, i % 16);
        EXPECT_EQ(report->timestamp, i * 1100 & 0xffff);
        EXPECT_EQ(report->temperature, sensors.temperature_raw);
        ASSERT_EQ(report->sample_count, first ? 2u : 1u);
        const std::size_t newest = report->sample_count - 1;
        const auto back = Calibrate(calibration, *report, newest);
        const double force_bound = 0.5 / 4060 * kRoundTripG + 1e-9;
        // A ZCM1's 80 rpm have at least 5170 counts, a ZCM2's 90 rpm 6600.
        const double turn_bound = 0.5 / (first ? 5150 / 8.378 : 6600 / 9.425);
        EXPECT_LE(
            (back.specific_force_S_mps2 - sensors.specific_force_S_mps2).cwiseAbs().maxCoeff(),
            force_bound);
        EXPECT_LE((back.angular_velocity_S_radps - sensors.angular_velocity_S_radps)
                      .cwiseAbs()
                      .maxCoeff(),
                  turn_bound);
        EXPECT_NEAR(back.trigger, sensors.trigger, 0.5 / 255 + 1e-9);
        if (first) {
          EXPECT_LE(
              (MagneticField(*report) - sensors.magnetic_field_S_counts).cwiseAbs().maxCoeff(),
              0.5 + 1e-9);
          const auto& before = last.value_or(sensors);
          const Eigen::Vector3d half_way =
              (before.angular_velocity_S_radps + sensors.angular_velocity_S_radps) / 2;
          EXPECT_LE((Calibrate(calibration, *report, 0).angular_velocity_S_radps - half_way)
                        .cwiseAbs()
                        .maxCoeff(),
                    turn_bound);
        }
        last = sensors;
      }
    }
  }
}

}  // namespace
}  // namespace footing::calibration

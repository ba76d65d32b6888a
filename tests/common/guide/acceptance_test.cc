#include "common/guide/acceptance.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/board/layout.h"

namespace footing::guide {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

stream::DeviceStatus Device(std::uint32_t device, stream::DeviceKind kind,
                            stream::DeviceRole role) {
  stream::DeviceStatus status;
  status.device = device;
  status.serial = "serial-" + std::to_string(device);
  status.kind = kind;
  status.role = role;
  status.rig = "main";
  status.state = stream::DeviceState::kLive;
  status.calibration = stream::CalibrationOrigin::kDevice;
  status.jitter_ms = 8;
  status.battery_fraction = 0.8;
  status.clock_offset_sd_ms = 2;
  return status;
}

/// One minute with two boards and two wrist devices; what goes wrong is set before.
struct Minute {
  std::vector<stream::DeviceStatus> devices{
      Device(1, stream::DeviceKind::kBalanceBoard, stream::DeviceRole::kLeftBoard),
      Device(2, stream::DeviceKind::kBalanceBoard, stream::DeviceRole::kRightBoard),
      Device(3, stream::DeviceKind::kWiimote, stream::DeviceRole::kLeftHand),
      Device(4, stream::DeviceKind::kWiimote, stream::DeviceRole::kRightHand)};
  double lean_m = 0.05;  ///< Lean on the left board, forward in truth.
  double empty_n = 2;
  double run_hz = 2.6;
  double jump_phase_rad = 0.1;
  int motion_every = 1;  ///< Motion at one of so many ticks.
  bool replug = true;
  bool unsettled_after_replug = false;  ///< Clock and jitter start again.
  double heavier_n = 0;                 ///< In the second half of standing.

  std::vector<Check> Run() {
    Acceptance acceptance("main", *board::LayoutNamed("one_foot_each", 20));
    std::int64_t now_ns = 5 * kSecondNs;
    for (const Planned& planned : PlanOf(1, true, true)) {
      acceptance.Begin(planned.phase, now_ns);
      const int ticks = static_cast<int>(planned.duration_s * 100);
      for (int i = 0; i < ticks; ++i, now_ns += kSecondNs / 100) {
        Tick(acceptance, planned.phase, i, ticks, now_ns);
      }
    }
    acceptance.End(now_ns);
    return acceptance.Checks();
  }

 private:
  void Tick(Acceptance& acceptance, Phase phase, int i, int ticks, std::int64_t now_ns) {
    rig::Tick tick;
    tick.host_ns = now_ns;
    if (i % 50 == 0) {
      auto shown = devices;
      for (auto& device : shown) {
        device.rumble = phase == Phase::kRumble;
        device.leds = phase == Phase::kLed ? i / 50 % 2 : 1;
      }
      if (replug && phase == Phase::kReplug && i > ticks / 3 && i < 2 * ticks / 3) {
        shown[3].state = stream::DeviceState::kLost;
      }
      if (unsettled_after_replug && phase == Phase::kReplug && i >= 2 * ticks / 3) {
        shown[3].clock_offset_sd_ms = -1;
        shown[3].jitter_ms = 90;
      }
      tick.devices = shown;
    }
    for (std::uint32_t device = 1; device <= 2; ++device) {
      stream::BoardSample sample;
      sample.device = device;
      const bool off = phase == Phase::kStepping && i / 100 % 2 == 1;
      sample.total_n = off ? empty_n : 343;
      if (phase == Phase::kQuiet && i > ticks / 2) sample.total_n += heavier_n;
      sample.contact = sample.cop_valid = !off;
      if (phase == Phase::kLean) sample.cop_x_m = device == 1 ? -lean_m : 0.05;
      tick.boards.push_back(sample);
    }
    for (std::uint32_t device = 3; device <= 4 && i % motion_every == 0; ++device) {
      stream::MotionSample sample;
      sample.device = device;
      tick.motion.push_back(sample);
    }
    stream::RigFeatures features;
    features.rig = "main";
    for (std::uint32_t device = 3; device <= 4; ++device) {
      stream::DeviceFeatures one;
      one.moving = phase == Phase::kWalk || phase == Phase::kRun || phase == Phase::kJump;
      one.frequency_valid = one.moving;
      one.frequency_hz = phase == Phase::kRun ? run_hz : 1.2;
      features.devices.push_back(one);
    }
    stream::PairFeatures pair;
    pair.phase_valid = phase == Phase::kWalk || phase == Phase::kJump;
    pair.phase_rad = phase == Phase::kJump ? jump_phase_rad : -3.0;
    features.pairs = {pair};
    tick.features.push_back(features);
    acceptance.Take(tick);
  }
};

Check Named(const std::vector<Check>& checks, const std::string& name) {
  for (const Check& check : checks) {
    if (check.name == name) return check;
  }
  ADD_FAILURE() << "no check " << name;
  return {};
}

std::string Failed(const std::vector<Check>& checks) {
  std::string names;
  for (const Check& check : checks) {
    if (!check.passed) names += (names.empty() ? "" : ", ") + check.name;
  }
  return names;
}

TEST(Acceptance, PassesWhenEverythingIsAsItShouldBe) {
  const auto checks = Minute{}.Run();
  EXPECT_EQ(Failed(checks), "");
  EXPECT_TRUE(Passed(checks));
  EXPECT_NEAR(Named(checks, "rate serial-1").value, 100, 1);
  EXPECT_NEAR(Named(checks, "stood on").value, 2 * 343 / 9.80665, 0.1);
}

TEST(Acceptance, PlansOnlyWhatTheDevicesCanDo) {
  for (const Planned& planned : PlanOf(10, false, true)) {
    EXPECT_NE(planned.phase, Phase::kWalk);
    EXPECT_NE(planned.phase, Phase::kRumble);
  }
  double whole_s = 0;
  for (const Planned& planned : PlanOf(10, true, false)) {
    EXPECT_NE(planned.phase, Phase::kLean);
    whole_s += planned.duration_s;
  }
  EXPECT_NEAR(whole_s, 600, 1e-6);
}

TEST(Acceptance, AShortRunLeavesTheLampsTimeForTwoPatterns) {
  for (const Planned& planned : PlanOf(0.1, true, true)) {
    EXPECT_GE(planned.duration_s, planned.phase == Phase::kLed ? 4.0 : 0.2);
  }
}

TEST(Acceptance, FindsATurnedBoard) {
  Minute minute;
  minute.lean_m = -0.05;
  const auto checks = minute.Run();
  EXPECT_EQ(Failed(checks), "layout");
  EXPECT_NE(Named(checks, "layout").note.find("left board is turned"), std::string::npos);
}

TEST(Acceptance, FindsABadTare) {
  Minute minute;
  minute.empty_n = 25;
  EXPECT_EQ(Failed(minute.Run()), "tare serial-1, tare serial-2");
}

TEST(Acceptance, FindsAMassThatChanges) {
  Minute minute;
  minute.heavier_n = 15;
  EXPECT_EQ(Failed(minute.Run()), "mass constancy");
}

TEST(Acceptance, FindsAnExhaustedBatteryAndASlip) {
  Minute minute;
  minute.devices[2].battery_low = true;
  minute.devices[3].slipped = true;
  const auto checks = minute.Run();
  EXPECT_EQ(Failed(checks), "battery serial-3, mounting serial-4");
  EXPECT_NE(Named(checks, "mounting serial-4").note.find("--only mounting"), std::string::npos);
}

TEST(Acceptance, AClockThatWasNotMeasuredDoesNotPass) {
  Minute minute;
  minute.devices[2].clock_offset_sd_ms = -1;
  minute.devices[3].clock_offset_sd_ms = 7;
  const auto checks = minute.Run();
  EXPECT_EQ(Failed(checks), "clock serial-3, clock serial-4");
  EXPECT_NE(Named(checks, "clock serial-3").note.find("not measured"), std::string::npos);
  EXPECT_FALSE(Passed(checks));
}

TEST(Acceptance, AReplugDoesNotSpoilTheMeasuredClock) {
  Minute minute;
  minute.unsettled_after_replug = true;
  EXPECT_EQ(Failed(minute.Run()), "");
}

TEST(Acceptance, FindsASlowDevice) {
  Minute minute;
  minute.motion_every = 2;  // 50 a second.
  EXPECT_EQ(Failed(minute.Run()), "rate serial-3, rate serial-4");
}

TEST(Acceptance, FindsMotionThatIsNotAsAsked) {
  Minute minute;
  minute.run_hz = 1.4;
  minute.jump_phase_rad = 3;
  EXPECT_EQ(Failed(minute.Run()), "run cadence, jump phase");
}

TEST(Acceptance, AsksForADeviceThatComesBack) {
  Minute minute;
  minute.replug = false;
  EXPECT_EQ(Failed(minute.Run()), "replug");
}

TEST(Acceptance, FailsWithoutDevices) {
  Minute minute;
  minute.devices.clear();
  EXPECT_FALSE(Passed(Acceptance("main", {}).Checks()));
  EXPECT_FALSE(Passed({}));
}

}  // namespace
}  // namespace footing::guide

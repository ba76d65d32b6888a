#include "tests/device_faults/fault.h"

namespace footing::device_faults {
namespace {

FOOTING_FAULT(Fault50LowBatteries) {
  auto wiimote = std::make_shared<WiimoteModel>(50);
  wiimote->wiimote.controller().set_battery(0x08);
  auto board = std::make_shared<BoardModel>(5000);
  Device& first = bench.Plug(wiimote);
  Device& second = bench.Plug(board);
  // Byte 10 of the board's extension; the status report of a board says full all the time.
  second.outgoing = [](const Report& report) {
    Report low = report;
    if (report[0] == 0x34) low[3 + 10] = 0x6c;
    return std::vector<Report>{low};
  };
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(first));
  ASSERT_TRUE(bench.UntilLive(second));
  EXPECT_TRUE(bench.Until([&] { return Status(first).battery_low(); }));
  EXPECT_LT(Status(first).battery_fraction(), 0.2);
  EXPECT_TRUE(bench.Until([&] { return Status(second).battery_fraction() >= 0; }));
  EXPECT_LT(Status(second).battery_fraction(), 0.4);
  for (const auto& sample : Boards(second)) ASSERT_NEAR(sample.total_n(), 660, 10);
  // With batteries that are too low a board keeps its link and says nothing.
  second.sampling = false;
  ASSERT_TRUE(bench.UntilState(second.serial(), v1::DEVICE_STATE_STALE));
  EXPECT_TRUE(
      bench.Until([&] { return Status(second).note().find("batter") != std::string::npos; }, 3));
  ASSERT_TRUE(bench.UntilSamples(first, 10));
}

FOOTING_FAULT(Fault51EmptyBoard) {
  auto board = std::make_shared<BoardModel>(51);
  Device& device = bench.Plug(board);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  board->forces = {0, 0, 0, 0};
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  for (const auto& sample : Boards(device)) {
    EXPECT_FALSE(sample.cop_valid());
    EXPECT_FALSE(sample.contact());
    EXPECT_EQ(sample.cop_x_m(), 0);
    EXPECT_EQ(sample.cop_y_m(), 0);
    EXPECT_NEAR(sample.total_n(), 0, 1);
  }
  board->forces = {150, 150, 150, 150};
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 5));
  EXPECT_TRUE(Boards(device).back().cop_valid());
}

FOOTING_FAULT(Fault52MoreThanTheCalibrationCovers) {
  auto board = std::make_shared<BoardModel>(52);
  Device& device = bench.Plug(board);
  board->forces = {600, 580, 560, 540};  // 55 to 61 kg a corner, 232 kg in all.
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  const auto& sample = Boards(device).back();
  // The slope above 34 kg goes on; temperature and battery change it by less than 1 %.
  EXPECT_NEAR(sample.top_left_n(), 600, 6);
  EXPECT_NEAR(sample.bottom_right_n(), 540, 6);
  EXPECT_NEAR(sample.total_n(), 2280, 20);
  EXPECT_TRUE(sample.cop_valid());
}

FOOTING_FAULT(Fault53NegativeForces) {
  auto board = std::make_shared<BoardModel>(53);
  Device& device = bench.Plug(board);
  board->forces = {-20, 100, 120, -15};  // A corner that hangs in the air.
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  const auto& sample = Boards(device).back();
  EXPECT_NEAR(sample.top_left_n(), -20, 0.6);
  EXPECT_NEAR(sample.bottom_right_n(), -15, 0.6);
  EXPECT_NEAR(sample.total_n(), 185, 2);
  board->forces = {-20, -20, -20, -20};
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 5));
  EXPECT_NEAR(Boards(device).back().total_n(), -80, 2);
  EXPECT_FALSE(Boards(device).back().cop_valid());
  // Tared with something on it that is taken away afterwards.
  board->forces = {10, 10, 10, 10};
  bench.Run(1.2);
  v1::Command command;
  command.mutable_tare()->set_serial(device.serial());
  command.mutable_tare()->set_window_s(1);
  ASSERT_TRUE(bench.Send(command).ok());
  board->forces = {0, 0, 0, 0};
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 5));
  EXPECT_NEAR(Boards(device).back().total_n(), -40, 1);
  EXPECT_NEAR(Boards(device).back().top_left_n(), -10, 0.3);
  EXPECT_FALSE(Boards(device).back().cop_valid());
}

FOOTING_FAULT(Fault54PersonStepsOnDuringTheTare) {
  auto board = std::make_shared<BoardModel>(54);
  board->forces = {6, 5, -4, 8};  // Forces that it shows when empty.
  Device& device = bench.Plug(board);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  const auto tare = [&] {
    v1::Command command;
    command.mutable_tare()->set_serial(device.serial());
    command.mutable_tare()->set_window_s(1);
    return bench.Send(command);
  };
  const auto total_n = [&] {
    bench.Run(0.1);
    bench.seen().Forget();
    EXPECT_TRUE(bench.UntilSamples(device, 5));
    return Boards(device).back().total_n();
  };
  bench.Run(0.9);
  // A foot comes down; then both stand still, which is no empty board either.
  for (int i = 0; i < 20; ++i) {
    board->forces.top_left_n += 8;
    board->forces.bottom_left_n += 8;
    bench.Run(0.02);
  }
  v1::CommandResult result = tare();
  EXPECT_FALSE(result.ok());
  EXPECT_NE(result.message().find("step off"), std::string::npos) << result.message();
  board->forces = {150, 160, 170, 180};
  bench.Run(1.1);
  result = tare();
  EXPECT_FALSE(result.ok());
  EXPECT_NE(result.message().find("too much for an empty board"), std::string::npos);
  EXPECT_NEAR(total_n(), 660, 7);  // Neither was taken off.
  EXPECT_FALSE(Status(device).tared());
  // Empty and left alone it is tared.
  board->forces = {6, 5, -4, 8};
  bench.Run(1.2);
  result = tare();
  EXPECT_TRUE(result.ok()) << result.message();
  EXPECT_NEAR(total_n(), 0, 0.5);
  EXPECT_TRUE(bench.Until([&] { return Status(device).tared(); }));
  board->forces = {156, 165, 166, 188};
  EXPECT_NEAR(total_n(), 660, 7);
}

FOOTING_FAULT(Fault55ClippedAcceleration) {
  auto model = std::make_shared<WiimoteModel>(55);
  Device& device = bench.Plug(model);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  model->specific_force_S_mps2 = {80, 0, -9.80665};  // 8 g sideways; the sensor ends before 5 g.
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 20));
  for (const auto& sample : Motion(device)) EXPECT_EQ(sample.clipped_axes(), 1u);
  EXPECT_TRUE(bench.Until([&] { return Status(device).clipped() >= 20; }));
  model->specific_force_S_mps2 = {0, 0, -9.80665};
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 10));
  for (const auto& sample : Motion(device)) EXPECT_EQ(sample.clipped_axes(), 0u);
  ExpectAllAtRest(device, 10);
}

FOOTING_FAULT(Fault56StuckSensor) {
  auto board = std::make_shared<BoardModel>(56);
  Device& device = bench.Plug(board);
  ASSERT_TRUE(bench.Start());
  ASSERT_TRUE(bench.UntilLive(device));
  // All four corners say 0017 for ever: thousands of counts under the empty board.
  device.outgoing = [](const Report& report) {
    Report stuck = report;
    for (std::size_t i = 0; report[0] == 0x34 && i < 8; ++i) stuck[3 + i] = i % 2 == 0 ? 0 : 0x17;
    return std::vector<Report>{stuck};
  };
  bench.Run(0.1);
  bench.seen().Forget();
  ASSERT_TRUE(bench.UntilSamples(device, 30));
  for (const auto& sample : Boards(device)) {
    EXPECT_TRUE(sample.repeated());
    EXPECT_FALSE(sample.cop_valid());
    EXPECT_FALSE(sample.contact());
    EXPECT_LT(sample.total_n(), -500);
  }
  EXPECT_TRUE(bench.Until([&] { return Status(device).repeats() >= 30; }));
  // One corner says 0017 while the others move: that is a broken sensor, and is said.
  device.outgoing = [](const Report& report) {
    Report stuck = report;
    if (report[0] == 0x34) stuck[3] = 0, stuck[4] = 0x17;
    return std::vector<Report>{stuck};
  };
  // After 500 changes of the others.
  EXPECT_TRUE(bench.Until(
      [&] {
        board->forces.top_left_n = board->forces.bottom_left_n = board->forces.bottom_right_n =
            100 + static_cast<double>(clock::MonotonicNs() / 1'000'000 % 400);
        return Status(device).note().find("top right sensor never changes") != std::string::npos;
      },
      30));
}

}  // namespace
}  // namespace footing::device_faults

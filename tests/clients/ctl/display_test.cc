#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "clients/ctl/report/device_table.h"
#include "clients/ctl/report/live_screen.h"

namespace footing::ctl::display {
namespace {

constexpr double kKilogramN = 9.80665;  // Standard gravity.

stream::DeviceStatus Board() {
  stream::DeviceStatus board;
  board.device = 2;
  board.serial = "00:22:4c:11:22:33";
  board.kind = stream::DeviceKind::kBalanceBoard;
  board.rig = "main";
  board.role = stream::DeviceRole::kLeftBoard;
  board.state = stream::DeviceState::kLive;
  board.report_rate_hz = 61.24;
  board.jitter_ms = 4.96;
  board.reports = 1000;
  board.repeats = 187;
  board.battery_fraction = 0.125;
  board.battery_low = true;
  board.leds = 1;
  board.tared = true;
  return board;
}

stream::DeviceStatus Wiimote() {
  stream::DeviceStatus wiimote;
  wiimote.device = 1;
  wiimote.serial = "00:1f:32:aa:bb:cc";
  wiimote.kind = stream::DeviceKind::kWiimote;
  wiimote.extension = stream::Extension::kNunchuk;
  wiimote.rig = "main";
  wiimote.role = stream::DeviceRole::kRightHand;
  wiimote.state = stream::DeviceState::kStale;
  wiimote.simulated = true;
  wiimote.calibration = stream::CalibrationOrigin::kDefaults;
  wiimote.note = "no data for 3 s: asked again";
  wiimote.leds = 10;
  return wiimote;
}

Live LiveBoard() {
  Live live;
  live.link = "connected";
  live.devices = {Board()};
  stream::BoardSample sample;
  sample.device = 2;
  sample.top_left_n = 20 * kKilogramN;
  sample.top_right_n = 10 * kKilogramN;
  sample.bottom_left_n = 4 * kKilogramN;
  sample.bottom_right_n = -0.25 * kKilogramN;
  sample.total_n = 33.75 * kKilogramN;
  sample.cop_valid = true;
  sample.cop_x_m = -0.0456;
  sample.cop_y_m = 0.0121;
  sample.tared = true;
  live.Take(sample);
  return live;
}

TEST(Text, WritesNumbersWithoutLocaleOrMinusZero) {
  EXPECT_EQ(Fixed(1.25, 1), "1.2");
  EXPECT_EQ(Fixed(-0.04, 1), "0.0");
  EXPECT_EQ(Fixed(-12.5, 0), "-12");
  EXPECT_EQ(Fixed(std::numeric_limits<double>::quiet_NaN(), 1), "-");
}

TEST(Text, WritesDates) {
  // date -u -d @1700000000: Tue Nov 14 22:13:20 UTC 2023.
  EXPECT_EQ(Date(1'700'000'000'000'000'000), "2023-11-14 22:13 UTC");
  EXPECT_EQ(Date(0), "-");
}

TEST(Text, ClipsBars) {
  EXPECT_EQ(Bar(20, 40, 4), "##..");
  EXPECT_EQ(Bar(-1, 40, 4), "....");
  EXPECT_EQ(Bar(99, 40, 4), "####");
  EXPECT_EQ(Bar(std::nan(""), 40, 4), "....");
}

TEST(Text, AlignsNumbersToTheRight) {
  EXPECT_EQ(Table({{"nr", "name"}, {"1", "left"}, {"10", "r"}}), "nr  name\n 1  left\n10  r\n");
}

TEST(DeviceTable, ShowsALineADeviceAndNotesBelow) {
  EXPECT_EQ(DeviceTable({Wiimote(), Board()}),
            "nr  serial             kind           role             state  extension  rate Hz  "
            "jitter ms  "
            "battery   leds  marks\n"
            " 1  00:1f:32:aa:bb:cc  wiimote        main/right_hand  stale  nunchuk        0.0      "
            "  0.0  "
            "-         0101  simulated,UNCALIBRATED\n"
            " 2  00:22:4c:11:22:33  balance_board  main/left_board  live   -             61.2      "
            "  5.0  "
            "12 % LOW  1000  tared\n"
            "00:1f:32:aa:bb:cc: no data for 3 s: asked again\n");
}

TEST(DeviceJson, SaysNullForWhatIsUnknown) {
  const auto out = DeviceToJson(Wiimote());
  EXPECT_TRUE(out["battery_fraction"].is_null());
  EXPECT_TRUE(out["clock_offset_sd_ms"].is_null());
  EXPECT_EQ(out["extension"], "nunchuk");
  EXPECT_EQ(out["calibration"], "defaults");
  EXPECT_EQ(out["leds"], "0101");
  EXPECT_EQ(DeviceToJson(Board())["battery_fraction"], 0.125);
}

TEST(DeviceJson, HasEveryFieldOfTheContract) {
  const auto out = DeviceToJson(Board());
  for (const char* field : {"device",
                            "serial",
                            "kind",
                            "name",
                            "rig",
                            "role",
                            "state",
                            "simulated",
                            "extension",
                            "calibration",
                            "extension_calibration",
                            "gyroscope_calibration",
                            "rate_hz",
                            "jitter_ms",
                            "gaps",
                            "repeats",
                            "battery_fraction",
                            "battery_low",
                            "leds",
                            "driver",
                            "place",
                            "tared",
                            "mounted",
                            "slipped",
                            "moved",
                            "note"}) {
    EXPECT_TRUE(out.contains(field)) << field;
  }
}

TEST(DeviceJson, WritesASpheresColour) {
  stream::DeviceStatus move;
  move.sphere_rgb = 0x00ff40;
  EXPECT_EQ(DeviceToJson(move)["sphere"], "#00ff40");
}

TEST(SetupTable, TellsWhatIsStaleAndWhatFailed) {
  stream::RigSetup rig;
  rig.rig = "main";
  rig.items = {
      {"tare", "00:22:4c:11:22:33", true, 1'700'000'000'000'000'000, 0.315, "N", "", false},
      {"layout", "", true, 1'700'000'000'000'000'000, 0, "", "boards moved", true},
      {"weigh", "", false, 1'700'000'000'000'000'000, 7, "N", "", false}};
  EXPECT_EQ(
      SetupTable({rig}),
      "rig   setup   device             result  date                  residual  note\n"
      "main  tare    00:22:4c:11:22:33  ok      2023-11-14 22:13 UTC  0.32 N\n"
      "main  layout  -                  STALE   2023-11-14 22:13 UTC  -         boards moved\n"
      "main  weigh   -                  FAILED  2023-11-14 22:13 UTC  7.00 N\n");
  EXPECT_EQ(SetupTable({}), "nothing is set up yet: footing-ctl setup\n");
}

TEST(SetupTable, ALayoutThatWasSetIsASetup) {
  stream::RigSetup rig;
  rig.rig = "main";
  rig.layout.preset = "one_foot_each";
  EXPECT_EQ(SetupTable({rig}),
            "rig   setup   device  result  date  residual  note\n"
            "main  layout  -       set     -     -         one_foot_each\n"
            "nothing else is set up yet: footing-ctl setup\n");
}

TEST(LiveScreen, DrawsABoardInKilograms) {
  EXPECT_EQ(LiveScreen(LiveBoard()),
            "connected\n\n"
            "nr  role             serial             state  rate Hz  jitter ms  gaps  repeats  "
            "battery   extension\n"
            " 2  main/left_board  00:22:4c:11:22:33  live      61.2        5.0     0   18.7 %  "
            "12 % LOW  -\n"
            "\n2 main/left_board\n"
            "  TL [##########..........]   20.0 kg  TR [#####...............]   10.0 kg\n"
            "  BL [##..................]    4.0 kg  BR [....................]   -0.2 kg\n"
            "  total 33.8 kg, centre of pressure 46 mm left, 12 mm front\n");
}

TEST(LiveScreen, ShowsNoForcesOfASilentDevice) {
  Live live = LiveBoard();
  live.devices[0].state = stream::DeviceState::kStale;
  live.devices[0].note = "asleep";
  const std::string screen = LiveScreen(live);
  EXPECT_EQ(screen.find("kg"), std::string::npos) << screen;
  EXPECT_NE(screen.find("asleep"), std::string::npos);
}

TEST(LiveScreen, DrawsAGamepadsSticksTriggersAndButtons) {
  Live live = LiveBoard();
  live.devices[0].kind = stream::DeviceKind::kWiimote;
  stream::GamepadSample sample;
  sample.device = live.devices[0].device;
  sample.left_x = -0.5;
  sample.right_y = 1;
  sample.left_trigger = 0.25;
  sample.buttons = stream::kGamepadA | stream::kGamepadZr | stream::kGamepadRightStick;
  live.Take(sample);
  const std::string screen = LiveScreen(live);
  EXPECT_NE(screen.find("  sticks (-0.50, 0.00) (0.00, 1.00)  triggers 0.25 0.00"
                        "  A, ZR, right stick\n"),
            std::string::npos)
      << screen;
}

TEST(LiveScreen, ShowsWhatSlowsTheServer) {
  Live live;
  live.notice = "12 ticks left out";
  EXPECT_NE(LiveScreen(live).find("NOTICE: 12 ticks left out"), std::string::npos);
  EXPECT_NE(LiveLine(live).find("NOTICE: 12 ticks left out"), std::string::npos);
  EXPECT_EQ(LiveToJson(live, 1)["notice"], "12 ticks left out");
}

TEST(SessionTable, ShowsWhoWaitsAndHowManyMoreThereAre) {
  stream::ServerStats stats;
  EXPECT_EQ(SessionTable(stats), "");
  stats.uptime_s = 12;
  stats.ticks = {1200, 99.96, 0.0031, 2, 0};
  stats.session_count = 3;
  stats.sessions.push_back({7, "footing-view", "view", true, 5, "drop_oldest", 4, 256, 0.04, 480, 9,
                            0, true, 0.0001, 0.00005});
  stats.sessions.push_back({});
  stream::ServerStats busy;
  busy.session_count = 1;
  busy.ticks_dropped = 1;
  busy.slowed = 2;
  EXPECT_EQ(ServerLine(busy),
            "up 0 s, 0.0 ticks per second, max delay 0.0 ms, 1 session, 1 tick dropped (queue "
            "full), 2 rate-limit waits");
  EXPECT_EQ(ServerLine(stats),
            "up 12 s, 100.0 ticks per second, max delay 3.1 ms, 3 sessions, 2 overruns");
  EXPECT_EQ(SessionTable(stats),
            "session  client        role  policy       queue  lag ms  sent  dropped  clock ms\n"
            "      7  footing-view  view  drop_oldest  4/256    40.0   480        9  0.10 +-0.05\n"
            "      0                      -            0/0       0.0     0        0  -\n"
            "not shown: 1 that lag less\n");
  const auto json = ServerStatsToJson(stats);
  EXPECT_EQ(json["sessions"][0]["lag_s"], 0.04);
  EXPECT_EQ(json["sessions"][0]["clock_offset_s"], 0.0001);
  EXPECT_TRUE(json["sessions"][1]["clock_offset_s"].is_null());
}

TEST(LiveLine, OfALostServerShowsWhyAndNoOldNumbers) {
  Live live = LiveBoard();
  live.lost = true;
  live.link = "waiting for unix:/s: footingd is being stopped";
  EXPECT_EQ(LiveLine(live), live.link);
}

TEST(LiveLine, NamesEveryDeviceInOneLine) {
  EXPECT_EQ(LiveLine(LiveBoard()),
            "2 main/left_board live 61.2 Hz, jitter 5.0 ms, gaps 0, repeats 18.7 %, battery "
            "12 % LOW, 33.8 kg");
}

TEST(LiveJson, CountsSamplesAndGivesTheNewest) {
  const auto out = LiveToJson(LiveBoard(), 2.5);
  EXPECT_EQ(out["seconds"], 2.5);
  EXPECT_EQ(out["devices"][0]["samples"], 1);
  EXPECT_DOUBLE_EQ(out["devices"][0]["board"]["top_left_kg"], 20);
  EXPECT_NEAR(out["devices"][0]["board"]["cop_x_mm"], -45.6, 1e-9);
}

TEST(LiveJson, CountsAGamepadsSamplesWhereItHasNoMotion) {
  Live live;
  live.devices.resize(1);
  live.devices[0].device = 1;
  stream::GamepadSample gamepad;
  gamepad.device = 1;
  gamepad.buttons = stream::kGamepadB;
  live.Take(gamepad);
  live.Take(gamepad);
  auto one = LiveToJson(live, 1)["devices"][0];
  EXPECT_EQ(one["samples"], 2);
  EXPECT_EQ(one["gamepad"]["buttons"], 2);
  stream::MotionSample motion;
  motion.device = 1;
  live.Take(motion);  // A Classic Controller on a Wiimote: its motion is counted.
  live.Take(gamepad);
  one = LiveToJson(live, 1)["devices"][0];
  EXPECT_EQ(one["samples"], 3);
}

}  // namespace
}  // namespace footing::ctl::display

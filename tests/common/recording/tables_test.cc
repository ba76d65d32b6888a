#include "common/recording/bids_tables.h"

#include <gmock/gmock.h>

#include <limits>

namespace footing::bids {
namespace {

using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Two channels and the time, at 50 Hz.
MotionTable TwoChannels(int rows) {
  MotionTable table{"lefthand",
                    "wiimote",
                    {{"latency", "n/a", "LATENCY", "n/a", "s"},
                     {"accel_x", "x", "ACCEL", "left_hand", "m/s^2"},
                     {"gyro_x", "x", "GYRO", "left_hand", "rad/s"}},
                    {}};
  for (int i = 0; i < rows; ++i) {
    table.cells.insert(table.cells.end(), {1 + 0.02 * i, -9.81, i == 0 ? kNan : 0.5});
  }
  return table;
}

TEST(Bids, TablesAreTabSeparatedWithNothingThatBreaksALine) {
  EXPECT_EQ(Tsv({{"a", ""}, {"tab\there", "line\r\nend"}}), "a\tn/a\ntab here\tline  end\n");
}

TEST(Bids, MotionHasNoHeaderAndAColumnForEachChannel) {
  const MotionTable table = TwoChannels(3);
  EXPECT_THAT(MotionTsv(table), testing::StartsWith("1.000000\t-9.810000\tn/a\n1.020000\t"));
  EXPECT_NEAR(SamplingRateHz(table), 50, 1e-9);  // Two intervals in 0.04 s.
  EXPECT_EQ(SamplingRateHz(TwoChannels(1)), 0);
  EXPECT_THAT(ChannelsTsv(table), HasSubstr("accel_x\tx\tACCEL\tleft_hand\tm/s^2\t50.000\n"));
  const auto json = MotionJson(table, "wriststraight1", "wrist, track straight");
  EXPECT_EQ(json["MotionChannelCount"], 3);
  EXPECT_EQ(json["ACCELChannelCount"], 1);
  EXPECT_EQ(json["TrackedPointsCount"], 1);
  EXPECT_EQ(json["TrackingSystemName"], "lefthand");
}

TEST(Bids, EventsSayWhichFailuresCount) {
  EXPECT_EQ(EventsTsv({{1.5, "failure_jump", false}, {2, "task_done", true}}),
            "onset\tduration\ttrial_type\tcounts\n"
            "1.500\t0\tfailure_jump\tno\n2.000\t0\ttask_done\tyes\n");
}

TEST(Bids, MarkersHaveTheirTextAsTypeAndAPairOfThemIsASpan) {
  const auto marker = [](double onset_s, const std::string& text) {
    Event event{onset_s, text, true};
    event.is_marker = true;
    return event;
  };
  std::vector<Event> events = {{0.5, "trial_ready", true}, marker(1, "begin eyes closed"),
                               marker(2, "stimulus"),      marker(31.5, "end eyes closed"),
                               marker(32, "end unknown"),  marker(33, "begin second")};
  events[2].value = 3.5;
  EXPECT_EQ(EventsTsv(WithSpans(events)),
            "onset\tduration\ttrial_type\tcounts\tvalue\n"
            "0.500\t0\ttrial_ready\tyes\tn/a\n"
            "1.000\t30.500\teyes closed\tyes\tn/a\n"
            "2.000\t0\tstimulus\tyes\t3.5\n"
            "32.000\t0\tend unknown\tyes\tn/a\n"
            "33.000\t0\tbegin second\tyes\tn/a\n");
}

TEST(Bids, LabelsHaveLettersAndDigitsAndInstantsCountFrom1900) {
  EXPECT_EQ(LabelOf("wrist.straight1"), "wriststraight1");
  EXPECT_EQ(ShiftedTime(0), "1900-01-01T00:00:00");
  EXPECT_EQ(ShiftedTime(90.9), "1900-01-01T00:01:30");
  EXPECT_EQ(ShiftedTime(31 * 86400.0), "1900-02-01T00:00:00");
}

}  // namespace
}  // namespace footing::bids

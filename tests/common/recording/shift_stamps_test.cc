#include "common/recording/shift_stamps.h"

#include <gtest/gtest.h>

#include <limits>

#include "footing/v1/session.pb.h"

namespace footing::playback {
namespace {

TEST(ShiftStamps, MovesEveryInstantOfTheServersClockAndNothingElse) {
  v1::Tick tick;
  tick.set_host_ns(100);
  tick.set_sequence(7);
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_received_ns(90);
  sample.set_sampled_ns(80);
  v1::RawReport& raw = *tick.mutable_raw()->add_reports();
  raw.set_received_ns(90);
  raw.set_true_ns(5);
  v1::SetupItem& item = *tick.mutable_setup()->add_rigs()->add_items();
  item.set_wall_time_ns(11);
  v1::Event& event = *tick.mutable_events()->add_events();
  event.mutable_response()->set_command_ns(70);
  v1::Tick moved = tick;
  ShiftStamps(moved, 1000);
  EXPECT_EQ(moved.host_ns(), 1100);
  EXPECT_EQ(moved.motion().samples(0).received_ns(), 1090);
  EXPECT_EQ(moved.motion().samples(0).sampled_ns(), 1080);
  EXPECT_EQ(moved.raw().reports(0).received_ns(), 1090);
  EXPECT_EQ(moved.raw().reports(0).true_ns(), 5);
  EXPECT_EQ(moved.setup().rigs(0).items(0).wall_time_ns(), 11);
  EXPECT_EQ(moved.events().events(0).response().command_ns(), 1070);
  EXPECT_EQ(moved.events().events(0).host_ns(), 0);  // Unknown stays unknown.
  ShiftStamps(moved, -1000);
  EXPECT_EQ(moved.SerializeAsString(), tick.SerializeAsString());
}

TEST(ShiftStamps, LeavesWhatNoClockComesTo) {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  v1::Tick tick;
  tick.set_host_ns(kEnd);
  tick.mutable_motion()->add_samples()->set_received_ns(-kEnd);
  tick.mutable_motion()->mutable_samples(0)->set_sampled_ns(80);
  ShiftStamps(tick, 1000);
  EXPECT_EQ(tick.host_ns(), kEnd);
  EXPECT_EQ(tick.motion().samples(0).received_ns(), -kEnd);
  EXPECT_EQ(tick.motion().samples(0).sampled_ns(), 1080);
}

}  // namespace
}  // namespace footing::playback

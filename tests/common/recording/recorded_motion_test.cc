#include "common/recording/recorded_motion.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "footing/v1/session.pb.h"
#include "tests/common/made_recording.h"
#include "tests/common/temporary_folder.h"

namespace footing::bids {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kSecondNs = 1'000'000'000;

v1::Tick TickAt(std::uint64_t sequence, std::int64_t host_ns) {
  v1::Tick tick;
  tick.set_sequence(sequence);
  tick.set_host_ns(host_ns);
  return tick;
}

void AddDevice(std::uint32_t number, v1::DeviceRole role, v1::Tick& tick) {
  v1::DeviceStatus& status = *tick.mutable_status()->add_devices();
  status.set_device(number);
  status.set_role(role);
  status.set_kind(v1::DEVICE_KIND_WIIMOTE);
}

void AddMotion(std::uint32_t device, std::int64_t sampled_ns, double z, v1::Tick& tick) {
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_device(device);
  sample.set_sampled_ns(sampled_ns);
  sample.mutable_specific_force_mps2()->set_z(z);
}

v1::Character& AddCharacter(const std::string& trial, v1::Tick& tick) {
  v1::Character& character = *tick.mutable_characters()->add_characters();
  character.mutable_trial()->set_trial(trial);
  return character;
}

/// Both servers begin at the same wall time, the simulation's clock 50 s later. A hand with a role
/// and one without, one sample a second from 10 s on; the trial "t1" from 12 s on, a fall at 13 s.
void WriteTrial(const std::string& path) {
  test::MadeRecording recording(path);
  recording.Begin("footingd", 10 * kSecondNs, 1000 * kSecondNs);
  for (int i = 0; i < 5; ++i) {
    v1::Tick tick = TickAt(static_cast<std::uint64_t>(i) + 1, (10 + i) * kSecondNs);
    AddDevice(1, v1::DEVICE_ROLE_LEFT_HAND, tick);
    AddDevice(2, v1::DEVICE_ROLE_UNSPECIFIED, tick);
    AddMotion(1, tick.host_ns(), -9.5 - i, tick);
    AddMotion(2, tick.host_ns(), 1, tick);
    recording.Add(tick);
  }
  recording.Begin("footing-sim", 60 * kSecondNs, 1000 * kSecondNs);
  for (int i = 0; i < 5; ++i) {
    v1::Tick tick = TickAt(static_cast<std::uint64_t>(i) + 1, (60 + i) * kSecondNs);
    AddCharacter(i < 2 ? "" : "t1", tick).mutable_trial()->set_distance_m(i);
    if (i == 3) {
      v1::Event& fall = *tick.mutable_events()->add_events();
      fall.set_kind(v1::Event::KIND_FALL);
      fall.set_host_ns(tick.host_ns() + kSecondNs / 4);
      fall.mutable_failure()->set_number(7);
    }
    recording.Add(tick);
  }
}

/// A marker of a client, with the time of its sender: 1 s before the tick.
void AddMarker(v1::Tick& tick) {
  v1::Event& marker = *tick.mutable_events()->add_events();
  marker.set_kind(v1::Event::KIND_MARKER);
  marker.set_host_ns(tick.host_ns() - kSecondNs);
  marker.set_text("stimulus");
  marker.mutable_marker()->set_value(4);
}

std::vector<std::string> SystemsOf(const RecordedMotion& motion) {
  std::vector<std::string> names;
  for (const MotionTable& table : motion.tables) names.push_back(table.tracksys);
  return names;
}

/// The column of a table, by its channel.
std::vector<double> ColumnOf(const MotionTable& table, const std::string& channel) {
  const auto at = std::find_if(table.channels.begin(), table.channels.end(),
                               [&](const Channel& one) { return one.name == channel; });
  if (at == table.channels.end()) return {};
  std::vector<double> column;
  for (auto i = static_cast<std::size_t>(at - table.channels.begin()); i < table.cells.size();
       i += table.channels.size()) {
    column.push_back(table.cells[i]);
  }
  return column;
}

class ReadMotionTest : public testing::Test {
 protected:
  Result<RecordedMotion> Read(const Choice& choice) {
    const auto session = recording::RecordedSession::Open(folder_.Path("a.mcap"));
    if (!session) return session.error();
    return ReadMotion(*session, choice);
  }
  test::TemporaryFolder folder_;
};

TEST_F(ReadMotionTest, MarkersOfAnyServerAreEventsByTimeWhereTheyAreWanted) {
  {
    test::MadeRecording recording(folder_.Path("a.mcap"));
    recording.Begin("footing-sim", 60 * kSecondNs, 1000 * kSecondNs);
    v1::Tick tick = TickAt(1, 60 * kSecondNs);
    AddCharacter("", tick);
    recording.Add(tick);
    tick = TickAt(2, 62 * kSecondNs);
    v1::Event& fall = *tick.mutable_events()->add_events();
    fall.set_kind(v1::Event::KIND_FALL);
    fall.set_host_ns(tick.host_ns());
    recording.Add(tick);
    recording.Begin("footingd", 10 * kSecondNs, 1000 * kSecondNs);
    tick = TickAt(1, 12 * kSecondNs);
    AddMarker(tick);
    recording.Add(tick);
  }
  const auto with = Read({.markers = true});
  ASSERT_TRUE(with.ok()) << with.error().message;
  ASSERT_EQ(with->events.size(), 2u);
  EXPECT_EQ(with->events[0].trial_type, "stimulus");
  EXPECT_EQ(with->events[0].onset_s, 1);
  EXPECT_EQ(with->events[0].value, 4);
  EXPECT_EQ(with->events[1].onset_s, 2);
  const auto without = Read({});  // As of a study, whose export names nobody.
  ASSERT_EQ(without->events.size(), 1u);
  EXPECT_FALSE(without->events[0].is_marker);
}

TEST_F(ReadMotionTest, AWholeRecordingBeginsAtItsFirstTickWithEveryDevice) {
  WriteTrial(folder_.Path("a.mcap"));
  const auto motion = Read({});
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  ASSERT_THAT(SystemsOf(*motion), ElementsAre("sim", "lefthand", "wiimote2"));
  EXPECT_THAT(ColumnOf(motion->tables[0], "latency"), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(ColumnOf(motion->tables[1], "accel_z"),
              ElementsAre(-9.5, -10.5, -11.5, -12.5, -13.5));
  EXPECT_TRUE(std::isnan(ColumnOf(motion->tables[1], "gyro_x").at(0)));  // It has none.
  ASSERT_EQ(motion->events.size(), 1u);
  EXPECT_EQ(motion->events[0].onset_s, 3.25);
  EXPECT_TRUE(motion->events[0].counts);
}

TEST_F(ReadMotionTest, ATrialBeginsAtItsFirstFrameWithTheDevicesThatHaveARole) {
  WriteTrial(folder_.Path("a.mcap"));
  const auto motion = Read({"t1", {7}, true});
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  ASSERT_THAT(SystemsOf(*motion), ElementsAre("sim", "lefthand"));
  EXPECT_THAT(ColumnOf(motion->tables[0], "distance"), ElementsAre(2, 3, 4));
  EXPECT_THAT(ColumnOf(motion->tables[1], "latency"), ElementsAre(0, 1, 2));
  EXPECT_EQ(motion->events.at(0).onset_s, 1.25);
  EXPECT_FALSE(motion->events.at(0).counts);
  const auto other = Read({"t2", {}, true});
  ASSERT_FALSE(other.ok());
  EXPECT_THAT(other.error().message, HasSubstr("no frame of trial t2"));
}

TEST_F(ReadMotionTest, TimesThatNoClockHasAreRefusedOrLeftOut) {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max();
  {
    test::MadeRecording recording(folder_.Path("a.mcap"));
    recording.Begin("footingd");
    v1::Tick tick = TickAt(1, kSecondNs);
    AddDevice(1, v1::DEVICE_ROLE_LEFT_HAND, tick);
    for (const std::int64_t sampled_ns : {kEnd, -kEnd, kSecondNs})
      AddMotion(1, sampled_ns, 1, tick);
    recording.Add(tick);
  }
  const auto motion = Read({});
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  EXPECT_THAT(ColumnOf(motion->tables.at(0), "latency"), ElementsAre(0));
  {
    test::MadeRecording recording(folder_.Path("a.mcap"));
    recording.Begin("footingd", -kEnd, kEnd);
    v1::Tick tick = TickAt(1, kSecondNs);
    AddDevice(1, v1::DEVICE_ROLE_LEFT_HAND, tick);
    recording.Add(tick);
  }
  EXPECT_EQ(Read({}).error().kind, ErrorKind::kInvalidData);
}

TEST_F(ReadMotionTest, RolesOfTwoRigsStayApartAndAHandThatIsNotSeenHasNoPlace) {
  {
    test::MadeRecording recording(folder_.Path("a.mcap"));
    recording.Begin("footingd");
    v1::Tick tick = TickAt(1, kSecondNs);
    for (const char* rig : {"main", "guest"}) {
      v1::HandSample& hand = *tick.mutable_hands()->add_samples();
      hand.set_rig(rig);
      hand.set_role(v1::DEVICE_ROLE_LEFT_HAND);
      hand.set_confidence(hand.rig() == "main" ? 0.5 : 0);
      hand.mutable_position_m()->set_z(1.5);
    }
    recording.Add(tick);
  }
  const auto motion = Read({});
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  ASSERT_THAT(SystemsOf(*motion), ElementsAre("guestlefthandtracked", "lefthandtracked"));
  EXPECT_TRUE(std::isnan(ColumnOf(motion->tables[0], "position_z").at(0)));
  EXPECT_THAT(ColumnOf(motion->tables[1], "position_z"), ElementsAre(1.5));
}

TEST_F(ReadMotionTest, AReconstructedBodyHasItsJointsFromTheTPoseOn) {
  {
    test::MadeRecording recording(folder_.Path("a.mcap"));
    recording.Begin("footing-sim");
    for (int i = 0; i < 4; ++i) {
      v1::Tick tick = TickAt(static_cast<std::uint64_t>(i) + 1, i * kSecondNs);
      if (i == 0) {
        v1::Skeleton& skeleton = *tick.mutable_skeletons()->add_skeletons();
        for (const char* name : {"hips", "left_knee"}) skeleton.add_links()->set_name(name);
      }
      v1::Character& character = AddCharacter("", tick);
      character.set_valid(i != 2);
      character.mutable_body()->set_calibrated(i > 0);
      for (int link = 0; link < 2; ++link) {
        v1::LinkPose& pose = *character.add_links();
        pose.mutable_position_m()->set_z(i + 0.1 * link);
        pose.mutable_orientation()->set_w(1);
      }
      recording.Add(tick);
    }
  }
  const auto motion = Read({});
  ASSERT_TRUE(motion.ok()) << motion.error().message;
  ASSERT_THAT(SystemsOf(*motion), ElementsAre("body"));
  const MotionTable& body = motion->tables[0];
  EXPECT_THAT(ColumnOf(body, "latency"), ElementsAre(1, 2, 3));
  EXPECT_THAT(ColumnOf(body, "left_knee_z"), ElementsAre(1.1, 2.1, 3.1));
  EXPECT_THAT(ColumnOf(body, "hips_quat_w"), ElementsAre(1, 1, 1));
  EXPECT_THAT(ColumnOf(body, "valid"), ElementsAre(1, 0, 1));
}

TEST_F(ReadMotionTest, TwoPeopleOfOneRecordingAreNotOneTable) {
  {
    test::MadeRecording recording(folder_.Path("a.mcap"));
    recording.Begin("footing-sim");
    for (int i = 0; i < 4; ++i) {
      v1::Tick tick = TickAt(static_cast<std::uint64_t>(i) + 1, i * kSecondNs);
      if (i == 0) tick.mutable_skeletons()->add_skeletons()->add_links()->set_name("hips");
      v1::Character& character = AddCharacter("", tick);
      character.mutable_body()->set_calibrated(true);
      character.mutable_body()->set_subject(i < 2 ? "p07" : "p08");
      character.add_links()->mutable_orientation()->set_w(1);
      recording.Add(tick);
    }
  }
  const auto motion = Read({});
  ASSERT_FALSE(motion.ok());
  EXPECT_EQ(motion.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(motion.error().message, testing::HasSubstr("p07 and p08"));
}

}  // namespace
}  // namespace footing::bids

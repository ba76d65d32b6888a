#include "clients/log/commands.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "common/recording/recorded_session.h"
#include "footing/v1/session.pb.h"
#include "tests/clients/log/sample_recording.h"
#include "tests/clients/log/temporary_folder.h"
#include "tests/common/made_recording.h"

namespace footing::log_client {
namespace {

using testing::HasSubstr;

class RecalibrateTest : public TemporaryFolder {};

/// A camera that was not calibrated, and a skeleton's tracker beside it.
void WriteHands(const std::string& path) {
  test::MadeRecording recording(path);
  recording.Begin("footingd");
  v1::Tick tick;
  tick.set_sequence(1);
  tick.set_host_ns(10'000'000);
  for (const char* tracker : {"camera", "kinect"}) {
    v1::HandSample& sample = *tick.mutable_hands()->add_samples();
    sample.set_tracker(tracker);
    sample.set_confidence(1);
    sample.mutable_position_m()->set_z(1.5);
    sample.mutable_sd_m()->set_x(0.001);
    sample.mutable_sd_m()->set_y(0.002);
    sample.mutable_sd_m()->set_z(0.004);
    if (sample.tracker() == "camera") sample.mutable_tracker_pose()->set_qw(1);
  }
  tick.mutable_motion()->add_samples()->set_device(3);
  recording.Add(tick);
}

/// At (2, 0, 1), looking along -x: its z is W's -x.
Eigen::Isometry3d FacingThePerson() {
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear() << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  X_WC.translation() << 2, 0, 1;
  return X_WC;
}

TEST_F(RecalibrateTest, HandsGoWhereTheNewCalibrationPutsThem) {
  WriteHands(Path("a.mcap"));
  const auto report =
      Recalibrate(Path("a.mcap"), Path("b.mcap"), "camera", FacingThePerson(), "t", false);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_EQ(report->samples, 1u);
  EXPECT_EQ(report->untouched, 1u);
  const auto session = recording::RecordedSession::Open(Path("b.mcap"));
  ASSERT_TRUE(session.ok()) << session.error().message;
  const auto& ticks = session->servers().at(0).ticks;
  ASSERT_EQ(ticks.size(), 1u);
  v1::HandSamples hands;
  for (const auto& channel : ticks[0].channels) {
    if (channel.field != v1::Tick::kHandsFieldNumber) continue;
    ASSERT_TRUE(hands.ParseFromString(std::string(channel.bytes)));
  }
  ASSERT_EQ(hands.samples_size(), 2);
  EXPECT_NEAR(hands.samples(0).position_m().x(), 0.5, 1e-12);  // 2 less 1.5 of depth.
  EXPECT_NEAR(hands.samples(0).position_m().z(), 1, 1e-12);
  EXPECT_NEAR(hands.samples(0).sd_m().x(), 0.004, 1e-12);
  EXPECT_NEAR(hands.samples(0).tracker_pose().x_m(), 2, 1e-12);
  EXPECT_EQ(hands.samples(1).position_m().z(), 1.5);
  EXPECT_EQ(ticks[0].channels.size(), 2u);  // The motion is still there.
}

TEST_F(RecalibrateTest, RefusesARecordingWithoutSuchHands) {
  WriteSampleRecording(Path("a.mcap"), true);
  const auto none =
      Recalibrate(Path("a.mcap"), Path("b.mcap"), "camera", FacingThePerson(), "t", false);
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("no hands of the tracker \"camera\""));
  EXPECT_FALSE(std::filesystem::exists(Path("b.mcap")));
  std::ofstream(Path("b.mcap")) << "an older one";
  EXPECT_FALSE(
      Recalibrate(Path("a.mcap"), Path("b.mcap"), "camera", FacingThePerson(), "t", true).ok());
  EXPECT_EQ(std::filesystem::file_size(Path("b.mcap")), 12u) << "nothing to put in its place";
  EXPECT_FALSE(
      Recalibrate(Path("a.mcap"), Path("a.mcap"), "camera", FacingThePerson(), "t", true).ok());
}

}  // namespace
}  // namespace footing::log_client

#include "clients/view/app/recorded_show.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "clients/view/scene/text.h"
#include "tests/clients/view/made_recording.h"
#include "tests/common/temporary_folder.h"

namespace footing::view {
namespace {

using ::testing::HasSubstr;

class RecordedShowTest : public ::testing::Test {
 protected:
  RecordedShow Open(const made::RecordingWish& wish) {
    made::WriteRecording(path_, wish);
    return Reopen();
  }
  RecordedShow Reopen() {
    auto recording = OpenForPlayback(path_);
    FOOTING_CHECK(recording.ok());
    auto marks = ReadMarks(*recording);
    FOOTING_CHECK(marks.ok());
    return {std::move(*recording), std::move(*marks)};
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_.Path("made.mcap");
};

void ExpectSameStrip(const scene::Strip& a, const scene::Strip& b, const std::string& what) {
  ASSERT_EQ(a.points().size(), b.points().size()) << what;
  for (std::size_t i = 0; i < a.points().size(); ++i) {
    EXPECT_EQ(a.points()[i].time_ns, b.points()[i].time_ns) << what << " " << i;
    EXPECT_EQ(a.points()[i].value, b.points()[i].value) << what << " " << i;
    // How the first one was reached lies before what is shown.
    EXPECT_TRUE(i == 0 || a.points()[i].joined == b.points()[i].joined) << what << " " << i;
  }
}

void ExpectSameStrips(const scene::StripSet& a, const scene::StripSet& b) {
  EXPECT_EQ(a.newest_ns, b.newest_ns);
  ASSERT_EQ(a.devices.size(), b.devices.size());
  for (const auto& [key, strips] : a.devices) {
    const scene::DeviceStrips& other = b.devices.at(key);
    EXPECT_EQ(strips.role, other.role);
    EXPECT_EQ(strips.simulated, other.simulated);
    ExpectSameStrip(strips.magnitude_mps2, other.magnitude_mps2, "magnitude");
    ExpectSameStrip(strips.moving, other.moving, "moving");
    ExpectSameStrip(strips.frequency_hz, other.frequency_hz, "frequency");
    ExpectSameStrip(strips.roll_rad, other.roll_rad, "roll");
  }
  ASSERT_EQ(a.phases_rad.size(), b.phases_rad.size());
  for (const auto& [rig, strip] : a.phases_rad) {
    ExpectSameStrip(strip, b.phases_rad.at(rig), "phase");
  }
}

void ExpectSameModel(const scene::Model& a, const scene::Model& b, std::int64_t now_ns) {
  ExpectSameStrips(a.strips, b.strips);
  ASSERT_EQ(a.boards.size(), b.boards.size());
  for (const auto& [key, board] : a.boards) {
    EXPECT_EQ(board.newest_ns, b.boards.at(key).newest_ns);
    ASSERT_EQ(board.points.size(), b.boards.at(key).points.size());
    EXPECT_EQ(board.points.back().x_m, b.boards.at(key).points.back().x_m);
  }
  EXPECT_EQ(a.newest_host_ns, b.newest_host_ns);
  EXPECT_EQ(a.phases, b.phases);
  ASSERT_EQ(a.phase_spans.size(), b.phase_spans.size());
  for (std::size_t i = 1; i < a.phase_spans.size(); ++i) {
    EXPECT_EQ(a.phase_spans[i].phase, b.phase_spans[i].phase);
    EXPECT_EQ(a.phase_spans[i].start_ns, b.phase_spans[i].start_ns);
  }
  EXPECT_EQ(a.track.segments.size(), b.track.segments.size());
  ASSERT_EQ(a.last.note.has_value(), b.last.note.has_value());
  EXPECT_EQ(a.last.note.value_or(scene::Note{}).text, b.last.note.value_or(scene::Note{}).text);
  EXPECT_EQ(a.last.note.value_or(scene::Note{}).received_ns,
            b.last.note.value_or(scene::Note{}).received_ns);
  ASSERT_EQ(a.last.response.has_value(), b.last.response.has_value());
  EXPECT_EQ(a.last.response.value_or(scene::Note{}).host_ns,
            b.last.response.value_or(scene::Note{}).host_ns);
  // Devices, links, character, trial, last event: all that text shows but the latencies so far.
  const auto screen = [now_ns](const scene::Model& model) {
    auto lines = scene::StatusScreen(model, now_ns);
    std::erase_if(lines, [](const std::string& line) { return line.rfind("Latency", 0) == 0; });
    return lines;
  };
  EXPECT_EQ(screen(a), screen(b));
  EXPECT_EQ(scene::AgeMs(a, now_ns), scene::AgeMs(b, now_ns));
}

void ExpectSameParts(const std::vector<scene::Part>& a, const std::vector<scene::Part>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((a[i].X_WP - b[i].X_WP).cwiseAbs().maxCoeff(), 1e-5f) << i;
  }
}

void ExpectSamePicture(const scene::Show::Shot& a, const scene::Show::Shot& b) {
  EXPECT_EQ(a.frame.time_s, b.frame.time_s);
  ASSERT_EQ(a.frame.characters.size(), b.frame.characters.size());
  for (std::size_t i = 0; i < a.frame.characters.size(); ++i) {
    EXPECT_EQ(a.frame.characters[i].com_m, b.frame.characters[i].com_m);
  }
  // A micrometre: what 12 s have left of where the filters began.
  EXPECT_LT((a.picture.camera.eye_m - b.picture.camera.eye_m).norm(), 1e-6);
  EXPECT_LT((a.picture.camera.target_m - b.picture.camera.target_m).norm(), 1e-6);
  ExpectSameParts(a.picture.figures.balls, b.picture.figures.balls);
  ExpectSameParts(a.picture.figures.rods, b.picture.figures.rods);
  ExpectSameParts(a.picture.figures.limbs, b.picture.figures.limbs);
}

/// Plays one to the position in uneven steps, seeks to it with the other, and compares.
void ExpectSeekEqualsPlay(RecordedShow& played, RecordedShow& sought, double at_s) {
  SCOPED_TRACE("at " + std::to_string(at_s) + " s");
  const std::int64_t from_ns = played.TimeOf(0), to_ns = played.TimeOf(at_s);
  for (std::int64_t now_ns = from_ns; now_ns < to_ns; now_ns += 37'000'123) played.At(now_ns, {});
  const scene::Show::Shot a = played.At(to_ns, {});
  const scene::Show::Shot b = sought.At(to_ns, {});
  ExpectSamePicture(a, b);
  ExpectSameModel(a.past, b.past, to_ns);
}

TEST_F(RecordedShowTest, SeekingShowsWhatPlayingToThatTimeShows) {
  RecordedShow played = Open({}), sought = Reopen();
  // Among these are seeks ahead and back, into a gait and right behind falls.
  for (const double at_s : {45.0, 56.0, 58.123, 30.05, 21.5, 5.0, 0.0, 42.5}) {
    ExpectSeekEqualsPlay(played, sought, at_s);
  }
}

TEST_F(RecordedShowTest, WhatHasCeasedStandsStillAlsoBehindASeek) {
  RecordedShow played = Open({60, 22.0, 25.0, true}), sought = Reopen();
  EXPECT_NEAR(sought.timeline().end_s, 24.99, 1e-9);
  ExpectSeekEqualsPlay(played, sought, 24.5);

  RecordedShow without = Open({60, 15.0, 1e9, true}), sought_without = Reopen();
  ExpectSeekEqualsPlay(without, sought_without, 55);
  EXPECT_EQ(sought_without.model().strips.devices.size(), 2u);
  EXPECT_EQ(sought_without.model().links[1].state, scene::LinkState::kStale);
  EXPECT_EQ(sought_without.model().links[0].state, scene::LinkState::kLive);
}

TEST_F(RecordedShowTest, AFigureThatStandsStillIsShownBehindASeek) {
  RecordedShow played = Open({60, 1e9, 20.5, true}), sought = Reopen();
  ExpectSeekEqualsPlay(played, sought, 50);
  EXPECT_NEAR(sought.At(sought.TimeOf(50), {}).frame.time_s, 20.49, 1e-9);
}

TEST_F(RecordedShowTest, SmallStepsAheadAreNotSeeks) {
  RecordedShow show = Open({});
  show.At(show.TimeOf(30), {});
  const std::uint64_t frames = show.model().tally.frames();
  show.At(show.TimeOf(30.5), {});
  EXPECT_EQ(show.model().tally.frames(), frames + 50);
}

TEST_F(RecordedShowTest, AnotherTrackVersionTellsTheRendererOfEachSeek) {
  RecordedShow show = Open({});
  show.At(show.TimeOf(30), {});
  const std::uint64_t version = show.model().track_version;
  show.At(show.TimeOf(10), {});
  EXPECT_GT(show.model().track_version, version);
  EXPECT_FALSE(show.model().track.segments.empty());
}

TEST_F(RecordedShowTest, LatenciesAreThoseThatTheRecorderMeasured) {
  RecordedShow show = Open({});
  show.At(show.TimeOf(20), {});
  EXPECT_NEAR(show.model().tally.publish_to_view.QuantileMs(0.5), 2, 1e-9);
}

TEST_F(RecordedShowTest, FallsAreShownAgainWhereAsked) {
  RecordedShow show = Open({});
  show.ReplayFalls();
  show.At(show.TimeOf(29), {});
  show.At(show.TimeOf(31.5), {});
  EXPECT_TRUE(show.model().replay.At(show.TimeOf(33)).has_value());
}

TEST_F(RecordedShowTest, MarksAreThoseOfTheEvents) {
  const RecordedShow show = Open({});
  const timeline::Timeline& line = show.timeline();
  EXPECT_NEAR(line.end_s, 60, 1e-9);
  ASSERT_EQ(line.trials.size(), 2u);
  EXPECT_EQ(line.trials[0].id, "p07-1");
  EXPECT_EQ(line.trials[0].track, "straight");
  EXPECT_NEAR(line.trials[0].begin_s, 5, 1e-9);
  EXPECT_NEAR(line.trials[0].start_s.value_or(0), 6, 1e-9);
  EXPECT_NEAR(line.trials[0].end_s.value_or(0), 50, 1e-9);
  EXPECT_EQ(line.trials[0].phase, stream::TrialPhase::kFinished);
  EXPECT_NEAR(line.trials[0].time_s, 44, 1e-9);
  EXPECT_EQ(line.trials[1].id, "p07-2");
  EXPECT_FALSE(line.trials[1].start_s);
  ASSERT_EQ(line.failures.size(), 2u);
  EXPECT_NEAR(line.failures[0].at_s, 30, 1e-9);
  EXPECT_EQ(line.failures[0].cause, stream::FailureCause::kCurve);
  EXPECT_NEAR(line.failures[0].trial_time_s, 24, 1e-9);
  EXPECT_FALSE(line.failures[0].withdrawn);
  EXPECT_EQ(line.failures[1].cause, stream::FailureCause::kJump);
  EXPECT_TRUE(line.failures[1].withdrawn);
  ASSERT_EQ(line.tasks.size(), 1u);
  EXPECT_NEAR(line.tasks[0].at_s, 35, 1e-9);
}

TEST_F(RecordedShowTest, ARecordingWithoutTrialsHasNoMarks) {
  const RecordedShow show = Open({10, 1e9, 1e9, false});
  EXPECT_TRUE(show.timeline().trials.empty());
  EXPECT_TRUE(show.timeline().failures.empty());
  EXPECT_NEAR(show.timeline().end_s, 10, 1e-9);
}

TEST_F(RecordedShowTest, ACutRecordingPlaysAsFarAsItGoesAndSaysSo) {
  made::WriteRecording(path_, {});
  std::ifstream whole(path_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes.substr(0, bytes.size() / 2);
  RecordedShow show = Reopen();
  EXPECT_THAT(show.recording().Limits(), HasSubstr("footing-log repair " + path_));
  EXPECT_THAT(show.recording().Limits(), HasSubstr("cut at byte"));
  EXPECT_GT(show.timeline().end_s, 20);
  EXPECT_LT(show.timeline().end_s, 40);
  const double at_s = 19;
  const scene::Show::Shot shot = show.At(show.TimeOf(at_s), {});
  EXPECT_NEAR(shot.frame.time_s, at_s, 0.021);
  ASSERT_EQ(show.timeline().trials.size(), 1u);
  EXPECT_FALSE(show.timeline().trials[0].end_s);
}

TEST_F(RecordedShowTest, WhatIsNoRecordingIsRefused) {
  std::ofstream(path_) << "nothing";
  const auto nothing = OpenForPlayback(path_);
  ASSERT_FALSE(nothing.ok());
  EXPECT_EQ(nothing.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(nothing.error().message, HasSubstr(path_));
}

}  // namespace
}  // namespace footing::view

#include "clients/view/app/recorded_show.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "common/base/units.h"
#include "common/recording/recording_writer.h"
#include "common/wire/wire.h"
#include "tests/common/temporary_folder.h"

namespace footing::view {
namespace {

using stream::TrialPhase;

/// Events of one server, written where a case needs them.
class RecordedMarksTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto created = recording::RecordingWriter::Create(path_, {"test", true, {}});
    ASSERT_TRUE(created.ok());
    writer_.emplace(std::move(*created));
  }
  static stream::TrialState StateOf(const std::string& id, TrialPhase phase, double clock_s) {
    stream::TrialState state;
    state.trial = id;
    state.number = id.empty() ? 0 : 1;
    state.track = "straight";
    state.finish_m = 60;
    state.progress.phase = phase;
    state.progress.time_s = clock_s;
    return state;
  }
  void Write(const std::string& topic, const google::protobuf::Message& message, double time_s) {
    const std::int64_t at_ns = RoundToNanoseconds(time_s);
    ASSERT_TRUE(writer_->Write("/footing-sim/" + topic, message, {at_ns, at_ns, ++sequence_}));
  }
  void Trial(double time_s, const std::string& id, TrialPhase phase, double clock_s = 0) {
    v1::Events events;
    v1::Event& event = *events.add_events();
    event.set_kind(v1::Event::KIND_TRIAL);
    event.set_host_ns(RoundToNanoseconds(time_s));
    *event.mutable_trial() = wire::ToProto(StateOf(id, phase, clock_s));
    Write("events", events, time_s);
  }
  void Frame(double time_s, const std::string& id, TrialPhase phase, double clock_s = 0) {
    v1::CharacterFrame frame;
    *frame.add_characters()->mutable_trial() = wire::ToProto(StateOf(id, phase, clock_s));
    Write("characters", frame, time_s);
  }
  Result<RecordedMarks> Marks() {
    EXPECT_TRUE(writer_->Finish());
    auto recording = OpenForPlayback(path_);
    EXPECT_TRUE(recording.ok());
    return ReadMarks(*recording);
  }
  timeline::Timeline Read() {
    const auto marks = Marks();
    EXPECT_TRUE(marks.ok());
    return marks->timeline;
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_.Path("marks.mcap");
  std::optional<recording::RecordingWriter> writer_;
  std::uint32_t sequence_ = 0;
};

TEST_F(RecordedMarksTest, MarkersOfBothServersAreMarksAndFrameATrial) {
  const auto mark = [this](const std::string& server, double time_s, const std::string& text) {
    v1::Events events;
    v1::Event& event = *events.add_events();
    event.set_kind(v1::Event::KIND_MARKER);
    event.set_host_ns(RoundToNanoseconds(time_s - 0.25));  // The sender's time.
    event.set_text(text);
    if (text == "stimulus") event.mutable_marker()->set_value(7);
    const std::int64_t at_ns = RoundToNanoseconds(time_s);
    ASSERT_TRUE(writer_->Write("/" + server + "/events", events, {at_ns, at_ns, ++sequence_}));
  };
  mark("footing-sim", 3, "begin sway");
  mark("footingd", 4, "stimulus");
  mark("footing-sim", 9, "end sway");
  const auto marks = Marks();
  ASSERT_TRUE(marks.ok());
  const timeline::Timeline& line = marks->timeline;
  ASSERT_EQ(line.markers.size(), 3u);
  EXPECT_EQ(line.markers[1].text, "stimulus");
  EXPECT_EQ(line.markers[1].value, 7);
  EXPECT_EQ(line.markers[1].at_s, 0.75);  // From the first tick, at 3 s.
  ASSERT_EQ(line.trials.size(), 1u);
  EXPECT_EQ(line.trials[0].id, "sway");
  EXPECT_EQ(line.trials[0].time_s, 6);
  EXPECT_TRUE(std::is_sorted(marks->notes_ns.begin(), marks->notes_ns.end()));
}

TEST_F(RecordedMarksTest, WhatElseAPersonShouldReadIsAnEvent) {
  v1::Events events;
  const auto add = [&events](v1::Event::Kind kind, double at_s, const std::string& text) {
    v1::Event& event = *events.add_events();
    event.set_kind(kind);
    event.set_host_ns(RoundToNanoseconds(at_s));
    event.set_text(text);
  };
  // As a recording of a person has them; the last four are no marks.
  add(v1::Event::KIND_STREAM_BACK, 2, "both boards are there");
  add(v1::Event::KIND_COMMAND, 9, "T-pose taken: 71.2 kg");
  add(v1::Event::KIND_STREAM_LOST, 7, "a board is lost: the pose coasts");
  add(v1::Event::KIND_GAIT_CHANGED, 3, "gait changed: run to walk");
  add(v1::Event::KIND_RESPONSE, 3, "response");
  add(v1::Event::KIND_PUT_BACK, 4, "put back");
  add(v1::Event::KIND_COMMAND, 4, "");
  Write("events", events, 1);
  const timeline::Timeline line = Read();
  ASSERT_EQ(line.events.size(), 3u);
  EXPECT_DOUBLE_EQ(line.events[0].at_s, 1);  // From the first tick, at 1 s.
  EXPECT_EQ(line.events[1].text, "a board is lost: the pose coasts");
  EXPECT_EQ(line.events[2].text, "T-pose taken: 71.2 kg");
  // Without failures the keys for them go to these.
  EXPECT_DOUBLE_EQ(timeline::NextFailure(line, 1).value_or(0), 6);
  EXPECT_DOUBLE_EQ(timeline::PreviousFailure(line, 8).value_or(0), 6);
}

TEST_F(RecordedMarksTest, ARestartedServerBeginsAnotherTrialOfTheSameName) {
  Trial(0, "p07", TrialPhase::kReady);
  Trial(2, "p07", TrialPhase::kRunning);
  // Killed while the trial ran; the next server counts from 1 again.
  Trial(20, "p07", TrialPhase::kReady);
  Trial(23, "p07", TrialPhase::kRunning);
  Trial(30, "p07", TrialPhase::kFinished, 7);
  const timeline::Timeline line = Read();
  ASSERT_EQ(line.trials.size(), 2u);
  EXPECT_DOUBLE_EQ(line.trials[0].begin_s, 0);
  EXPECT_DOUBLE_EQ(line.trials[0].start_s.value_or(0), 2);
  EXPECT_FALSE(line.trials[0].end_s);
  EXPECT_DOUBLE_EQ(line.trials[1].begin_s, 20);
  EXPECT_DOUBLE_EQ(line.trials[1].start_s.value_or(0), 23);
  EXPECT_DOUBLE_EQ(line.trials[1].end_s.value_or(0), 30);
}

TEST_F(RecordedMarksTest, ATrialWithoutAReadyEventBeginsWhereItRuns) {
  // The trial that a server begins with has no event of its own before the start line.
  Trial(1, "", TrialPhase::kRunning);
  Trial(10, "", TrialPhase::kFinished, 9);
  Trial(21, "", TrialPhase::kRunning);
  Trial(35, "", TrialPhase::kFinished, 14);
  const timeline::Timeline line = Read();
  ASSERT_EQ(line.trials.size(), 2u);
  EXPECT_DOUBLE_EQ(line.trials[0].end_s.value_or(0), 9);
  EXPECT_DOUBLE_EQ(line.trials[0].time_s, 9);
  EXPECT_DOUBLE_EQ(line.trials[1].start_s.value_or(0), 20);
  EXPECT_DOUBLE_EQ(line.trials[1].end_s.value_or(0), 34);
}

TEST_F(RecordedMarksTest, TheFirstFrameAndTheReadyEventAreOneTrial) {
  Frame(0, "p07", TrialPhase::kReady);
  Trial(0.02, "p07", TrialPhase::kReady);
  Trial(2, "p07", TrialPhase::kRunning);
  Frame(3, "p07", TrialPhase::kRunning, 1);
  const timeline::Timeline line = Read();
  ASSERT_EQ(line.trials.size(), 1u);
  EXPECT_DOUBLE_EQ(line.trials[0].begin_s, 0);
  EXPECT_DOUBLE_EQ(line.trials[0].start_s.value_or(0), 2);
}

TEST_F(RecordedMarksTest, ATrialThatWasOverBeforeTheRecordingIsNoneOfIt) {
  // A study records each trial alone; its first frame still has the trial before.
  Frame(0, "p06", TrialPhase::kFinished, 40);
  Trial(1, "p07", TrialPhase::kReady);
  Trial(2, "p07", TrialPhase::kRunning);
  Trial(9, "p07", TrialPhase::kFinished, 7);
  Frame(10, "p07", TrialPhase::kFinished, 7);
  const timeline::Timeline line = Read();
  ASSERT_EQ(line.trials.size(), 1U);
  EXPECT_EQ(line.trials[0].id, "p07");
  EXPECT_EQ(line.trials[0].end_s, 9);
}

TEST_F(RecordedMarksTest, TheLimitHoldsWithinOneTick) {
  v1::Events events;
  for (std::size_t k = 0; k <= timeline::kMostMarks; ++k) {
    events.add_events()->set_kind(v1::Event::KIND_FALL);
  }
  Write("events", events, 0);
  const auto marks = Marks();
  ASSERT_FALSE(marks.ok());
  EXPECT_EQ(marks.error().kind, ErrorKind::kInvalidData);
}

TEST_F(RecordedMarksTest, EventsAtImpossibleTimesHaveNoMarks) {
  v1::Events events;
  for (const std::int64_t at_ns : {std::int64_t{0}, std::numeric_limits<std::int64_t>::min(),
                                   std::numeric_limits<std::int64_t>::max()}) {
    v1::Event& event = *events.add_events();
    event.set_kind(v1::Event::KIND_FALL);
    event.set_host_ns(at_ns);
  }
  Write("events", events, 0);
  EXPECT_EQ(Read().failures.size(), 1u);
}

}  // namespace
}  // namespace footing::view

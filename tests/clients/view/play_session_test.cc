#include "clients/view/app/play_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "clients/view/app/play_summary.h"
#include "tests/clients/view/made_recording.h"
#include "tests/common/temporary_folder.h"

namespace footing::view {
namespace {

using ::testing::HasSubstr;

/// One made recording for all cases: see made_recording.h for what happens in it.
class PlaySessionTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    path_ = folder_->Path("made.mcap");
    made::WriteRecording(path_, {});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static PlayOptions Wish(const std::string& trial = "", const std::string& beside = "") {
    PlayOptions options;
    options.recording = path_;
    options.trial = trial;
    options.beside = beside;
    return options;
  }

  inline static std::unique_ptr<test::TemporaryFolder> folder_;
  inline static std::string path_;
};

TEST_F(PlaySessionTest, AWholeRecordingBeginsAtItsFirstTick) {
  auto session = PlaySession::Open(Wish(), false);
  ASSERT_TRUE(session.ok()) << session.error().message;
  ASSERT_EQ(session->sides().size(), 1u);
  EXPECT_EQ(session->head().at_s, 0);
  EXPECT_NEAR(session->head().end_s, 60, 1e-6);
  EXPECT_EQ(session->timeline().failures.size(), 2u);
}

TEST_F(PlaySessionTest, OneTrialHasItsStartLineAtZero) {
  PlayOptions wish = Wish("p07-1");
  wish.from_s = 30;
  wish.speed = 0.5;
  auto session = PlaySession::Open(wish, false);
  ASSERT_TRUE(session.ok()) << session.error().message;
  EXPECT_NEAR(session->timeline().begin_s, -1, 1e-6);
  EXPECT_NEAR(session->timeline().end_s, 46, 1e-6);
  EXPECT_EQ(session->head().at_s, 30);
  EXPECT_EQ(session->head().speed, 0.5);
  // 30 s behind the start line are 36 s of the recording.
  EXPECT_EQ(session->ClockOf(session->sides()[0]), made::kFirstNs + 36'000'000'000);
  EXPECT_NEAR(session->ShotOf(session->sides()[0], {}).frame.time_s, 36, 0.021);
}

TEST_F(PlaySessionTest, TwoTrialsShareOneTimelineAndTheShorterStaysAtItsEnd) {
  auto session = PlaySession::Open(Wish("p07-1", path_ + ":p07-2"), false);
  ASSERT_TRUE(session.ok()) << session.error().message;
  ASSERT_EQ(session->sides().size(), 2u);
  // The second one, which never starts, is ready for the recording's last 5 s.
  EXPECT_NEAR(session->timeline().begin_s, -1, 1e-6);
  EXPECT_NEAR(session->timeline().end_s, 46, 1e-6);
  session->head() = timeline::Sought(session->head(), 20);
  PlayedSide& second = session->sides()[1];
  EXPECT_TRUE(session->StateOf(second).finished);
  EXPECT_FALSE(session->StateOf(session->sides()[0]).finished);
  EXPECT_NEAR(session->ShotOf(second, {}).frame.time_s, 60, 0.021);
  session->head() = timeline::Sought(session->head(), -0.5);
  EXPECT_TRUE(session->StateOf(second).before);
}

TEST_F(PlaySessionTest, WithoutANameTheFirstTrialsAreCompared) {
  PlayOptions wish = Wish("", path_);
  wish.alignment = timeline::Alignment::kFinish;
  auto session = PlaySession::Open(wish, false);
  ASSERT_TRUE(session.ok()) << session.error().message;
  EXPECT_NEAR(session->timeline().begin_s, -45, 1e-6);
  EXPECT_NEAR(session->timeline().end_s, 2, 1e-6);
  EXPECT_THAT(session->sides()[1].name, HasSubstr("p07-1"));
}

TEST_F(PlaySessionTest, WhatIsNotThereIsAUsageError) {
  PlayOptions late = Wish();
  late.from_s = 61;
  PlayOptions no_end = Wish("p07-1", path_ + ":p07-2");
  no_end.alignment = timeline::Alignment::kFinish;
  for (const PlayOptions& wish : {Wish("p08"), Wish("p07-1", path_ + ":p08"), late, no_end}) {
    const auto session = PlaySession::Open(wish, false);
    ASSERT_FALSE(session.ok());
    EXPECT_EQ(session.error().kind, ErrorKind::kUsage) << session.error().message;
  }
  EXPECT_THAT(PlaySession::Open(Wish("p08"), false).error().message, HasSubstr("p07-1 (#1)"));
  EXPECT_FALSE(AlignmentNamed("noon").ok());
}

TEST_F(PlaySessionTest, ANameWithAColonIsAFileWhereThereIsOne) {
  const std::string with_colon = folder_->Path("a:b");
  std::filesystem::copy_file(path_, with_colon);
  EXPECT_EQ(SplitTrial(with_colon).file, with_colon);
  EXPECT_EQ(SplitTrial(with_colon + ":p07-1").file, with_colon);
  EXPECT_EQ(SplitTrial(with_colon + ":p07-1").trial, "p07-1");
  EXPECT_EQ(SplitTrial(path_).trial, "");
}

TEST_F(PlaySessionTest, TheSummarySaysWhereItStandsAndWhatThereIs) {
  auto session = PlaySession::Open(Wish("p07-1", path_ + ":p07-2"), false);
  ASSERT_TRUE(session.ok());
  session->head() = timeline::Sought(session->head(), 40);
  for (PlayedSide& side : session->sides()) session->ShotOf(side, {});
  const auto summary = nlohmann::json::parse(PlaySummary(*session, 1));
  const auto& playback = summary["playback"];
  EXPECT_EQ(playback["position_s"], 40);
  EXPECT_EQ(playback["trial"], "p07-1");
  EXPECT_EQ(playback["trials"][0]["phase"], "finished");
  EXPECT_EQ(playback["trials"][0]["failures"]["curve"], 1);
  EXPECT_EQ(playback["trials"][0]["failures"]["jump"], 0);
  ASSERT_EQ(playback["failures"].size(), 2u);
  EXPECT_NEAR(playback["failures"][1]["at_s"], 36, 1e-6);
  EXPECT_EQ(playback["failures"][1]["withdrawn"], true);
  EXPECT_EQ(playback["limits"], "");
  EXPECT_EQ(summary["trial"]["failures"]["curve"], 1);
  EXPECT_EQ(summary["beside"]["playback"]["ended"], true);
  EXPECT_TRUE(summary["beside"]["playback"]["trials"][0]["start_s"].is_null());
  EXPECT_THAT(PlayLine(*session), HasSubstr("0:40.0 of 0:46.0"));
  EXPECT_THAT(PlayScreenText(*session)[2], "trial p07-1   failed attempts 1 (curve 1)");
}

}  // namespace
}  // namespace footing::view

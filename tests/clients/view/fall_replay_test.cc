#include "clients/view/scene/model.h"

#include <gtest/gtest.h>

#include "clients/view/scene/stage.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kHz = 100;
constexpr double kSpeedMps = 2;
constexpr double kFallS = 8;
constexpr double kPutBackS = 8.7;

/// Runs at 2 m/s, falls at 8 s, lies, and is put back 3 m behind at 8.7 s.
WorldFrame FrameAt(double time_s) {
  WorldFrame frame;
  frame.time_s = time_s;
  frame.characters.resize(1);
  CharacterPose& pose = frame.characters[0];
  pose.valid = true;
  pose.com_m.x() = kSpeedMps * std::min(time_s, kFallS);
  if (time_s >= kFallS) pose.gait.falls = 1;
  if (time_s >= kPutBackS) pose.com_m.x() -= 3;
  return frame;
}

FallReplay After(double seconds) {
  FallReplay replay;
  for (int i = 0; i <= static_cast<int>(seconds * kHz + 0.5); ++i) replay.Push(FrameAt(i / kHz));
  return replay;
}

constexpr std::int64_t kNowNs = 77 * kNanosecondsPerSecond;

TEST(FallReplay, IsReadyOnceTheCharacterIsPutBack) {
  EXPECT_FALSE(After(7.9).ready());
  EXPECT_FALSE(After(8.6).ready());
  EXPECT_TRUE(After(8.7).ready());
  EXPECT_EQ(After(20).clips(), 1u);
}

TEST(FallReplay, RunsFromFiveSecondsBeforeTheFallToThePutBackAtAQuarterOfThePace) {
  FallReplay replay = After(9);
  EXPECT_FALSE(replay.At(kNowNs));
  replay.Start(kNowNs);
  ASSERT_TRUE(replay.At(kNowNs));
  EXPECT_NEAR(replay.At(kNowNs)->time_s, kFallS - FallReplay::kBeforeS, 1.5 / kHz);
  EXPECT_NEAR(replay.FromFallS(kNowNs), -5, 1.5 / kHz);
  const std::int64_t fall_ns = kNowNs + SecondsToNanoseconds(5 / FallReplay::kPace);
  EXPECT_NEAR(replay.At(fall_ns)->time_s, kFallS, 1.5 / kHz);
  EXPECT_NEAR(replay.At(fall_ns)->characters[0].com_m.x(), kSpeedMps * kFallS, 0.05);
  EXPECT_TRUE(replay.At(fall_ns + SecondsToNanoseconds(0.6 / FallReplay::kPace)));
  EXPECT_FALSE(replay.At(fall_ns + SecondsToNanoseconds(0.75 / FallReplay::kPace)));
}

TEST(FallReplay, ShowsPicturesBetweenTheFramesThatCame) {
  FallReplay replay = After(9);
  replay.Start(kNowNs);
  const double first_m = replay.At(kNowNs + 4'000'000)->characters[0].com_m.x();
  const double then_m = replay.At(kNowNs + 8'000'000)->characters[0].com_m.x();
  EXPECT_NEAR(then_m - first_m, kSpeedMps * 0.001, 1e-9);
}

TEST(FallReplay, AnEarlyFallStartsWithTheFirstFrame) {
  FallReplay replay;
  for (int i = 700; i <= 900; ++i) replay.Push(FrameAt(i / kHz));
  replay.Start(kNowNs);
  EXPECT_NEAR(replay.At(kNowNs)->time_s, 7, 1e-9);
}

TEST(FallReplay, AServerStartedAnewForgetsTheFall) {
  FallReplay replay = After(9);
  replay.Push(FrameAt(0));
  EXPECT_FALSE(replay.ready());
}

TEST(Show, ShowsTheLastFallAgainWhenAskedAndThenGoesOnLive) {
  Show show;
  std::int64_t now_ns = kNowNs;
  const auto run = [&](double from_s, double to_s) {
    for (int i = static_cast<int>(from_s * kHz); i <= static_cast<int>(to_s * kHz); ++i) {
      Update update;
      update.frame = FrameAt(i / kHz);
      update.received_ns = now_ns = kNowNs + SecondsToNanoseconds(i / kHz);
      show.Take(update, now_ns);
      show.At(now_ns, false, {});
    }
  };
  run(0, 10);
  show.ToggleReplay(now_ns);
  EXPECT_NEAR(show.At(now_ns, false, {}).frame.time_s, 3, 0.02);
  show.ToggleReplay(now_ns);
  EXPECT_NEAR(show.At(now_ns, false, {}).frame.time_s, 10, 0.02);
}

TEST(Show, MayShowEveryFallAgainByItself) {
  Show show;
  show.ReplayFalls();
  WorldFrame shown;
  for (int i = 0; i <= 900; ++i) {
    Update update;
    update.frame = FrameAt(i / kHz);
    update.received_ns = kNowNs + SecondsToNanoseconds(i / kHz);
    show.Take(update, update.received_ns);
    shown = show.At(update.received_ns, false, {}).frame;
  }
  // The put-back was 0.3 s ago: 0.075 s of the clip.
  EXPECT_NEAR(shown.time_s, 3.075, 0.02);
}

}  // namespace
}  // namespace footing::scene

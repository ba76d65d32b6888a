#include "daemon/sensor/kinds/ps_move.h"

#include <gtest/gtest.h>

namespace footing::ps_move {
namespace {

using reports::MoveModel;
using stream::CalibrationOrigin;

constexpr std::int64_t kMs = 1'000'000;

TEST(PsMoveCalibration, ARefusedCalibrationEndsLiveWithDefaultsAndSaysWhatToDo) {
  CalibrationHandshake move(MoveModel::kZcm1, {});
  int asked = 0;
  for (std::int64_t ms = 0; ms < 3000; ms += 10) {
    if (!move.WantsFeature(ms * kMs)) continue;
    ++asked;
    EXPECT_FALSE(move.TakeFeature({}));
  }
  EXPECT_EQ(asked, CalibrationHandshake::kMaxRefusals);
  EXPECT_TRUE(move.live());
  EXPECT_EQ(move.calibration().origin, CalibrationOrigin::kDefaults);
  EXPECT_NE(move.calibration().problem.find("USB"), std::string::npos);
}

TEST(PsMoveCalibration, AnUnansweredCalibrationEndsLiveWithinTwoSeconds) {
  CalibrationHandshake move(MoveModel::kZcm2, {});
  for (std::int64_t ms = 0; ms < 2000; ms += 10) (void)move.WantsFeature(ms * kMs);
  EXPECT_TRUE(move.live());
}

TEST(PsMoveCalibration, AStoredBlobThatMakesNoSenseIsAskedForAgain) {
  CalibrationHandshake move(MoveModel::kZcm1, std::vector<std::uint8_t>(20, 0));
  EXPECT_FALSE(move.live());
  EXPECT_TRUE(move.WantsFeature(0));
}

TEST(PsMoveCalibration, TheSphereIsRepeatedInTimeAndNeverTooFast) {
  CalibrationHandshake move(MoveModel::kZcm1, {});
  move.set_sphere(0xff8000);
  std::vector<std::int64_t> sent_ms;
  for (std::int64_t ms = 0; ms < 20'000; ++ms) {
    if (ms > 10'000 && ms < 15'000) move.set_sphere(static_cast<std::uint32_t>(ms));  // Every ms.
    if (move.NextOutput(ms * kMs, false)) sent_ms.push_back(ms);
  }
  ASSERT_GT(sent_ms.size(), 10u);
  for (std::size_t i = 1; i < sent_ms.size(); ++i) {
    EXPECT_GE(sent_ms[i] - sent_ms[i - 1], 120);
    EXPECT_LE(sent_ms[i] - sent_ms[i - 1], 4000);
  }
}

TEST(PsMoveCalibration, ADarkMoveAtRestIsLeftInPeace) {
  CalibrationHandshake move(MoveModel::kZcm1, {});
  int sent = 0;
  for (std::int64_t ms = 0; ms < 20'000; ms += 10) sent += move.NextOutput(ms * kMs, false) ? 1 : 0;
  EXPECT_EQ(sent, 1);
  EXPECT_TRUE(move.NextOutput(20'000 * kMs, true));  // Rumble is in the same report.
}

}  // namespace
}  // namespace footing::ps_move

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/offline/eval/features.h"
#include "daemon/offline/eval/replay.h"
#include "tests/clients/stream/virtual_line.h"

/// Real recordings: shaken stretches move, still and slowly tilted ones do not.
namespace footing::eval {
namespace {

/// The files name no rate; footing-eval assumes the same (see daemon/offline/eval/features.cc).
constexpr double kRateHz = 50;
constexpr double kLongestFalseMotionS = 0.3;

struct Stretch {
  std::string file;
  std::size_t first = 0;
  std::size_t last = 0;
  std::string kind;
};

std::vector<Stretch> Labels() {
  std::ifstream file(std::string(FOOTING_SOURCE_DIR) + "/tests/recordings/wiimote_grt.labels");
  std::vector<Stretch> stretches;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    Stretch stretch;
    fields >> stretch.file >> stretch.first >> stretch.last >> stretch.kind;
    EXPECT_TRUE(fields) << line;
    stretches.push_back(stretch);
  }
  return stretches;
}

/// Moving or not at every row; each class of the file is a recording of its own.
std::vector<bool> MovingRows(const GrtRecording& recording) {
  std::vector<bool> moving;
  Chain chain(false);
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const auto& row = recording.rows[i];
    if (i > 0 && row.stretch != recording.rows[i - 1].stretch) chain = Chain(false);
    const auto now_ns = static_cast<std::int64_t>(1e9 / kRateHz) * static_cast<std::int64_t>(i);
    chain.Add(kLeftDevice, now_ns, row.specific_force_mps2);
    moving.push_back(chain.Compute(now_ns).devices[0].moving);
  }
  return moving;
}

double LongestMotionSeconds(const std::vector<bool>& moving, const Stretch& stretch) {
  std::size_t longest = 0;
  std::size_t run = 0;
  for (std::size_t i = stretch.first; i <= stretch.last; ++i) {
    run = moving[i] ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return static_cast<double>(longest) / kRateHz;
}

class Recordings : public testing::TestWithParam<const char*> {};

TEST_P(Recordings, ShakenStretchesMoveAndStillOrTiltedOnesDoNot) {
  const char* data = std::getenv("FOOTING_TEST_DATA");
  if (data == nullptr || *data == '\0') GTEST_SKIP() << "FOOTING_TEST_DATA names no folder";
  const auto recording =
      ReadGrt(std::string(data) + "/devices/wiimote_grt/" + std::string(GetParam()));
  ASSERT_TRUE(recording) << recording.error().message;
  const auto moving = MovingRows(*recording);
  int checked = 0;
  for (const Stretch& stretch : Labels()) {
    if (stretch.file != GetParam()) continue;
    ASSERT_LT(stretch.last, moving.size());
    ++checked;
    if (stretch.kind == "shaken") {
      const auto count =
          std::count(moving.begin() + static_cast<std::ptrdiff_t>(stretch.first),
                     moving.begin() + static_cast<std::ptrdiff_t>(stretch.last) + 1, true);
      EXPECT_GE(static_cast<double>(count),
                0.98 * static_cast<double>(stretch.last - stretch.first + 1))
          << stretch.first;
    } else {
      EXPECT_LE(LongestMotionSeconds(moving, stretch), kLongestFalseMotionS) << stretch.first;
    }
  }
  EXPECT_GE(checked, 5);
}

INSTANTIATE_TEST_SUITE_P(WiimoteGrt, Recordings,
                         testing::Values("WiiAccShakeData.grt", "acc-orientation.grt"));

TEST(RecordedFeatures, AreReplayedByTheMethodThatMadeThem) {
  sensor::Config paper;
  paper.features = "paper";
  std::vector<stream_client::SimulatedDevice> devices;
  devices.emplace_back(
      virtual_devices::Wiimote(4),
      [](double t_s) {
        virtual_devices::WiimoteSensors felt;
        felt.specific_force_S_mps2.x() = 8 * std::sin(2 * kPi * 1.5 * t_s);
        return felt;
      },
      stream::DeviceRole::kLeftHand,
      virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, 2));
  auto ticks = stream_client::VirtualLine(std::move(devices), paper).Run(4);
  const FeaturesReplay same = ReplayFeatures(ticks);
  EXPECT_GT(same.compared, 300u);
  EXPECT_EQ(same.equal, same.compared);
  for (v1::Tick& tick : ticks) tick.clear_config();
  const FeaturesReplay ours = ReplayFeatures(ticks);
  EXPECT_EQ(ours.compared, same.compared);
  EXPECT_LT(ours.equal, ours.compared);
}

TEST(Decisions, AreCountedForBothFeaturesByTheGaitThatWasMeant) {
  const auto ours = MeasureDecisions(2, 3), printed = MeasureDecisions(2, 3, features::AsPrinted());
  // Our features have settled 2.5 s after a change whatever the gaits were.
  EXPECT_EQ(ours["settled"]["right_share"], 1);
  EXPECT_LT(ours["all"]["right_share"], 1);
  for (const auto& one : {ours, printed}) {
    const auto& all = one["all"];
    EXPECT_GT(one["settled"]["right_share"], 0.9);
    EXPECT_NEAR(all["right_share"].get<double>() + all["wrong_share"].get<double>() +
                    all["none_share"].get<double>(),
                1, 1e-9);
    int ticks = 0;  // 2 trials of 8 stretches of 4 s at 100 Hz.
    for (const auto& meant : all["ticks_by_meant_and_found"]) {
      for (const auto& found : meant) ticks += found.get<int>();
    }
    EXPECT_NEAR(ticks, 6400, 2);
  }
  EXPECT_NE(ours["all"], printed["all"]);
}

}  // namespace
}  // namespace footing::eval

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "common/virtual/devices/noise.h"
#include "daemon/offline/learning/time_alignment.h"

namespace footing::learning {
namespace {

constexpr double kWeightN = 700;

/// Standing on both feet for so long.
ForceTrace Standing(double seconds) {
  ForceTrace trace;
  trace.weight_n = kWeightN;
  trace.load_n.setConstant(2, static_cast<Eigen::Index>(seconds * trace.rate_hz), kWeightN / 2);
  trace.valid.assign(static_cast<std::size_t>(trace.load_n.cols()), true);
  return trace;
}

/// The right foot is off the ground for half a second and comes down at `time_s` with a push of
/// `over` weights that is 60 ms wide.
void AddStomp(double time_s, double over, ForceTrace& trace) {
  for (Eigen::Index i = 0; i < trace.load_n.cols(); ++i) {
    const double t_s = static_cast<double>(i) / trace.rate_hz - time_s;
    if (t_s > -0.55 && t_s < -0.05) trace.load_n.col(i) << kWeightN, 0;
    trace.load_n(1, i) += over * kWeightN * std::exp(-0.5 * t_s * t_s / (0.025 * 0.025));
  }
}

TEST(FindStomps, FindsEachStompAtItsPush) {
  ForceTrace trace = Standing(20);
  for (const double time_s : {5.0, 6.1, 7.8}) AddStomp(time_s, 1.0, trace);
  const auto stomps = FindStomps(trace);
  ASSERT_EQ(stomps.size(), 3u);
  EXPECT_NEAR(stomps[0].time_s, 5.0, 0.011);
  EXPECT_NEAR(stomps[1].time_s, 6.1, 0.011);
  EXPECT_NEAR(stomps[2].time_s, 7.8, 0.011);
}

TEST(FindStomps, APushOfAStandingBodyIsNone) {
  // GIVEN a squat's push with both feet on the ground, short enough to be a stomp's.
  ForceTrace trace = Standing(10);
  for (Eigen::Index i = 500; i < 520; ++i)
    trace.load_n.col(i) *= 1 + 0.6 * std::sin(std::numbers::pi * static_cast<double>(i - 500) / 20);
  EXPECT_TRUE(FindStomps(trace).empty());
}

TEST(FindStomps, ALongPushAndAWeakOneAreNone) {
  ForceTrace trace = Standing(20);
  AddStomp(5, 0.05, trace);
  AddStomp(10, 0, trace);
  for (Eigen::Index i = 1000; i < 1080; ++i) trace.load_n.col(i) *= 1.4;
  EXPECT_TRUE(FindStomps(trace).empty());
}

TEST(FindStomps, WhereNothingWasMeasuredThereIsNone) {
  ForceTrace trace = Standing(10);
  AddStomp(5, 1, trace);
  trace.valid[490] = false;
  EXPECT_TRUE(FindStomps(trace).empty());
}

constexpr double kTimeAlignmentWeightN = 700;

/// Somebody who bends the knees without a rule, steps from foot to foot and stomps: forces at any
/// time of the motion's clock.
struct Mover {
  std::vector<double> stomps_s;
  std::uint64_t seed = 1;
  struct Wave {
    double f_hz, phase;
  };
  std::vector<Wave> waves = Waves(seed);

  static std::vector<Wave> Waves(std::uint64_t seed) {
    noise::Random random(seed);
    std::vector<Wave> waves;
    for (int i = 0; i < 12; ++i) {
      const double f_hz = 0.2 * std::pow(15, (i + random.Uniform()) / 12);
      waves.push_back({f_hz, random.Uniform()});
    }
    return waves;
  }

  struct Loads {
    double left_n, right_n;
  };
  Loads At(double time_s) const {
    double total = 1;
    for (const Wave& wave : waves) {
      total += 0.02 * std::sin(2 * std::numbers::pi * (wave.f_hz * time_s + wave.phase));
    }
    double right = 0.5;
    for (const double stomp_s : stomps_s) {
      const double t_s = time_s - stomp_s;
      if (t_s > -0.55 && t_s < -0.03) right = 0;
      total += 0.6 * std::exp(-0.5 * t_s * t_s / (0.03 * 0.03));
    }
    return {kTimeAlignmentWeightN * total * (1 - right), kTimeAlignmentWeightN * total * right};
  }
};

/// A motion's trace: `seconds` from time 0 on, 120 a second.
ForceTrace Moved(const Mover& mover, double seconds) {
  ForceTrace trace;
  trace.name = "me.bvh";
  trace.rate_hz = 120;
  trace.weight_n = kTimeAlignmentWeightN;
  trace.load_n.resize(2, static_cast<Eigen::Index>(seconds * trace.rate_hz));
  trace.valid.assign(static_cast<std::size_t>(trace.load_n.cols()), true);
  for (Eigen::Index i = 0; i < trace.load_n.cols(); ++i) {
    const auto loads = mover.At(static_cast<double>(i) / trace.rate_hz);
    trace.load_n.col(i) << loads.left_n, loads.right_n;
  }
  return trace;
}

/// Recording of the motion by two boards: each reports every 8 to 14 ms at instants of its own,
/// stamped by a clock that is estimated within 1.5 ms, with 0.1 kg of noise on a cell:
/// recording = offset + (1 + drift) motion.
ForceTrace Recorded(const Mover& mover, double seconds, double offset_s, double drift,
                    std::optional<std::pair<double, double>> silence_s = std::nullopt) {
  RecordedSession session;
  session.name = "me.mcap";
  session.duration_s = seconds;
  noise::Random random(77);
  for (std::size_t side = 0; side < 2; ++side) {
    double last_s = -1;
    for (double t_s = 0; t_s < seconds; t_s += random.Uniform(0.008, 0.014)) {
      const double stamp_s = std::max(last_s + 1e-4, t_s + 0.0015 * random.Normal());
      last_s = stamp_s;
      if (silence_s && t_s > silence_s->first && t_s < silence_s->second) continue;
      const auto loads = mover.At((t_s - offset_s) / (1 + drift));
      const double load_n = side == 0 ? loads.left_n : loads.right_n;
      BoardReading reading{stamp_s, {}};
      for (double& corner_n : reading.corners_n) corner_n = load_n / 4 + 0.98 * random.Normal();
      session.boards[side].push_back(reading);
    }
  }
  return TraceOf(session, kTimeAlignmentWeightN);
}

/// The greatest error of the motion's time on the recording's clock.
double WorstS(const TimeAlignment& at, double offset_s, double drift, double seconds) {
  const auto off = [&](double t_s) {
    return std::abs(at.ToRecording(t_s) - (offset_s + (1 + drift) * t_s));
  };
  return std::max(off(0), off(seconds));
}

TEST(AlignInTime, FindsOffsetAndDriftUnderTheBoardsTiming) {
  // GIVEN five minutes, begun 3.417 s after the motion capture, by a clock 40 ppm faster.
  const Mover mover{{12.0, 13.1, 14.8}};
  const auto at = AlignInTime(Recorded(mover, 290, -3.417, 40e-6), Moved(mover, 300));
  ASSERT_TRUE(at) << at.error().message;
  EXPECT_LT(WorstS(*at, -3.417, 40e-6, 290), 0.002);
  EXPECT_NEAR(at->drift, 40e-6, 8e-6);
  EXPECT_LT(at->residual_s, 0.003);
  EXPECT_GT(at->pieces, 60);
  EXPECT_GT(at->correlation, 0.97);
  EXPECT_EQ(at->stomps_both, 3);
  EXPECT_EQ(at->stomps_recording, 3);
}

TEST(AlignInTime, OtherImpactsOfEitherDoNotMatter) {
  // GIVEN stomps all over the recording, which begins earlier and goes on longer, a few of them as
  // the three that are in the motion.
  Mover mover{{20.0, 21.1, 22.8}};
  const ForceTrace moved = Moved(mover, 60);
  for (const double extra_s : {-30.0, -28.9, -27.2, -20.0, -18.5, 70.0, 71.1, 72.8, 80.0, 90.0}) {
    mover.stomps_s.push_back(extra_s);
  }
  const auto at = AlignInTime(Recorded(mover, 140, 40, 0), moved);
  ASSERT_TRUE(at) << at.error().message;
  EXPECT_LT(WorstS(*at, 40, 0, 60), 0.003);
  EXPECT_EQ(at->stomps_recording, 13);
  EXPECT_EQ(at->stomps_motion, 3);
  EXPECT_EQ(at->stomps_both, 3);
}

TEST(AlignInTime, JoggingInPlaceIsFoundAmongItsManyFalseOffsets) {
  // GIVEN two minutes of steps 0.8 s apart, by two hundredths more or less: any offset by whole
  // steps lets most of them go together.
  Mover mover;
  noise::Random random(5);
  for (double t_s = 3; t_s < 117; t_s += 0.8 + 0.02 * random.Normal())
    mover.stomps_s.push_back(t_s);
  const auto at = AlignInTime(Recorded(mover, 90, -20, 0), Moved(mover, 120));
  ASSERT_TRUE(at) << at.error().message;
  EXPECT_LT(WorstS(*at, -20, 0, 120), 0.003);
  EXPECT_GT(at->stomps_both, 100);
}

TEST(AlignInTime, ABoardThatFallsSilentLeavesTheRest) {
  const Mover mover{{12.0, 13.1, 14.8}};
  const auto at =
      AlignInTime(Recorded(mover, 100, -1, 0, std::pair(30.0, 50.0)), Moved(mover, 100));
  ASSERT_TRUE(at) << at.error().message;
  EXPECT_LT(WorstS(*at, -1, 0, 100), 0.003);
  EXPECT_NEAR(at->overlap_s, 79, 1);
}

TEST(AlignInTime, AShortRecordingIsNotGivenADriftThatItCannotTell) {
  const Mover mover{{5.0, 6.1, 7.8}};
  const auto at = AlignInTime(Recorded(mover, 14, -1, 0), Moved(mover, 15));
  ASSERT_TRUE(at) << at.error().message;
  EXPECT_LT(std::abs(at->drift), 2 * kDriftSd);
  EXPECT_LT(WorstS(*at, -1, 0, 15), 0.005);
}

void ExpectRefused(const Result<TimeAlignment>& at, const std::string& file,
                   const std::string& words) {
  ASSERT_FALSE(at);
  EXPECT_EQ(at.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(at.error().message.find(file), std::string::npos) << at.error().message;
  EXPECT_NE(at.error().message.find(words), std::string::npos) << at.error().message;
}

TEST(AlignInTime, FewerThanThreeStompsAreAnErrorThatSaysWhere) {
  const Mover three{{5.0, 6.1, 7.8}}, two{{5.0, 6.1}};
  ExpectRefused(AlignInTime(Recorded(two, 30, -1, 0), Moved(three, 30)), "me.mcap",
                "2 stomps found in 30 s");
  ExpectRefused(AlignInTime(Recorded(three, 30, -1, 0), Moved(two, 30)), "me.bvh",
                "2 stomps found in 30 s");
}

TEST(AlignInTime, ForcesOfAnotherMotionAreRefused) {
  const Mover mine{{5.0, 6.1, 7.8}, 1}, yours{{9.0, 10.1, 11.8}, 2};
  ExpectRefused(AlignInTime(Recorded(mine, 60, -1, 0), Moved(yours, 60)), "me.mcap and me.bvh",
                "do not go together");
}

}  // namespace
}  // namespace footing::learning

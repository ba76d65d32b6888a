#include "clients/stream/dialer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

/// Segments of 2 m, each turned against the one before.
stream::Track Bending(const std::vector<double>& curves_deg) {
  stream::Track track;
  stream::TrackSegment segment;
  segment.length_m = 8;
  segment.width_m = 4;
  track.segments.push_back(segment);
  for (const double curve_deg : curves_deg) {
    segment = stream::Following(track.segments.back());
    segment.length_m = 2;
    segment.width_m = 4;
    segment.heading_rad += DegreesToRadians(curve_deg);
    track.segments.push_back(segment);
  }
  return track;
}

/// How the wrist interface and the character answer, in short: frequency to speed, inclination to
/// 5 degrees a step, 0.2 s late.
struct Body {
  Runner runner{7};
  RunnerSight sight;
  double time_s = 0;
  std::vector<double> roll_rad;
  double fastest_mps = 0, slowest_mps = 10;

  void Step() {
    constexpr double kStepS = 0.01;
    runner.See(time_s, sight);
    const RunnerSwing swing = runner.Want(time_s);
    roll_rad.push_back(swing.roll_rad);
    const double late_rad = roll_rad.size() > 20 ? roll_rad[roll_rad.size() - 21] : 0;
    const bool runs = swing.frequency_hz > 2;
    const double wanted_mps = runs ? 1.5 + (swing.frequency_hz - 2) * 3 / 2.5
                                   : 0.2 + (swing.frequency_hz - 0.5) * 1.2 / 1.5;
    sight.speed_mps += 0.02 * (wanted_mps - sight.speed_mps);
    const double turn =
        std::fabs(late_rad) > DegreesToRadians(20) ? -std::copysign(1.0, late_rad) : 0;
    sight.heading_rad += turn * DegreesToRadians(5) * 2.4 * kStepS;
    sight.p_W_m += sight.speed_mps * kStepS *
                   Eigen::Vector2d(std::cos(sight.heading_rad), std::sin(sight.heading_rad));
    fastest_mps = std::max(fastest_mps, sight.speed_mps);
    time_s += kStepS;
  }
};

double FarthestFromCentre(const stream::Track& track, Body& body, double seconds) {
  double farthest_m = 0;
  body.runner.SeeTrack(track);
  while (body.time_s < seconds) {
    body.Step();
    double nearest_m = 1e9;
    for (const stream::TrackSegment& segment : track.segments) {
      const Eigen::Vector2d from = segment.start_m.head<2>();
      const Eigen::Vector2d way(std::cos(segment.heading_rad), std::sin(segment.heading_rad));
      const double along_m = std::clamp((body.sight.p_W_m - from).dot(way), 0.0, segment.length_m);
      nearest_m = std::min(nearest_m, (body.sight.p_W_m - from - along_m * way).norm());
    }
    farthest_m = std::max(farthest_m, nearest_m);
  }
  return farthest_m;
}

TEST(Runner, RestsWhileThereIsNothingToSee) {
  Runner runner(1);
  EXPECT_EQ(runner.Want(0).frequency_hz, 0);
  runner.See(0.1, {});
  EXPECT_EQ(runner.Want(0.2).amplitude_mps2, 0);
}

TEST(Runner, RunsOnAStraightTrack) {
  Body body;
  EXPECT_LT(FarthestFromCentre(Bending(std::vector<double>(20, 0)), body, 12), 0.3);
  EXPECT_GT(body.fastest_mps, 2);
  EXPECT_GT(body.sight.p_W_m.x(), 15);
}

// The sharpest that the game's builder can lay: 15 degrees every 2 m, to one side for 90 degrees,
// and back.
TEST(Runner, StaysOnTheRibbonInTheSharpestCurves) {
  const std::vector<double> bends{0,   0,   15,  15,  15,  15,  15,  15,  -15, -15, -15, -15,
                                  -15, -15, -15, -15, -15, -15, -15, -15, 15,  15,  15,  15};
  Body body;
  const double farthest_m = FarthestFromCentre(Bending(bends), body, 30);
  EXPECT_LT(farthest_m, 1.6);  // The ribbon's edge is at 2 m.
  EXPECT_GT(body.sight.p_W_m.x(), 20);
}

TEST(Runner, InclinesToTheSideOfTheCurve) {
  for (const double side : {1.0, -1.0}) {
    Runner runner(3);
    runner.SeeTrack(Bending(std::vector<double>(6, 15 * side)));
    RunnerSight sight;
    sight.p_W_m.x() = 8;
    for (double t_s = 0; t_s < 1; t_s += 0.01) runner.See(t_s, sight);
    // Left side higher turns right.
    EXPECT_LT(runner.Want(1).roll_rad * side, -DegreesToRadians(20));
  }
}

}  // namespace
}  // namespace footing::stream_client

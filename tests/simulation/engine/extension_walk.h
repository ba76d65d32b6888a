#pragma once

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/state.h"
#include "tests/simulation/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {

inline GaitEngine NewBuildEngine() {
  EngineTexts texts = Texts();
  texts.track = test::DataFile("tracks/build.json");
  return std::move(GaitEngine::Create(texts)).value();
}

inline void Add(const terrain::NewSegment& segment, EngineInputs& inputs) {
  ++inputs.append_number;
  inputs.append_count = 1;
  inputs.appends[0] = segment;
}

/// Walks along the track's centre line: turns by what is missing to a point 2.5 m ahead.
inline void SteerAlong(GaitEngine& engine, double speed_mps, EngineInputs& inputs) {
  const EngineOutput& output = engine.Output();
  const auto place = terrain::Locate(engine.track(), output.p_WC_m.head<2>());
  const Eigen::Vector2d way =
      (terrain::CentreAhead(engine.track(), place, 2.5).p_W_m - output.p_WC_m).head<2>();
  const double error_rad = WrapAngle(std::atan2(way.y(), way.x()) - output.gait.heading_rad);
  inputs.direct = true;
  inputs.direct_command =
      Command(stream::Gait::kWalk, speed_mps, 0.2, std::clamp(error_rad / 3, -0.08, 0.08));
}

/// The i-th segment of a long course: S curves, slopes up and down, small steps, all in the limits.
inline terrain::NewSegment GentleCourse(int i) {
  const double curve_deg = 12 * std::sin(0.35 * i);
  const double slope_deg = 4 * std::sin(0.5 * i);
  const double step_m = i % 5 == 2 ? 0.03 : i % 5 == 4 ? -0.03 : 0;
  return {.length_m = 2.0 + 0.5 * (i % 3),
          .slope_rad = DegreesToRadians(slope_deg),
          .curve_rad = DegreesToRadians(curve_deg),
          .step_m = step_m};
}

/// Walks on while segments are added, each when it is ten segments ahead or less.
struct Walk {
  terrain::NewSegment (*course)(int) = GentleCourse;
  double speed_mps = 1.4;
  int segments = 200;
  int added = 0, refused = 0;

  /// For so long, or until the last segments are reached: the track ends with them.
  void Advance(GaitEngine& engine, double seconds, EngineInputs& inputs) {
    for (int i = 0; i < std::lround(seconds * 1000); ++i) {
      if (i % 100 == 0) {
        SteerAlong(engine, speed_mps, inputs);
        const auto here = terrain::Locate(engine.track(), engine.Output().p_WC_m.head<2>()).segment;
        const int ahead = static_cast<int>(engine.track().segments.size()) - here;
        if (added < segments && ahead < 10) Add(course(added++), inputs);
        if (added == segments && ahead < 4) return;
      }
      engine.Advance(inputs);
      const EngineOutput& output = engine.Output();
      for (int event = 0; event < output.event_count; ++event) {
        const bool is_refusal =
            output.events[static_cast<std::size_t>(event)].kind == EventKind::kAppendRefused;
        refused += is_refusal ? 1 : 0;
      }
    }
  }
};

/// Walks until all of the walk's segments are added and passed but the last, and sees that nothing
/// was allocated, refused or fallen over. Segments are 2.5 m long on average.
inline void ExpectAWalkWithoutAFall(Walk walk) {
  GaitEngine engine = NewBuildEngine();
  EngineInputs inputs;
  walk.Advance(engine, 1, inputs);
  const long before = test::Allocations();
  walk.Advance(engine, 30 + 2.5 * walk.segments / walk.speed_mps, inputs);
  EXPECT_EQ(test::Allocations(), before);  // 0 and 0 where they are not counted.
  EXPECT_EQ(engine.Output().gait.falls, 0u);
  EXPECT_EQ(walk.added, walk.segments);
  EXPECT_EQ(walk.refused, 0);
  EXPECT_EQ(engine.Output().append.number, static_cast<std::uint64_t>(walk.segments));
  EXPECT_EQ(engine.track().revision, static_cast<std::uint64_t>(walk.segments) + 1);
  const auto here = terrain::Locate(engine.track(), engine.Output().p_WC_m.head<2>());
  EXPECT_EQ(here.segment, walk.segments + 1);  // Four segments and as many more.
}

}  // namespace footing::engine

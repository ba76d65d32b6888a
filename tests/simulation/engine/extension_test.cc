#include <algorithm>
#include <cmath>

#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/terrain/track.h"
#include "tests/simulation/engine/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

using stream::Gait;

constexpr double kDegreeRad = M_PI / 180;

GaitEngine NewBuildEngine() {
  EngineTexts texts = Texts();
  texts.track = test::DataFile("tracks/build.json");
  return std::move(GaitEngine::Create(texts)).value();
}

void Add(const terrain::NewSegment& segment, EngineInputs& inputs) {
  ++inputs.append_number;
  inputs.append_count = 1;
  inputs.appends[0] = segment;
}

/// Walks along the track's centre line: turns by what is missing to a point 2.5 m ahead.
void SteerAlong(GaitEngine& engine, double speed_mps, EngineInputs& inputs) {
  const EngineOutput& output = engine.Output();
  const auto place = terrain::Locate(engine.track(), output.p_WC_m.head<2>());
  const Eigen::Vector2d way =
      (terrain::CentreAhead(engine.track(), place, 2.5).p_W_m - output.p_WC_m).head<2>();
  const double error_rad =
      std::remainder(std::atan2(way.y(), way.x()) - output.gait.heading_rad, 2 * M_PI);
  inputs.direct = true;
  inputs.direct_command =
      Command(Gait::kWalk, speed_mps, 0.2, std::clamp(error_rad / 3, -0.08, 0.08));
}

/// The i-th segment of a long course: S curves, slopes up and down, small steps, all in the limits.
terrain::NewSegment Course(int i) {
  const double curve_deg = 12 * std::sin(0.35 * i);
  const double slope_deg = 4 * std::sin(0.5 * i);
  const double step_m = i % 5 == 2 ? 0.03 : i % 5 == 4 ? -0.03 : 0;
  return {.length_m = 2.0 + 0.5 * (i % 3),
          .slope_rad = slope_deg * kDegreeRad,
          .curve_rad = curve_deg * kDegreeRad,
          .step_m = step_m};
}

/// Walks on while 200 segments are added, each when it is ten segments ahead or less.
struct Walk {
  int added = 0, refused = 0;

  void Advance(GaitEngine& engine, double seconds, EngineInputs& inputs) {
    for (int i = 0; i < std::lround(seconds * 1000); ++i) {
      if (i % 100 == 0) {
        SteerAlong(engine, 1.4, inputs);
        const auto here = terrain::Locate(engine.track(), engine.Output().p_WC_m.head<2>()).segment;
        const int ahead = static_cast<int>(engine.track().segments.size()) - here;
        if (added < 200 && ahead < 10) Add(Course(added++), inputs);
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

TEST(Extension, TwoHundredSegmentsAreAddedWhileWalkingWithoutAnAllocation) {
  GaitEngine engine = NewBuildEngine();
  EngineInputs inputs;
  Walk walk;
  walk.Advance(engine, 1, inputs);
  const long before = test::Allocations();
  walk.Advance(engine, 400, inputs);
  EXPECT_EQ(test::Allocations(), before);  // 0 and 0 where they are not counted.
  EXPECT_EQ(walk.added, 200);
  EXPECT_EQ(walk.refused, 0);
  EXPECT_EQ(engine.Output().append_number, 200u);
  EXPECT_EQ(engine.track().revision, 201u);
  // It walked on them: 400 s at 1.4 m/s along 16 m and 200 segments of 2.5 m on average.
  const auto here = terrain::Locate(engine.track(), engine.Output().p_WC_m.head<2>());
  EXPECT_GT(here.segment, 190);
}

TEST(Extension, ARestoredStateReplaysTheAppends) {
  GaitEngine first = NewBuildEngine(), second = NewBuildEngine();
  EngineInputs inputs;
  Walk walk;
  walk.Advance(first, 40, inputs);
  const EngineState state = first.Save();
  const EngineInputs saved_inputs = inputs;
  const Walk saved_walk = walk;
  walk.Advance(first, 30, inputs);
  ASSERT_GT(walk.added, saved_walk.added);

  const std::uint64_t expected = first.Output().state_hash;
  // In another engine, and in the same one after it has gone on.
  for (GaitEngine* engine : {&second, &first}) {
    EngineInputs again = saved_inputs;
    Walk walk_again = saved_walk;
    engine->Restore(state);
    walk_again.Advance(*engine, 30, again);
    EXPECT_EQ(engine->Output().state_hash, expected);
    EXPECT_EQ(engine->track().revision, first.track().revision);
  }
}

TEST(Extension, ABadSegmentIsRefusedAndTheTrackStaysAsItWas) {
  GaitEngine engine = NewBuildEngine();
  EngineInputs inputs = Direct(Command(Gait::kStep, 0));
  Add({.length_m = 9}, inputs);
  std::string why;
  Simulate(engine, inputs, 0.1, [&why](const EngineOutput& output) {
    for (int i = 0; i < output.event_count; ++i) {
      const EngineEvent& event = output.events[static_cast<std::size_t>(i)];
      if (event.kind == EventKind::kAppendRefused) why = event.text;
    }
  });
  EXPECT_NE(why.find("2 to 4 m"), std::string::npos);
  EXPECT_EQ(engine.track().segments.size(), 4u);
  EXPECT_EQ(engine.Output().append_number, 1u);
}

TEST(Extension, AListOfSegmentsIsTakenOneAStepInTheirOrder) {
  GaitEngine engine = NewBuildEngine();
  EngineInputs inputs = Direct(Command(Gait::kStep, 0));
  inputs.append_number = 3;
  inputs.append_count = 3;
  for (int i = 0; i < 3; ++i) inputs.appends[static_cast<std::size_t>(i)].length_m = 2 + 0.5 * i;
  engine.Advance(inputs);
  EXPECT_TRUE(engine.Output().appended);
  EXPECT_EQ(engine.track().segments.size(), 5u);
  Simulate(engine, inputs, 0.01);
  ASSERT_EQ(engine.track().segments.size(), 7u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(engine.track().segments[4 + i].length_m, 2 + 0.5 * static_cast<double>(i));
  }
  inputs.append_number = 40;  // 37 more were sent, the list holds the last three.
  std::string text;
  Simulate(engine, inputs, 0.01, [&text](const EngineOutput& output) {
    if (output.event_count > 0) text = output.events[0].text;
  });
  EXPECT_NE(text.find("lost"), std::string::npos);
  EXPECT_EQ(engine.track().segments.size(), 10u);
}

}  // namespace
}  // namespace footing::engine

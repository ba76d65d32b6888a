#include "tests/simulation/engine/extension_walk.h"

namespace footing::engine {
namespace {

using stream::Gait;

TEST(Extension, SegmentsAreAddedWhileWalkingWithoutAnAllocationOrAFall) {
  ExpectAWalkWithoutAFall({.segments = 25});
}

TEST(Extension, ARestoredStateReplaysTheAppends) {
  GaitEngine first = NewBuildEngine(), second = NewBuildEngine();
  EngineInputs inputs;
  Walk walk;
  walk.Advance(first, 20, inputs);
  const EngineState state = first.Save();
  const EngineInputs saved_inputs = inputs;
  const Walk saved_walk = walk;
  walk.Advance(first, 12, inputs);
  ASSERT_GT(walk.added, saved_walk.added);

  const std::uint64_t expected = first.Output().state_hash;
  // In another engine, and in the same one after it has gone on.
  for (GaitEngine* engine : {&second, &first}) {
    EngineInputs again = saved_inputs;
    Walk walk_again = saved_walk;
    engine->Restore(state);
    walk_again.Advance(*engine, 12, again);
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
  EXPECT_EQ(engine.Output().append.number, 1u);
}

TEST(Extension, AListOfSegmentsIsTakenOneAStepInTheirOrder) {
  GaitEngine engine = NewBuildEngine();
  EngineInputs inputs = Direct(Command(Gait::kStep, 0));
  inputs.append_number = 3;
  inputs.append_count = 3;
  for (int i = 0; i < 3; ++i) inputs.appends[static_cast<std::size_t>(i)].length_m = 2 + 0.5 * i;
  engine.Advance(inputs);
  EXPECT_TRUE(engine.Output().append.added);
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

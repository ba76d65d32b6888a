#include "daemon/simulation/engine/state.h"
#include "tests/simulation/allocations.h"
#include "tests/simulation/engine/engine_fixture.h"

namespace footing::engine {
namespace {

TEST(Engine, AllocatesNothingAfterItsStart) {
  if (!test::CountsAllocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(stream::Gait::kWalk, 1));
  long before = test::Allocations();
  auto probe = std::make_unique<int>(1);
  ASSERT_GT(test::Allocations(), before) << "the counter does not count";

  before = test::Allocations();
  for (const stream::Gait gait :
       {stream::Gait::kWalk, stream::Gait::kRun, stream::Gait::kJump, stream::Gait::kStep}) {
    inputs.direct_command.gait = gait;
    for (int i = 0; i < 4000; ++i) {
      engine.Advance(inputs);
      engine.Output();
    }
  }
  Push(inputs, 30, 90);  // A fall and a put-back too.
  for (int i = 0; i < 3000; ++i) engine.Advance(inputs);
  const EngineState state = engine.Save();
  engine.Restore(state);
  EXPECT_EQ(test::Allocations(), before);
  EXPECT_EQ(engine.Output().gait.falls, 1u);
}

}  // namespace
}  // namespace footing::engine

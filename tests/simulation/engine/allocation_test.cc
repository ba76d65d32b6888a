#include <cstdlib>

#include "daemon/simulation/engine/state.h"
#include "tests/simulation/engine/engine_fixture.h"

// Counts what the C library hands out, so MuJoCo's allocations are seen as well as ours. A
// sanitizer brings its own malloc; there the count stays 0 and the test is skipped.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOOTING_COUNTS_ALLOCATIONS 1
namespace {
long allocations = 0;
}
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace footing::engine {
namespace {

TEST(Engine, AllocatesNothingAfterItsStart) {
#ifndef FOOTING_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "the sanitizer owns malloc";
#else
  GaitEngine engine = NewEngine();
  EngineInputs inputs = Direct(Command(stream::Gait::kWalk, 1));
  long before = allocations;
  auto probe = std::make_unique<int>(1);
  ASSERT_GT(allocations, before) << "the counter does not count";

  before = allocations;
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
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(engine.Output().gait.falls, 1u);
#endif
}

}  // namespace
}  // namespace footing::engine

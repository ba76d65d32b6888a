#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/gait_service/gait_run.h"
#include "daemon/simulation/gait_service/publish.h"
#include "daemon/simulation/serving/simulation_thread.h"
#include "tests/simulation/serving/counted_calls.h"

namespace footing::gait_service {
namespace {

#ifdef FOOTING_COUNTS_CALLS
using counted_calls::allocations;
using counted_calls::is_test_thread;
using counted_calls::locks;
#endif

/// A thread whose clock's step is a microsecond: it never sleeps, and is late at every step.
class HastyThread {
 public:
  HastyThread()
      : wake_(eventfd(0, EFD_CLOEXEC)), thread_(GaitRun(MakeEngine(), tracks_), 1e-6, 10, wake_) {
    thread_.Start();
  }
  ~HastyThread() {
    thread_.Stop();
    close(wake_);
  }

  /// The first frame from this step on; bounded.
  bool WaitForStep(std::uint64_t step, Frame& frame) {
    while (true) {
      while (thread_.frames().Pop(frame)) {
        if (frame.output.step >= step) return true;
      }
      pollfd ready{wake_, POLLIN, 0};
      if (poll(&ready, 1, 20000) <= 0) return false;
      std::uint64_t count = 0;
      if (read(wake_, &count, sizeof(count)) < 0) return false;
    }
  }
  serving::SimulationThread<GaitRun>& thread() { return thread_; }

 private:
  static engine::GaitEngine MakeEngine() {
    auto engine = engine::GaitEngine::Create(*engine_files::ReadTexts());
    FOOTING_CHECK(engine.ok());
    return std::move(engine).value();
  }

  int wake_;
  TrackExchange tracks_;
  serving::SimulationThread<GaitRun> thread_;
};

TEST(SimulationThread, AllocatesLocksAndSoLogsNothingOnceItRuns) {
#ifndef FOOTING_COUNTS_CALLS
  GTEST_SKIP() << "the sanitizer owns malloc and mutexes";
#else
  const long allocations_before = allocations, locks_before = locks;
  {
    std::mutex mutex;
    const std::lock_guard<std::mutex> guard(mutex);
    auto probe = std::make_unique<int>(1);
    ASSERT_NE(probe, nullptr);
  }
  ASSERT_GT(allocations, allocations_before) << "the counter does not count";
  ASSERT_GT(locks, locks_before) << "the counter does not count";
  is_test_thread = true;

  HastyThread hasty;
  Frame frame;
  ASSERT_TRUE(hasty.WaitForStep(1, frame));
  const long allocations_start = allocations, locks_start = locks;
  Inputs inputs;
  inputs.engine.direct = true;
  std::uint64_t step = 0;
  for (const stream::Gait gait :
       {stream::Gait::kWalk, stream::Gait::kRun, stream::Gait::kJump, stream::Gait::kStep}) {
    inputs.engine.direct_command = {.gait = gait, .speed_mps = 1};
    ++inputs.engine.push_number;
    inputs.engine.push_impulse_W_ns = {0, gait == stream::Gait::kStep ? 90 : 2};  // A fall too.
    hasty.thread().inputs().Write(inputs);
    step += 4000;
    ASSERT_TRUE(hasty.WaitForStep(step, frame));
  }
  EXPECT_EQ(allocations, allocations_start);
  EXPECT_EQ(locks, locks_start);
  EXPECT_GE(frame.output.gait.falls, 1u);
#endif
}

TEST(SimulationThread, CountsEveryStepThatBeganLateAndPublishesTheCount) {
  HastyThread hasty;
  Frame first, later;
  ASSERT_TRUE(hasty.WaitForStep(1, first));
  ASSERT_TRUE(hasty.WaitForStep(500, later));
  const std::uint64_t steps = later.output.step - first.output.step;
  EXPECT_GT(later.overruns - first.overruns, steps * 9 / 10);
  EXPECT_LE(later.overruns - first.overruns, steps);
  EXPECT_EQ(ToCharacterFrame(later, "straight", "rig").overruns(), later.overruns);
}

TEST(SimulationThread, SimulatesAMillisecondAStepHoweverLateItIs) {
  HastyThread hasty;
  Frame frame;
  ASSERT_TRUE(hasty.WaitForStep(300, frame));
  EXPECT_EQ(frame.output.time_s, static_cast<double>(frame.output.step) * 0.001);
}

}  // namespace
}  // namespace footing::gait_service

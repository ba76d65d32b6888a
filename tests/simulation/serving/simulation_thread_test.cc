#include "daemon/simulation/serving/simulation_thread.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>

namespace footing::serving {
namespace {

/// Counts its steps; a frame lists what it has not yet handed over.
class CountingRun {
 public:
  struct Inputs {
    int number = 0;
  };
  struct Frame {
    std::uint64_t step = 0;
    std::uint64_t overruns = 0;
    std::uint64_t left_out = 0;
    int newest_input = 0;
    int since_last_frame = 0;
  };

  void StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame) {
    ++step_;
    inputs.Refresh();
    frame.newest_input = inputs.Front().number;
    ++frame.since_last_frame;
  }
  void FillOnSimThread(Frame& frame) const { frame.step = step_; }
  void TakenOnSimThread(Frame& frame) const { frame.since_last_frame = 0; }

 private:
  std::uint64_t step_ = 0;
};

/// Its steps block while a flag says so.
class BlockingRun : public CountingRun {
 public:
  explicit BlockingRun(exchange::Flag& blocks) : blocks_(&blocks) {}

  void StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame) {
    while (blocks_->raised()) usleep(1000);
    CountingRun::StepOnSimThread(inputs, frame);
  }

 private:
  exchange::Flag* blocks_;
};

/// Waits, bounded, until the thread has handed over a frame.
template <typename Run>
bool WaitForFrame(SimulationThread<Run>& thread, int wake_descriptor, CountingRun::Frame& frame) {
  while (!thread.frames().Pop(frame)) {
    pollfd ready{wake_descriptor, POLLIN, 0};
    if (poll(&ready, 1, 5000) <= 0) return false;
    std::uint64_t count = 0;
    if (read(wake_descriptor, &count, sizeof(count)) < 0) return false;
  }
  return true;
}

TEST(SimulationThread, HandsOverAFrameEverySoManyStepsAndTakesTheNewestInputs) {
  const int wake = eventfd(0, EFD_CLOEXEC);
  ASSERT_GE(wake, 0);
  SimulationThread<CountingRun> thread(CountingRun(), 0.001, 10, wake);
  thread.inputs().Write({5});
  thread.Start();
  CountingRun::Frame frame;
  for (std::uint64_t n = 1; n <= 5; ++n) {
    ASSERT_TRUE(WaitForFrame(thread, wake, frame));
    EXPECT_EQ(frame.step, 10 * n);
    EXPECT_EQ(frame.newest_input, 5);
  }
  thread.Stop();
  close(wake);
}

TEST(SimulationThread, KeepsWhatAFullQueueDidNotTakeForTheNextFrame) {
  // Each step is due after a microsecond, so the queue is full long before anything is popped.
  const int wake = eventfd(0, EFD_CLOEXEC);
  ASSERT_GE(wake, 0);
  SimulationThread<CountingRun> thread(CountingRun(), 1e-6, 1, wake);
  thread.Start();
  std::uint64_t steps = 0;
  CountingRun::Frame frame;
  while (steps < 1000) {
    if (!WaitForFrame(thread, wake, frame)) break;
    steps += static_cast<std::uint64_t>(frame.since_last_frame);
    EXPECT_EQ(frame.step, steps);  // None is lost: every step is in one frame's list.
  }
  thread.Stop();
  close(wake);
  EXPECT_GE(steps, 1000u);
}

TEST(SimulationThread, AThreadThatDoesNotComeRoundIsStuckAndItsFramesAreCounted) {
  const int wake = eventfd(0, EFD_CLOEXEC);
  ASSERT_GE(wake, 0);
  exchange::Flag blocks;
  SimulationThread<BlockingRun> thread(BlockingRun(blocks), 0.001, 10, wake);
  EXPECT_FALSE(thread.Stuck()) << "it has not begun";
  thread.Start();
  CountingRun::Frame frame;
  ASSERT_TRUE(WaitForFrame(thread, wake, frame));
  EXPECT_FALSE(thread.Stuck());
  const std::uint64_t left_out_before = frame.left_out;  // Some, where the machine stalled.
  blocks.Raise();
  bool stuck = false;
  for (int i = 0; i < 700 && !stuck; ++i) {
    usleep(10'000);
    stuck = thread.Stuck();
  }
  EXPECT_TRUE(stuck);
  blocks.Lower();
  while (frame.left_out < left_out_before + 480 && WaitForFrame(thread, wake, frame)) {
  }
  EXPECT_GE(frame.left_out, left_out_before + 480) << "5 s of frames of 10 ms";
  EXPECT_FALSE(thread.Stuck());
  thread.Stop();
  close(wake);
}

}  // namespace
}  // namespace footing::serving

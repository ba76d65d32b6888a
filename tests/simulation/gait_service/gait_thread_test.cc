
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "common/runtime/files.h"
#include "daemon/simulation/gait_service/gait_run.h"
#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::gait_service {
namespace {

engine::GaitEngine MakeEngine() {
  engine::EngineTexts texts;
  texts.biped = *config::ReadDataFile(engine::kBipedFile);
  texts.track = *config::ReadDataFile(engine::kPlainTrackFile);
  texts.mapping = *config::ReadDataFile(mapping::kWristMappingFile);
  auto engine = engine::GaitEngine::Create(texts);
  FOOTING_CHECK(engine.ok());
  return std::move(engine).value();
}

/// Waits, bounded, until the thread has handed over a frame.
bool WaitForFrame(serving::SimulationThread<GaitRun>& thread, int wake_descriptor, Frame& frame) {
  while (!thread.frames().Pop(frame)) {
    pollfd ready{wake_descriptor, POLLIN, 0};
    if (poll(&ready, 1, 5000) <= 0) return false;
    std::uint64_t count = 0;
    if (read(wake_descriptor, &count, sizeof(count)) < 0) return false;
  }
  return true;
}

TEST(GaitThread, AppliedInputsRunAgainToTheSameStateHash) {
  const int wake = eventfd(0, EFD_CLOEXEC);
  ASSERT_GE(wake, 0);
  TrackExchange tracks;
  serving::SimulationThread<GaitRun> thread(GaitRun(MakeEngine(), tracks), 0.001, 10, wake);
  thread.Start();
  Inputs inputs;
  std::vector<Applied> applied;
  Frame frame;
  for (int i = 0; i < 60; ++i) {
    inputs.engine.direct = true;
    inputs.engine.direct_command.gait = i < 30 ? stream::Gait::kWalk : stream::Gait::kRun;
    inputs.engine.direct_command.speed_mps = 0.5 + 0.02 * i;
    thread.inputs().Write(inputs);
    ASSERT_TRUE(WaitForFrame(thread, wake, frame));
    for (int k = 0; k < frame.applied_count; ++k) {
      applied.push_back(frame.applied[static_cast<std::size_t>(k)]);
    }
  }
  thread.Stop();
  close(wake);
  ASSERT_GT(applied.size(), 10u);

  engine::GaitEngine again = MakeEngine();
  engine::EngineInputs current;
  std::size_t next = 0;
  for (std::uint64_t step = 1; step <= frame.output.step; ++step) {
    while (next < applied.size() && applied[next].step == step) {
      current = applied[next++].inputs.engine;
    }
    again.Advance(current);
  }
  EXPECT_EQ(again.Output().state_hash, frame.output.state_hash);
  EXPECT_EQ(next, applied.size());
}

}  // namespace
}  // namespace footing::gait_service

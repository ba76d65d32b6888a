#include "daemon/simulation/service/simulation_thread.h"

#include <unistd.h>

#include <cmath>
#include <utility>

#include "common/clock/clock.h"

namespace footing::simulation {
namespace {

constexpr std::size_t kFrameQueue = 64;
/// Behind by more than this, the thread gives up catching up and starts anew from the present.
constexpr std::int64_t kGiveUpNs = 100'000'000;

}  // namespace

SimulationThread::SimulationThread(engine::GaitEngine engine, double step_s, int steps_per_frame,
                                   int wake_descriptor)
    : engine_(std::move(engine)),
      step_ns_(std::llround(step_s * 1e9)),
      steps_per_frame_(steps_per_frame),
      wake_descriptor_(wake_descriptor),
      frames_(kFrameQueue) {}

SimulationThread::~SimulationThread() { Stop(); }

void SimulationThread::Start() {
  thread_ = std::thread([this] { RunOnSimThread(); });
}

void SimulationThread::Stop() {
  stop_.Raise();
  if (thread_.joinable()) thread_.join();
}

void SimulationThread::RunOnSimThread() {
  std::int64_t due_ns = clock::MonotonicNs();
  while (!stop_.raised()) {
    for (int i = 0; i < steps_per_frame_; ++i) {
      due_ns += step_ns_;
      const std::int64_t behind_ns = clock::MonotonicNs() - due_ns;
      if (behind_ns < 0) {
        clock::SleepUntil(due_ns);
      } else if (behind_ns > step_ns_) {
        ++frame_.overruns;
        if (behind_ns > kGiveUpNs) due_ns += behind_ns;
      }
      StepOnSimThread();
    }
    HandOverOnSimThread();
  }
}

void SimulationThread::StepOnSimThread() {
  // One input adds at most kMaxAppends segments, of which each has its place in the frame.
  const bool room =
      frame_.applied_count < kMaxApplied && frame_.added_count + engine::kMaxAppends <= kMaxAdded;
  if (room && inputs_.Refresh()) {
    Applied& applied = frame_.applied[static_cast<std::size_t>(frame_.applied_count++)];
    applied.step = engine_.Output().step + 1;
    applied.inputs = inputs_.Front();
  }
  engine_.Advance(inputs_.Front().engine);
  const engine::EngineOutput& output = engine_.Output();
  if (output.appended && frame_.added_count < kMaxAdded) {
    frame_.added[static_cast<std::size_t>(frame_.added_count++)] = engine_.track().segments.back();
  }
  if (output.commanded_step == output.step) frame_.command_ns = clock::MonotonicNs();
  if (output.taken_over_step == output.step) frame_.contact_ns = clock::MonotonicNs();
  for (int i = 0; i < output.event_count && frame_.event_count < kMaxFrameEvents; ++i) {
    frame_.events[static_cast<std::size_t>(frame_.event_count++)] =
        output.events[static_cast<std::size_t>(i)];
  }
}

void SimulationThread::HandOverOnSimThread() {
  frame_.output = engine_.Output();
  // A full queue keeps events and inputs for the next frame: only a pose is lost.
  if (!frames_.Push(frame_)) return;
  frame_.event_count = 0;
  frame_.applied_count = 0;
  frame_.added_count = 0;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(wake_descriptor_, &one, sizeof(one));
}

}  // namespace footing::simulation

#pragma once

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <thread>
#include <utility>

#include "common/runtime/clock.h"
#include "common/runtime/bounded_queue.h"
#include "common/runtime/flag.h"
#include "common/runtime/heartbeat.h"
#include "common/runtime/latest.h"

namespace footing::serving {

/// Runs one engine in real time on a thread of its own.
///
/// `Run` is the engine with its two hand-overs (GaitRun, PoseRun): it names the types `Inputs` and
/// `Frame`, advances by one step with StepOnSimThread(inputs, frame), and has
/// FillOnSimThread(frame) before and TakenOnSimThread(frame) after the frame was handed over. A
/// Frame has the counts `overruns` and `left_out` (frames). After Start the thread allocates, locks
/// and logs nothing. It meets the io thread at `inputs`, `frames`, and one write to
/// `wake_descriptor` (an eventfd) per frame, and where the run itself has a queue.
template <typename Run>
class SimulationThread {
 public:
  using Inputs = typename Run::Inputs;
  using Frame = typename Run::Frame;

  /// `steps_per_frame` steps make a frame; `wake_descriptor` stays the caller's.
  SimulationThread(Run run, double step_s, int steps_per_frame, int wake_descriptor)
      : run_(std::move(run)),
        step_ns_(std::llround(step_s * 1e9)),
        steps_per_frame_(steps_per_frame),
        wake_descriptor_(wake_descriptor),
        frames_(kFrameQueue) {}
  ~SimulationThread() { Stop(); }
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  void Start() {
    thread_ = std::thread([this, follower = clock::NewFollower()]() mutable {
      clock::Follow(std::move(follower));
      RunOnSimThread();
    });
  }
  void Stop() {
    stop_.Raise();
    if (!thread_.joinable()) return;
    // The thread looks once a frame, and on simulated time in its own turns only.
    if (clock::OwnFollower() != nullptr) {
      clock::SleepUntil(clock::MonotonicNs() + (steps_per_frame_ + 1) * step_ns_);
    }
    thread_.join();
  }

  /// It has not come round for longer than any step takes.
  bool Stuck() const { return heartbeat_.StuckFor(kLongestTurnNs, clock::MonotonicNs()); }

  exchange::Latest<Inputs>& inputs() { return inputs_; }
  exchange::BoundedQueue<Frame>& frames() { return frames_; }
  /// Of the simulation thread once that has started.
  const Run& run() const { return run_; }

 private:
  static constexpr std::size_t kFrameQueue = 64;
  /// Behind by more than this, the thread gives up catching up and restarts from the present.
  static constexpr std::int64_t kGiveUpNs = 100'000'000;
  static constexpr std::int64_t kLongestTurnNs = 5'000'000'000;

  void RunOnSimThread() {
    std::int64_t due_ns = clock::MonotonicNs();
    heartbeat_.Beat(due_ns);
    while (!stop_.raised()) {
      for (int i = 0; i < steps_per_frame_; ++i) {
        due_ns += step_ns_;
        const std::int64_t behind_ns = clock::MonotonicNs() - due_ns;
        if (behind_ns < 0) {
          clock::SleepUntil(due_ns);
        } else if (behind_ns > step_ns_) {
          ++frame_.overruns;
          if (behind_ns > kGiveUpNs) GiveUpOnSimThread(behind_ns, due_ns);
        }
        run_.StepOnSimThread(inputs_, frame_);
      }
      heartbeat_.Beat(clock::MonotonicNs());  // Before its frame is seen.
      HandOverOnSimThread();
    }
  }

  /// Restarts from the present: the frames that were due until now are left out.
  void GiveUpOnSimThread(std::int64_t behind_ns, std::int64_t& due_ns) {
    due_ns += behind_ns;
    frame_.left_out += static_cast<std::uint64_t>(behind_ns / (step_ns_ * steps_per_frame_));
  }

  void HandOverOnSimThread() {
    run_.FillOnSimThread(frame_);
    // A full queue keeps events and inputs for the next frame: only a pose is lost.
    if (!frames_.Push(frame_)) {
      ++frame_.left_out;
      return;
    }
    run_.TakenOnSimThread(frame_);
    clock::Act();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = write(wake_descriptor_, &one, sizeof(one));
  }

  Run run_;
  const std::int64_t step_ns_;
  const int steps_per_frame_;
  const int wake_descriptor_;
  exchange::Latest<Inputs> inputs_;
  exchange::BoundedQueue<Frame> frames_;
  exchange::Flag stop_;
  exchange::Heartbeat heartbeat_;
  Frame frame_;  ///< Being filled, on the simulation thread.
  std::thread thread_;
};

}  // namespace footing::serving

#pragma once

#include <cstdint>
#include <thread>

#include "common/exchange/bounded_queue.h"
#include "common/exchange/flag.h"
#include "common/exchange/latest.h"
#include "daemon/simulation/service/frame.h"

namespace footing::simulation {

/// Runs the engine in real time on a thread of its own.
///
/// After Start the thread allocates, locks and logs nothing. It meets the io thread at three
/// places: `inputs`, `frames`, and one write to `wake_descriptor` (an eventfd) per frame.
class SimulationThread {
 public:
  /// `steps_per_frame` steps make a frame; `wake_descriptor` stays the caller's.
  SimulationThread(engine::GaitEngine engine, double step_s, int steps_per_frame,
                   int wake_descriptor);
  ~SimulationThread();
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  void Start();
  void Stop();

  exchange::Latest<Inputs>& inputs() { return inputs_; }
  exchange::BoundedQueue<Frame>& frames() { return frames_; }
  const engine::GaitEngine& engine() const { return engine_; }

 private:
  void RunOnSimThread();
  void StepOnSimThread();
  void HandOverOnSimThread();

  engine::GaitEngine engine_;
  const std::int64_t step_ns_;
  const int steps_per_frame_;
  const int wake_descriptor_;
  exchange::Latest<Inputs> inputs_;
  exchange::BoundedQueue<Frame> frames_;
  exchange::Flag stop_;
  Frame frame_;  ///< Being filled, on the simulation thread.
  std::thread thread_;
};

}  // namespace footing::simulation

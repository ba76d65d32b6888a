#pragma once

#include <utility>

#include "common/exchange/latest.h"
#include "daemon/simulation/gait_service/frame.h"

namespace footing::gait_service {

/// The gait engine on the simulation thread (see SimulationThread).
class GaitRun {
 public:
  using Inputs = gait_service::Inputs;
  using Frame = gait_service::Frame;

  GaitRun(engine::GaitEngine engine) : engine_(std::move(engine)) {}  // NOLINT: an engine is a run

  void StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame);
  void FillOnSimThread(Frame& frame) { frame.output = engine_.Output(); }
  void TakenOnSimThread(Frame& frame) const;

  const engine::GaitEngine& engine() const { return engine_; }

 private:
  engine::GaitEngine engine_;
};

}  // namespace footing::gait_service

#pragma once

#include <cstdint>
#include <utility>

#include "common/runtime/latest.h"
#include "daemon/simulation/gait_service/frame.h"
#include "daemon/simulation/gait_service/track_exchange.h"

namespace footing::gait_service {

/// The gait engine on the simulation thread (see SimulationThread).
class GaitRun {
 public:
  using Inputs = gait_service::Inputs;
  using Frame = gait_service::Frame;

  GaitRun(engine::GaitEngine engine, TrackExchange& tracks)
      : engine_(std::move(engine)), tracks_(&tracks) {}

  void StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame);
  void FillOnSimThread(Frame& frame) { frame.output = engine_.Output(); }
  void TakenOnSimThread(Frame& frame) const;

  const engine::GaitEngine& engine() const { return engine_; }

 private:
  void UseTrackOnSimThread(std::uint64_t number, Frame& frame);

  engine::GaitEngine engine_;
  TrackExchange* tracks_;
};

}  // namespace footing::gait_service

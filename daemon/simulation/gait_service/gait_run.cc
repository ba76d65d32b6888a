#include "daemon/simulation/gait_service/gait_run.h"

#include <memory>
#include <utility>

#include "common/runtime/clock.h"

namespace footing::gait_service {

void GaitRun::UseTrackOnSimThread(std::uint64_t number, Frame& frame) {
  std::unique_ptr<engine::TrackWorld> next;
  while (number != 0 && engine_.track().number != number && tracks_->next.Pop(next)) {
    engine_.UseTrack(*next);
    tracks_->done.Push(std::move(next));  // It has space for all that are on their way.
    frame.added_count = 0;                // Those were the former track's.
  }
}

void GaitRun::StepOnSimThread(exchange::Latest<Inputs>& inputs, Frame& frame) {
  // One input adds at most kMaxAppends segments, of which each has its place in the frame.
  const bool fits =
      frame.applied_count < kMaxApplied && frame.added_count + engine::kMaxAppends <= kMaxAdded;
  if (fits && inputs.Refresh()) {
    Applied& applied = frame.applied[static_cast<std::size_t>(frame.applied_count++)];
    applied.step = engine_.Output().step + 1;
    applied.inputs = inputs.Front();
    UseTrackOnSimThread(inputs.Front().engine.trial.track_number, frame);
  }
  engine_.Advance(inputs.Front().engine);
  const engine::EngineOutput& output = engine_.Output();
  if (output.append.added && frame.added_count < kMaxAdded) {
    frame.added[static_cast<std::size_t>(frame.added_count++)] = engine_.track().segments.back();
  }
  if (output.response.commanded == output.step) frame.command_ns = clock::MonotonicNs();
  if (output.response.taken_over == output.step) frame.contact_ns = clock::MonotonicNs();
  for (int i = 0; i < output.event_count && frame.event_count < kMaxFrameEvents; ++i) {
    frame.events[static_cast<std::size_t>(frame.event_count++)] =
        output.events[static_cast<std::size_t>(i)];
  }
}

void GaitRun::TakenOnSimThread(Frame& frame) const {
  frame.event_count = 0;
  frame.applied_count = 0;
  frame.added_count = 0;
}

}  // namespace footing::gait_service

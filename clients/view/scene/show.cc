#include "clients/view/scene/show.h"

#include "common/units/units.h"

namespace footing::scene {

void Show::Take(const Update& update, std::int64_t now_ns) {
  if (update.live) model_.tally.publish_to_view.Add(now_ns - update.host_ns);
  Apply(model_, update);
}

WorldFrame Show::FrameAt(std::int64_t now_ns) {
  if (replays_falls_ && model_.replay.clips() > replayed_) model_.replay.Start(now_ns);
  replayed_ = model_.replay.clips();
  if (auto again = model_.replay.At(now_ns)) return *again;
  model_.replay.Stop();
  return model_.playout.empty() ? frame_ : model_.playout.At(now_ns);
}

void Show::ToggleReplay(std::int64_t now_ns) {
  if (model_.replay.At(now_ns)) {
    model_.replay.Stop();
  } else {
    model_.replay.Start(now_ns);
  }
}

Show::Shot Show::At(std::int64_t now_ns, bool frozen, const StageOptions& options) {
  const double passed_s = last_ns_ == 0 ? 0 : NanosecondsToSeconds(now_ns - last_ns_);
  last_ns_ = now_ns;
  if (frozen && !frozen_) frozen_ = std::make_unique<const Frozen>(Frozen{model_, now_ns});
  if (!frozen) {
    frozen_.reset();
    frame_ = FrameAt(now_ns);
  }
  ++model_.tally.frames_drawn;
  return {frame_, stage_.Advance(model_, frame_, now_ns, frozen ? 0 : passed_s, options),
          frozen_ ? frozen_->model : model_, frozen_ ? frozen_->at_ns : now_ns};
}

}  // namespace footing::scene

#include "clients/view/scene/show.h"

#include "common/base/units.h"

namespace footing::scene {

void Show::Take(const Update& update, std::int64_t now_ns) {
  if (update.live) model_.tally.publish_to_view.Add(now_ns - update.host_ns);
  Apply(model_, update);
}

WorldFrame Show::FrameAt(std::int64_t now_ns) {
  if (replays_falls_ && model_.replay.clips() > replayed_) model_.replay.Start(now_ns);
  replayed_ = model_.replay.clips();
  if (!model_.replay.At(now_ns)) model_.replay.Stop();
  return ShownAt(now_ns);
}

WorldFrame Show::ShownAt(std::int64_t now_ns) const {
  if (auto again = model_.replay.At(now_ns)) return *again;
  return model_.playout.empty() ? frame_ : model_.playout.At(now_ns);
}

double Show::PassedS(std::int64_t now_ns) const {
  return last_ns_ == 0 ? 0 : NanosecondsToSeconds(now_ns - last_ns_);
}

void Show::ToggleReplay(std::int64_t now_ns) {
  if (model_.replay.At(now_ns)) {
    model_.replay.Stop();
  } else {
    model_.replay.Start(now_ns);
  }
}

Show::Shot Show::At(std::int64_t now_ns, bool frozen, const StageOptions& options) {
  const double passed_s = PassedS(now_ns);
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

void Show::Step(std::int64_t now_ns, const StageOptions& options) {
  frame_ = FrameAt(now_ns);
  stage_.Advance(model_, frame_, now_ns, PassedS(now_ns), options);
  last_ns_ = now_ns;
}

Show::Shot Show::Peek(std::int64_t now_ns, const StageOptions& options) {
  ++model_.tally.frames_drawn;
  const WorldFrame frame = ShownAt(now_ns);
  Stage ahead = stage_;
  return {frame, ahead.Advance(model_, frame, now_ns, PassedS(now_ns), options), model_, now_ns};
}

}  // namespace footing::scene

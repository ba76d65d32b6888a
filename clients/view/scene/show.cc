#include "clients/view/scene/show.h"

#include "common/units/units.h"

namespace footing::scene {

void Show::Take(const Update& update, std::int64_t now_ns) {
  if (update.live) model_.tally.publish_to_view.Add(now_ns - update.host_ns);
  Apply(model_, update);
}

Show::Shot Show::At(std::int64_t now_ns, bool frozen, const StageOptions& options) {
  const double passed_s = last_ns_ == 0 ? 0 : NanosecondsToSeconds(now_ns - last_ns_);
  last_ns_ = now_ns;
  if (!frozen && !model_.playout.empty()) frame_ = model_.playout.At(now_ns);
  ++model_.tally.frames_drawn;
  return {frame_, stage_.Advance(model_, frame_, frozen ? 0 : passed_s, options)};
}

}  // namespace footing::scene

#include "common/guide/set_up.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::guide {

SetUp::Step SetUp::StepOf(Item item) {
  switch (item) {
    case Item::kAdapter:
      return AdapterStep();
    case Item::kPairing:
      return PairingStep();
    case Item::kRoles:
      return RolesStep();
    case Item::kLayout:
      return LayoutStep();
    case Item::kTare:
      return TareStep();
    case Item::kMounting:
      return MountingStep();
    case Item::kWeigh:
      return WeighStep();
    case Item::kCamera:
      return CameraStep();
    case Item::kChecks:
      return ChecksStep();
  }
  return AdapterStep();
}

SetUp::SetUp(SetUpOptions options, std::vector<Item> items)
    : options_(std::move(options)), items_(std::move(items)) {
  options_.mount_all |= std::find(items_.begin(), items_.end(), Item::kMounting) != items_.end();
  if (items_.empty()) items_ = AllItems();
  step_ = StepOf(items_.front());
}

void SetUp::Begin() {
  if (index_ < items_.size()) step_ = StepOf(items_[index_]);
  progress_ns_ = 0;
  asked_.clear();
}

Progress SetUp::Advance(const Situation& now) {
  Progress progress;
  if (index_ >= items_.size()) {
    progress.finished = true;
    return progress;
  }
  progress = std::visit([&](auto& step) { return step.Advance(now, options_); }, step_);
  if (progress_ns_ == 0 || progress.prompt != asked_ || !progress.actions.empty()) {
    progress_ns_ = now.now_ns;
    asked_ = progress.prompt;
  }
  const bool given_up =
      !progress.finished && now.now_ns - progress_ns_ > SecondsToNanoseconds(options_.patience_s);
  if (given_up) {
    progress.results = {Outcome(items_[index_], "", false, 0, "",
                                "timed out: " + asked_ + " " + progress.feedback)};
  } else if (!progress.finished) {
    if (!refused_.empty() && !progress.prompt.empty()) {
      progress.prompt += " (Again, because " + refused_ + ")";
    }
    return progress;
  }
  const auto bad = std::find_if(progress.results.begin(), progress.results.end(),
                                [](const auto& result) { return !result.passed; });
  if (bad != progress.results.end() && !given_up && ++tried_ < options_.tries) {
    refused_ = bad->note;
    progress.results.clear();
    Begin();
  } else {
    results_.insert(results_.end(), progress.results.begin(), progress.results.end());
    refused_.clear();
    tried_ = 0;
    ++index_;
    Begin();
  }
  progress.finished = index_ >= items_.size();
  return progress;
}

}  // namespace footing::guide

#include "clients/view/scene/fall_replay.h"

#include <algorithm>

#include "clients/view/scene/playout.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr std::size_t kMaxFrames = 2048;

bool Fell(const WorldFrame& before, const WorldFrame& after) {
  for (const CharacterPose& now : after.characters) {
    for (const CharacterPose& then : before.characters) {
      if (now.character == then.character && now.gait.falls > then.gait.falls) return true;
    }
  }
  return false;
}

bool PutBack(const WorldFrame& before, const WorldFrame& after) {
  for (const CharacterPose& now : after.characters) {
    for (const CharacterPose& then : before.characters) {
      if (now.character == then.character && (now.com_m - then.com_m).norm() > kPutBackM) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

void FallReplay::TakeClip(double fall_s) {
  // A second fall within the first one's clip belongs to it.
  if (filling_) return;
  clip_ = recent_;
  fall_s_ = fall_s;
  filling_ = true;
  started_ns_.reset();
}

void FallReplay::Push(const WorldFrame& frame) {
  if (!recent_.empty() && frame.time_s < recent_.back().time_s) *this = {};
  if (!recent_.empty() && frame.time_s == recent_.back().time_s) return;
  const bool fell = !recent_.empty() && Fell(recent_.back(), frame);
  const bool put_back = !recent_.empty() && PutBack(recent_.back(), frame);
  // What came before a put-back is another walk.
  if (put_back) recent_.clear();
  if (fell) TakeClip(frame.time_s);
  if (filling_ && (put_back || frame.time_s > fall_s_ + kAfterS)) {
    filling_ = false;
    ++clips_;
  }
  if (filling_) clip_.push_back(frame);
  recent_.push_back(frame);
  while (recent_.size() > kMaxFrames || recent_.front().time_s < frame.time_s - kBeforeS) {
    recent_.pop_front();
  }
}

void FallReplay::Start(std::int64_t now_ns) {
  if (ready()) started_ns_ = now_ns;
}

double FallReplay::ClipTimeS(std::int64_t now_ns) const {
  if (!started_ns_ || clip_.empty()) return 0;
  return clip_.front().time_s + kPace * NanosecondsToSeconds(now_ns - *started_ns_);
}

std::optional<WorldFrame> FallReplay::At(std::int64_t now_ns) const {
  if (!started_ns_ || !ready()) return std::nullopt;
  const double time_s = ClipTimeS(now_ns);
  const auto after = std::find_if(clip_.begin(), clip_.end(),
                                  [time_s](const WorldFrame& f) { return f.time_s > time_s; });
  if (after == clip_.end()) return std::nullopt;
  if (after == clip_.begin()) return clip_.front();
  const WorldFrame& before = *std::prev(after);
  return Between(before, *after, (time_s - before.time_s) / (after->time_s - before.time_s));
}

}  // namespace footing::scene

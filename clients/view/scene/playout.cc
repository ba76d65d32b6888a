#include "clients/view/scene/playout.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr std::int64_t kKeptNs = 3 * kNanosecondsPerSecond / 2;
constexpr std::size_t kMaxPlayoutFrames = 512;

Eigen::Vector3d Mix(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
  return a + share * (b - a);
}

CharacterPose Between(const CharacterPose& a, const CharacterPose& b, double share) {
  CharacterPose between = a;
  between.com_m = Mix(a.com_m, b.com_m, share);
  between.com_velocity_mps = Mix(a.com_velocity_mps, b.com_velocity_mps, share);
  if (a.body && b.body) between.body = share < 0.5 ? a.body : b.body;
  for (std::size_t i = 0; i < between.links.size(); ++i) {
    between.links[i].position_m = Mix(a.links[i].position_m, b.links[i].position_m, share);
    between.links[i].orientation = a.links[i].orientation.slerp(share, b.links[i].orientation);
  }
  for (std::size_t i = 0; i < between.contacts.size(); ++i) {
    between.contacts[i].position_m = Mix(a.contacts[i].position_m, b.contacts[i].position_m, share);
  }
  return between;
}

bool Joinable(const CharacterPose& a, const CharacterPose& b) {
  return a.character == b.character && a.links.size() == b.links.size() &&
         a.contacts.size() == b.contacts.size() && (a.com_m - b.com_m).norm() < kPutBackM;
}

}  // namespace

WorldFrame Between(const WorldFrame& a, const WorldFrame& b, double share) {
  if (share >= 1) return b;
  if (share <= 0) return a;
  WorldFrame between = a;
  between.time_s = a.time_s + share * (b.time_s - a.time_s);
  for (std::size_t i = 0; i < std::min(a.characters.size(), b.characters.size()); ++i) {
    if (!Joinable(a.characters[i], b.characters[i])) continue;
    between.characters[i] = Between(a.characters[i], b.characters[i], share);
  }
  return between;
}

void Playout::Push(WorldFrame frame, std::int64_t received_ns) {
  if (!frames_.empty() && frame.time_s < frames_.back().frame.time_s) frames_.clear();
  if (!frames_.empty() && frame.time_s == frames_.back().frame.time_s) return;
  frames_.push_back({std::move(frame), received_ns});
  while (frames_.size() > kMaxPlayoutFrames ||
         frames_.front().received_ns < received_ns - kKeptNs) {
    frames_.pop_front();
  }
}

double Playout::ShownTime(std::int64_t now_ns) const {
  const std::int64_t base_ns = frames_.front().received_ns;
  double offset_s = 1e300;  // Viewer's clock minus simulation time, at the least delay.
  for (const Timed& timed : frames_) {
    offset_s =
        std::min(offset_s, NanosecondsToSeconds(timed.received_ns - base_ns) - timed.frame.time_s);
  }
  const std::size_t count = frames_.size();
  const double interval_s =
      count < 2 ? 0 : frames_[count - 1].frame.time_s - frames_[count - 2].frame.time_s;
  return NanosecondsToSeconds(now_ns - base_ns) - offset_s - interval_s;
}

WorldFrame Playout::At(std::int64_t now_ns) const {
  const double shown_s = ShownTime(now_ns);
  const auto after = std::find_if(frames_.begin(), frames_.end(), [shown_s](const Timed& timed) {
    return timed.frame.time_s > shown_s;
  });
  if (after == frames_.end()) return frames_.back().frame;
  if (after == frames_.begin()) return frames_.front().frame;
  const WorldFrame& a = std::prev(after)->frame;
  const WorldFrame& b = after->frame;
  return Between(a, b, (shown_s - a.time_s) / (b.time_s - a.time_s));
}

}  // namespace footing::scene

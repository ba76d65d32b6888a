#include "clients/view/scene/play_head.h"

#include <algorithm>

namespace footing::timeline {

PlayHead HeadAt(double begin_s, double end_s, double speed) {
  return {begin_s, std::max(begin_s, end_s), begin_s, speed, false};
}

PlayHead Sought(PlayHead head, double at_s) {
  head.at_s = std::clamp(at_s, head.begin_s, head.end_s);
  return head;
}

PlayHead Advanced(PlayHead head, double passed_s) {
  if (head.paused || passed_s <= 0) return head;
  return Sought(head, head.at_s + head.speed * passed_s);
}

double Faster(double speed) {
  for (const double one : kSpeeds) {
    if (one > speed) return one;
  }
  return kSpeeds.back();
}

double Slower(double speed) {
  double slower = kSpeeds.front();
  for (const double one : kSpeeds) {
    if (one < speed) slower = one;
  }
  return slower;
}

}  // namespace footing::timeline

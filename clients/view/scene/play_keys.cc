#include "clients/view/scene/play_keys.h"

#include <string_view>

namespace footing::timeline {
namespace {

constexpr double kStepS = 1;

PlayHead PausedAt(PlayHead head, double at_s) {
  head.paused = true;
  return Sought(head, at_s);
}

PlayHead AtSpeed(PlayHead head, double speed) {
  head.speed = speed;
  return head;
}

}  // namespace

std::optional<PlayAction> ActionOf(const char* key) {
  for (const PlayKey& one : kPlayKeys) {
    if (std::string_view(one.key) == key) return one.action;
  }
  return std::nullopt;
}

PlayHead Act(const PlayHead& head, PlayAction action, const Timeline& timeline, double frame_s) {
  switch (action) {
    case PlayAction::kPause: {
      // At the end it plays again from the beginning.
      PlayHead next = head.ended() ? Sought(head, head.begin_s) : head;
      next.paused = !head.ended() && !head.paused;
      return next;
    }
    case PlayAction::kBack:
      return Sought(head, head.at_s - kStepS);
    case PlayAction::kForward:
      return Sought(head, head.at_s + kStepS);
    case PlayAction::kFrameBack:
      return PausedAt(head, head.at_s - frame_s);
    case PlayAction::kFrameForward:
      return PausedAt(head, head.at_s + frame_s);
    case PlayAction::kFaster:
      return AtSpeed(head, Faster(head.speed));
    case PlayAction::kSlower:
      return AtSpeed(head, Slower(head.speed));
    case PlayAction::kNextFailure: {
      const auto at_s = NextFailure(timeline, head.at_s);
      return at_s ? PausedAt(head, *at_s) : head;
    }
    case PlayAction::kPreviousFailure: {
      const auto at_s = PreviousFailure(timeline, head.at_s);
      return at_s ? PausedAt(head, *at_s) : head;
    }
    case PlayAction::kNextTrial:
      return Sought(head, NextTrial(timeline, head.at_s).value_or(head.at_s));
    case PlayAction::kBegin:
      return Sought(head, head.begin_s);
    case PlayAction::kEnd:
      return Sought(head, head.end_s);
  }
  return head;
}

}  // namespace footing::timeline

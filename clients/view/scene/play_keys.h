#pragma once

#include <array>
#include <optional>

#include "clients/view/scene/play_head.h"
#include "clients/view/scene/timeline.h"

namespace footing::timeline {

/// What a person can ask of playback.
enum class PlayAction {
  kPause,
  kBack,
  kForward,
  kFrameBack,
  kFrameForward,
  kFaster,
  kSlower,
  kNextFailure,
  kPreviousFailure,
  kNextTrial,
  kBegin,
  kEnd,
};

/// A key that asks for it. Letters and signs are as on the keyboard, in capitals; the others have
/// their names.
struct PlayKey {
  const char* key;
  PlayAction action;
};

/// All of them; several keys may ask for the same.
inline constexpr std::array<PlayKey, 15> kPlayKeys{{
    {"space", PlayAction::kPause},
    {"left", PlayAction::kBack},
    {"right", PlayAction::kForward},
    {",", PlayAction::kFrameBack},
    {".", PlayAction::kFrameForward},
    {"up", PlayAction::kFaster},
    {"down", PlayAction::kSlower},
    {"+", PlayAction::kFaster},
    {"=", PlayAction::kFaster},
    {"-", PlayAction::kSlower},
    {"N", PlayAction::kNextFailure},
    {"P", PlayAction::kPreviousFailure},
    {"T", PlayAction::kNextTrial},
    {"home", PlayAction::kBegin},
    {"end", PlayAction::kEnd},
}};

/// Lines for the list of keys: the keys and what they do.
inline constexpr std::array<std::array<const char*, 2>, 11> kPlayKeyHelp{{
    {"space", "pause or continue"},
    {"left, right", "1 s back, 1 s forward"},
    {", and .", "one frame back, one forward"},
    {"up, down", "faster, slower: 0.1 to 8; also + and -"},
    {"N, P", "next failure, previous failure"},
    {"T", "the next trial"},
    {"Home, End", "the beginning, the end"},
    {"L", "show or hide the timeline"},
    {"mouse", "click or drag on the timeline"},
    {"", "drag above it to turn the view, wheel to zoom"},
    {"Z", "the first view again; also a double click"},
}};

/// The action of a key; nothing when it has none.
std::optional<PlayAction> ActionOf(const char* key);

/// Carries it out. A frame is `frame_s` long. It pauses at a failure and at a step by frames; the
/// head stays where there is no failure or trial to go to.
PlayHead Act(const PlayHead& head, PlayAction action, const Timeline& timeline, double frame_s);

}  // namespace footing::timeline

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/stream/trial.h"

/// Contents of a recording, by time. Positions are seconds from the timeline's zero: the
/// recording's first tick, or where trials are compared the instant they are aligned at.
namespace footing::timeline {

/// An attempt that failed.
struct FailureMark {
  double at_s = 0;
  std::uint64_t number = 0;  ///< Number among the server's failures, from 1; 0: unknown.
  stream::FailureCause cause = stream::FailureCause::kUnspecified;
  std::string trial;  ///< Its id; empty: none.
  double trial_time_s = 0;
  double distance_m = 0;   ///< Along the track.
  bool withdrawn = false;  ///< It does not count.
};

/// The task of a trial was done.
struct TaskMark {
  double at_s = 0;
  std::string task;
};

/// A client marked this instant.
struct MarkerMark {
  double at_s = 0;
  std::string text;
  std::optional<double> value;
};

/// Something else happened that a person should read: a device lost or back, a T-pose taken, ...
struct EventMark {
  double at_s = 0;
  std::string text;
};

/// One trial, from when it was made ready to its end.
struct TrialMark {
  std::string id;            ///< Empty: nobody gave it one.
  std::uint64_t number = 0;  ///< Number of the trial, from 1; 0: a server's initial one.
  std::string track;
  std::string task;
  double begin_s = 0;             ///< It is ready, or the recording begins.
  std::optional<double> start_s;  ///< It crosses the start line: its clock is 0.
  std::optional<double> end_s;    ///< It crosses the finish line or is stopped.
  stream::TrialPhase phase = stream::TrialPhase::kReady;  ///< At its end, or at the recording's.
  double time_s = 0;                                      ///< Its clock then.
};

/// Trials, failures, tasks, markers and other events of a recording, s from its zero.
struct Timeline {
  double begin_s = 0;
  double end_s = 0;
  std::vector<TrialMark> trials;  ///< By time, as all marks.
  std::vector<FailureMark> failures;
  std::vector<TaskMark> tasks;
  std::vector<MarkerMark> markers;
  std::vector<EventMark> events;

  double length_s() const { return end_s - begin_s; }
};

/// The trials that markers frame: "begin NAME" begins one and "end NAME" ends it, for tasks that
/// another program leads. Its clock starts where it begins. One that is begun again before its end
/// is another trial; an end without a beginning is a marker only.
std::vector<TrialMark> TrialsOf(const std::vector<MarkerMark>& markers);

/// Marks of one timeline: more are refused before memory is taken.
inline constexpr std::size_t kMostMarks = 100'000;

/// Timeline seen from another zero: every position less `zero_s`.
Timeline Shifted(Timeline timeline, double zero_s);

/// The first failure behind a position, or the last one before it; withdrawn ones count too. In a
/// recording without failures, of its markers and other events. Nothing when there is none. Marks
/// within 1 ms of the position are not behind or before it.
std::optional<double> NextFailure(const Timeline& timeline, double at_s);
std::optional<double> PreviousFailure(const Timeline& timeline, double at_s);
/// The beginning of the first trial behind a position; after the last one, of the first of all.
std::optional<double> NextTrial(const Timeline& timeline, double at_s);

/// The trial that goes on at a position: the last one that has begun. Null before the first.
const TrialMark* TrialAt(const Timeline& timeline, double at_s);

/// Failures of a trial by cause up to a position, without those withdrawn and those behind its end.
stream::FailureCounts FailuresOf(const Timeline& timeline, const TrialMark& trial, double until_s);

/// Name for a person: "p07-1"; "trial 2" of one without an id.
std::string NameOf(const TrialMark& trial);

/// The trial of this name (NameOf) or number ("#2"). UsageError that lists those there are,
/// InvalidData when the recording has none.
Result<TrialMark> FindTrial(const Timeline& timeline, const std::string& name);

/// The part of the timeline in which one trial plays: from when it is ready to 2 s after its end,
/// but not into the next one. Marks of others are left out; the zero stays.
Timeline Only(const Timeline& timeline, const TrialMark& trial);

/// Paces of playback: recorded seconds a second.
inline constexpr std::array kSpeeds{0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

/// Position of playback on a timeline, and its pace.
struct PlayHead {
  double begin_s = 0;
  double end_s = 0;
  double at_s = 0;
  double speed = 1;
  bool paused = false;

  bool ended() const { return at_s >= end_s; }
};

/// Play head at `begin_s`.
PlayHead HeadAt(double begin_s, double end_s, double speed);

/// Moves to a position, or to the nearest end.
PlayHead Sought(PlayHead head, double at_s);
/// The position after `passed_s` of the viewer's time; it stops at the end.
PlayHead Advanced(PlayHead head, double passed_s);

/// The next pace of kSpeeds above or below the present one, which need not be among them; the last
/// one where there is no other.
double Faster(double speed);
double Slower(double speed);

/// Playback commands of a person.
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
inline constexpr std::array<std::array<const char*, 2>, 10> kPlayKeyHelp{{
    {"space", "pause or continue"},
    {"left, right", "1 s back, 1 s forward"},
    {", and .", "one frame back, one forward"},
    {"up, down", "faster, slower: 0.1 to 8; also + and -"},
    {"N, P", "next, previous failure; else event"},
    {"T", "the next trial"},
    {"Home, End", "the beginning, the end"},
    {"L", "show or hide the timeline"},
    {"timeline", "click or drag on it to seek"},
    {"Z", "the first view again; also a double click"},
}};

/// The action of a key; nothing when it has none.
std::optional<PlayAction> ActionOf(const char* key);

/// Carries it out. A frame is `frame_s` long. It pauses at a failure and at a step by frames; the
/// head stays where there is no failure or trial to go to.
PlayHead Act(const PlayHead& head, PlayAction action, const Timeline& timeline, double frame_s);

/// Instant at which two trials are aligned: it is 0 of both.
enum class Alignment {
  kStart,   ///< The start line, or the beginning of a trial that never crossed it.
  kFinish,  ///< The end of both trials.
  kWall,    ///< The same time of day; 0 is the beginning of the first one.
};

/// One of two recordings to be compared.
struct Side {
  Timeline timeline;  ///< Part played, usually one trial; zero is the recording's own.
  /// UNIX time of the recording's zero; nothing when it does not say.
  std::optional<std::int64_t> wall_of_zero_ns;
};

/// The position, on each side's own timeline, that becomes its 0. UsageError when a side does not
/// have what the alignment needs.
Result<std::array<double, 2>> ZerosOf(const std::array<Side, 2>& sides, Alignment alignment);

/// The 0 of a trial that plays alone: where its clock starts.
double ZeroOf(const Timeline& trial);

/// State of one side while both play, at a common position within or beside its own time.
struct SideState {
  double at_s = 0;        ///< Position to show.
  bool before = false;    ///< It has not begun: its first state is shown.
  bool finished = false;  ///< It is over: its last state is shown.
};
/// State of a side at the common position `at_s`.
SideState SideAt(const Timeline& side, double at_s);

/// Marks of both, over the time in which either plays.
Timeline Joined(const Timeline& first, const Timeline& second);

/// "0:12.3", "-0:01.5", "1:02:03.4".
std::string ClockText(double seconds);

/// "0:12.3 of 1:00.0   speed 0.25   paused".
std::string PositionText(const PlayHead& head);

/// "trial p07-1   failed attempts 2 (curve 1, jump 1)": what is so at a position; empty without a
/// trial.
std::string TrialText(const Timeline& timeline, double at_s);

/// "ended", "not begun", or empty while it plays.
std::string StateText(const SideState& state);

/// A mark's position and its text.
using MarkText = std::pair<double, std::string>;
/// All marks as text, by time.
std::vector<MarkText> MarkTexts(const Timeline& timeline);
/// One line a mark, by time, as a terminal shows them.
std::vector<std::string> MarkLines(const Timeline& timeline);
/// The mark nearest to a position, at most `within_s` away: "0:12.3  T-pose taken: 71.2 kg"; the
/// position alone where there is none.
std::string TextAt(const Timeline& timeline, double at_s, double within_s);

}  // namespace footing::timeline

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/stream/trial.h"

/// What a recording holds, by time. Positions are seconds from the timeline's zero: the recording's
/// first tick, or where trials are compared the instant they are aligned at.
namespace footing::timeline {

/// An attempt that failed.
struct FailureMark {
  double at_s = 0;
  std::uint64_t number = 0;  ///< Of the server's failures, from 1; 0: unknown.
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

/// One trial, from when it was made ready to its end.
struct TrialMark {
  std::string id;            ///< Empty: nobody gave it one.
  std::uint64_t number = 0;  ///< Of the trials started, from 1; 0: the one a server begins with.
  std::string track;
  std::string task;
  double begin_s = 0;             ///< It is ready, or the recording begins.
  std::optional<double> start_s;  ///< It crosses the start line: its clock is 0.
  std::optional<double> end_s;    ///< It crosses the finish line or is stopped.
  stream::TrialPhase phase = stream::TrialPhase::kReady;  ///< At its end, or at the recording's.
  double time_s = 0;                                      ///< Its clock then.
};

struct Timeline {
  double begin_s = 0;
  double end_s = 0;
  std::vector<TrialMark> trials;  ///< By time, as all marks.
  std::vector<FailureMark> failures;
  std::vector<TaskMark> tasks;

  double length_s() const { return end_s - begin_s; }
};

/// Marks of one timeline: more are refused before memory is taken.
inline constexpr std::size_t kMostMarks = 100'000;

/// The same seen from another zero: every position less `zero_s`.
Timeline Shifted(Timeline timeline, double zero_s);

/// The first failure behind a position, or the last one before it; withdrawn ones count too.
/// Nothing when there is none. Marks within 1 ms of the position are not behind or before it.
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

}  // namespace footing::timeline

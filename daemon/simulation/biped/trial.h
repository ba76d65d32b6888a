#pragma once

#include <cstdint>

#include "common/stream/character.h"

/// A trial of the gait paper's user study (section 8.1): one run along a track from its start line
/// to its finish line, with a task at the mark of a straight track. Pure; time is an argument.
namespace footing::trial {

/// After a failed transition the user gets so much of the track before the mark, and after a failed
/// jump before the pit, to bring the character into its gait again, m.
inline constexpr double kRunUpM = 6;
/// A transition is done when the new gait has run for this duration, s. After a jump any gait may
/// follow.
inline constexpr double kTransitionHeldS = 1.0;
/// At a stop the body is slower than this, m/s.
inline constexpr double kStoppedMps = 0.3;
/// The gait before the mark must have run within this duration before it, s: whoever changes a
/// moment too early has still made the transition.
inline constexpr double kEarlyS = 1.0;

/// State of a trial. A plain value.
struct TrialMemory {
  stream::TrialPhase phase = stream::TrialPhase::kReady;
  double started_s = 0;  ///< When the start line was crossed.
  double ended_s = 0;    ///< When the trial finished or was stopped.
  int task = -1;
  stream::TaskPhase task_phase = stream::TaskPhase::kUnspecified;
  double before_s = 0;      ///< When the gait before the mark last ran.
  double gait_since_s = 0;  ///< Since when the gait after the mark runs; negative: it does not.
  stream::FailureCounts failures;
  std::uint64_t operator_put_backs = 0;
};

/// A new trial: ready before the start line. A `task` that the track does not have means none.
TrialMemory Begin(const stream::Track& track, int task);

/// The task that a seed draws among a track's; -1 where it has none.
int DrawTask(const stream::Track& track, std::uint64_t seed);

/// Observations of the character in a trial, while it stands on its feet.
struct TrialCues {
  double time_s = 0;
  double distance_m = 0;  ///< Along the track.
  stream::Gait gait = stream::Gait::kStep;
  double speed_mps = 0;
};

/// Changes of a trial at this moment.
struct TrialNews {
  bool started = false;
  bool finished = false;
  bool task_done = false;
  const char* failed = nullptr;  ///< Why the transition failed, as text of static storage.
};

/// One step of a trial that goes on; a trial that is over stays as it is.
TrialNews Advance(const stream::Track& track, const TrialCues& cues, TrialMemory& memory);

/// Ends a trial that is not over.
void Stop(double time_s, TrialMemory& memory);

/// True until the trial is finished or stopped.
bool GoesOn(const TrialMemory& memory);

/// Cause under which a failure is counted in this trial: on a straight track, which has a mark,
/// leaving the ribbon is `straightness`, and every failure from the mark until the task is done is
/// `transition`.
stream::FailureCause Attribute(const stream::Track& track, const TrialMemory& memory,
                               stream::FailureCause cause);

/// How far back along the track a character is put after a failure, m: `distance_m`; after a failed
/// transition to kRunUpM before the mark; and after a failed jump on a track that does not help
/// over pits by kRunUpM. `at_m` is where it failed.
double PutBackDistance(const stream::Track& track, stream::FailureCause cause, double at_m,
                       double distance_m);

/// After the character was put back to `at_m`: a task behind which it now stands is ahead again.
void TakePutBack(const stream::Track& track, double at_m, TrialMemory& memory);

/// The time on the trial's clock, s.
double TimeOf(const TrialMemory& memory, double time_s);

}  // namespace footing::trial

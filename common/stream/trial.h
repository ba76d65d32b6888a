#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace footing::stream {

/// What a failure is attributed to, as the gait paper counts them (section 8.1).
enum class FailureCause {
  kUnspecified = 0,
  kSimulation = 1,    ///< The character fell on ground that it could stand on.
  kCurve = 2,         ///< It left the ribbon.
  kJump = 3,          ///< A foot went into a pit.
  kStraightness = 4,  ///< It left the ribbon of a straight track.
  kTransition = 5,    ///< The change of gait that a straight track asks for failed.
};

/// All causes, in the order in which they are listed.
inline constexpr std::array kFailureCauses{FailureCause::kSimulation, FailureCause::kCurve,
                                           FailureCause::kJump, FailureCause::kStraightness,
                                           FailureCause::kTransition};

/// "simulation", "curve", "jump", "straightness", "transition".
const char* Name(FailureCause cause);

/// Failures by cause.
struct FailureCounts {
  std::uint64_t simulation = 0;
  std::uint64_t curve = 0;
  std::uint64_t jump = 0;
  std::uint64_t straightness = 0;
  std::uint64_t transition = 0;

  friend bool operator==(const FailureCounts&, const FailureCounts&) = default;
};

/// The count of one cause; null for kUnspecified.
std::uint64_t* MutableCountOf(FailureCause cause, FailureCounts& counts);
/// The same as a value; 0 for kUnspecified.
std::uint64_t CountOf(FailureCause cause, const FailureCounts& counts);
std::uint64_t Total(const FailureCounts& counts);
/// What is left of the counts without the others, each at least 0.
FailureCounts Without(FailureCounts counts, const FailureCounts& others);

enum class TrialPhase { kUnspecified = 0, kReady = 1, kRunning = 2, kFinished = 3, kStopped = 4 };
/// "ready", "running", "finished", "stopped".
const char* Name(TrialPhase phase);

/// How far a track's task is; kUnspecified where the trial has none.
enum class TaskPhase { kUnspecified = 0, kAhead = 1, kDue = 2, kDone = 3 };

/// How a trial stands: one run along a track, from its start line to its finish line.
struct TrialProgress {
  TrialPhase phase = TrialPhase::kUnspecified;
  double time_s = 0;             ///< Since the start line; stands still once the trial is over.
  double distance_m = 0;         ///< Along the track's centre line.
  double lateral_offset_m = 0;   ///< Of the body from the centre line, left positive.
  double heading_error_rad = 0;  ///< Of the body's yaw against the centre line, left positive.
  bool on_track = false;         ///< The body is over the ribbon.
  FailureCounts failures;        ///< Of this trial.
  std::uint64_t operator_put_backs = 0;
  int task = -1;  ///< Index among the track's tasks; -1: none.
  TaskPhase task_phase = TaskPhase::kUnspecified;
};

/// The same with what the client and the track call it.
struct TrialState {
  TrialProgress progress;
  std::string trial;         ///< Id that the client chose; empty before the first one.
  std::uint64_t number = 0;  ///< Of the trials started so far.
  std::string track;
  std::uint64_t seed = 0;
  double finish_m = 0;                   ///< 0: no finish line.
  double to_mark_m = 0;                  ///< From the body to the mark; negative behind it.
  std::string task;                      ///< Name; empty: none.
  std::string instruction;               ///< The task for the screen.
  std::uint64_t withdrawn_failures = 0;  ///< Not among the failures any more.
};

}  // namespace footing::stream

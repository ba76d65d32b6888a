#include "daemon/simulation/biped/trial.h"

#include <algorithm>
#include <cmath>

namespace footing::trial {
namespace {

using stream::Gait;
using stream::TaskPhase;
using stream::TrialPhase;

const stream::TrackTask* TaskOf(const stream::Track& track, const TrialMemory& memory) {
  const auto index = static_cast<std::size_t>(memory.task);
  return memory.task >= 0 && index < track.tasks.size() ? &track.tasks[index] : nullptr;
}

/// At the mark: the task is due, or its first gait is missing.
const char* Cross(const stream::TrackTask& task, const TrialCues& cues, TrialMemory& memory) {
  memory.task_phase = TaskPhase::kDue;
  memory.gait_since_s = -1;
  const bool prepared =
      task.before == Gait::kUnspecified || cues.time_s - memory.before_s <= kEarlyS;
  return prepared ? nullptr : "the gait before the line was not the task's";
}

bool RunsTask(const stream::TrackTask& task, const TrialCues& cues) {
  if (cues.gait != task.after) return false;
  return task.after != Gait::kStep || std::fabs(cues.speed_mps) < kStoppedMps;
}

/// True once the task's gait has run long enough.
bool IsDone(const stream::TrackTask& task, const TrialCues& cues, TrialMemory& memory) {
  const bool runs = RunsTask(task, cues);
  const bool jumped = task.after == Gait::kJump && memory.gait_since_s >= 0;
  if (!runs && !jumped) memory.gait_since_s = -1;
  if (runs && memory.gait_since_s < 0) memory.gait_since_s = cues.time_s;
  return memory.gait_since_s >= 0 && cues.time_s - memory.gait_since_s >= kTransitionHeldS;
}

void AdvanceTask(const stream::Track& track, const stream::TrackTask& task, const TrialCues& cues,
                 TrialMemory& memory, TrialNews& news) {
  if (cues.gait == task.before) memory.before_s = cues.time_s;
  if (memory.task_phase == TaskPhase::kAhead && cues.distance_m >= track.mark_m) {
    news.failed = Cross(task, cues, memory);
    if (news.failed != nullptr) return;
  }
  if (memory.task_phase != TaskPhase::kDue) return;
  if (IsDone(task, cues, memory)) {
    memory.task_phase = TaskPhase::kDone;
    news.task_done = true;
  } else if (cues.distance_m > track.mark_m + track.task_within_m) {
    news.failed = "the task was not done";
  }
}

}  // namespace

TrialMemory Begin(const stream::Track& track, int task) {
  TrialMemory memory;
  memory.task = task;
  if (TaskOf(track, memory) == nullptr) {
    memory.task = -1;
    return memory;
  }
  memory.task_phase = TaskPhase::kAhead;
  memory.before_s = -INFINITY;
  return memory;
}

int DrawTask(const stream::Track& track, std::uint64_t seed) {
  if (track.tasks.empty()) return -1;
  // The finaliser of splitmix64: neighbouring seeds draw independently.
  std::uint64_t mixed = seed + 0x9e3779b97f4a7c15ull;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9ull;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebull;
  mixed ^= mixed >> 31;
  return static_cast<int>(mixed % track.tasks.size());
}

TrialNews Advance(const stream::Track& track, const TrialCues& cues, TrialMemory& memory) {
  TrialNews news;
  if (!GoesOn(memory)) return news;
  if (memory.phase == TrialPhase::kReady) {
    if (cues.distance_m < track.start_m) return news;
    memory.phase = TrialPhase::kRunning;
    memory.started_s = cues.time_s;
    news.started = true;
  }
  if (const stream::TrackTask* task = TaskOf(track, memory); task != nullptr) {
    AdvanceTask(track, *task, cues, memory, news);
    if (news.failed != nullptr) return news;
  }
  if (track.finish_m > 0 && cues.distance_m >= track.finish_m) {
    memory.phase = TrialPhase::kFinished;
    memory.ended_s = cues.time_s;
    news.finished = true;
  }
  return news;
}

void Stop(double time_s, TrialMemory& memory) {
  if (!GoesOn(memory)) return;
  if (memory.phase == TrialPhase::kReady) memory.started_s = time_s;
  memory.phase = TrialPhase::kStopped;
  memory.ended_s = time_s;
}

bool GoesOn(const TrialMemory& memory) {
  return memory.phase == TrialPhase::kReady || memory.phase == TrialPhase::kRunning;
}

stream::FailureCause Attribute(const stream::Track& track, const TrialMemory& memory,
                               stream::FailureCause cause) {
  if (track.tasks.empty()) return cause;
  if (GoesOn(memory) && memory.task_phase == TaskPhase::kDue) {
    return stream::FailureCause::kTransition;
  }
  return cause == stream::FailureCause::kCurve ? stream::FailureCause::kStraightness : cause;
}

double PutBackDistance(const stream::Track& track, stream::FailureCause cause, double at_m,
                       double distance_m) {
  if (cause == stream::FailureCause::kTransition) {
    return std::max(distance_m, at_m - (track.mark_m - kRunUpM));
  }
  const bool jump = cause == stream::FailureCause::kJump && !track.help_over_pits;
  return jump ? std::max(distance_m, kRunUpM) : distance_m;
}

void TakePutBack(const stream::Track& track, double at_m, TrialMemory& memory) {
  if (memory.task_phase != TaskPhase::kDue) return;
  memory.gait_since_s = -1;
  if (at_m >= track.mark_m) return;
  memory.task_phase = TaskPhase::kAhead;
  memory.before_s = -INFINITY;
}

double TimeOf(const TrialMemory& memory, double time_s) {
  switch (memory.phase) {
    case TrialPhase::kRunning:
      return time_s - memory.started_s;
    case TrialPhase::kFinished:
    case TrialPhase::kStopped:
      return memory.ended_s - memory.started_s;
    case TrialPhase::kReady:
    case TrialPhase::kUnspecified:
      return 0;
  }
  return 0;
}

}  // namespace footing::trial

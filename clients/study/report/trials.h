#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "clients/study/report/event.h"

namespace footing::study::records {

/// The outcome of a trial that lost a device: it does not count.
inline constexpr const char* kDeviceLost = "device_lost";
/// The outcome of a trial that a server, the lease or the recording has ended: it does not count.
inline constexpr const char* kBrokenOff = "broken_off";
/// The outcome of a trial during which the program was interrupted or killed: it does not count.
inline constexpr const char* kInterrupted = "interrupted";

/// One failure during a trial.
struct Failure {
  std::uint64_t number = 0;  ///< The server's.
  std::string kind;          ///< Name of a stream::FailureCause.
  double trial_time_s = 0;
  double distance_m = 0;
  bool undone = false;
};

/// Duration of one stage of stream::ResponseTimes, from the participant's motion to the frame that
/// shows it.
struct StageTime {
  std::string stage;
  double ms = 0;
};
using Response = std::vector<StageTime>;

/// One attempt at a trial.
struct Trial {
  std::string id;  ///< Unique among all participants.
  std::string participant;
  std::string phase;
  std::string interface;
  std::string kind;  ///< "straight" or "test_track".
  std::string track;
  std::string task;
  std::size_t position = 0;  ///< Place of the interface in the participant's order, from 1.
  std::size_t attempt = 0;
  std::int64_t started_wall_ns = 0;
  /// "finished", "timed_out", "stopped", kDeviceLost, kBrokenOff, kInterrupted.
  std::string outcome;
  double time_s = 0;  ///< Time from the start line, put-backs included.
  double distance_m = 0;
  double heading_oscillation_rad = 0;  ///< Standard deviation of the heading error; NaN: unknown.
  double anticipation_s = 0;  ///< Command before the line of the task; NaN: not done, or no task.
  std::string recording;
  bool synthetic = false;
  std::vector<Failure> failures;
  std::vector<Response> responses;

  std::size_t Count(const std::string& kind) const;  ///< Failures of a kind, without those undone.
  std::size_t failure_count() const;
  double time_to_first_failure_s() const;  ///< NaN: none.
};

/// Rating of one item by a participant.
struct Rating {
  std::string participant;
  std::string interface;  ///< Empty: of the whole study.
  std::string item;       ///< "exertion" for the exertion.
  double value = 0;
  bool synthetic = false;
  bool at_end = false;  ///< Asked in the final survey.
};

/// Free-text answer of a participant to one question.
struct Answer {
  std::string participant;
  std::string interface;
  std::string question;
  std::string text;
  bool synthetic = false;
  bool at_end = false;  ///< Asked in the final survey.
};

/// Results in the journal of one participant. A repeated survey replaces the earlier one.
struct Records {
  std::string participant;
  std::vector<std::string> interfaces;  ///< In their order.
  bool finished = false;
  bool withdrawn = false;
  bool synthetic = false;
  bool simulated_time = false;
  std::map<std::string, double> active_s;  ///< Time in motion, by interface.
  std::vector<Trial> trials;               ///< All attempts, in the order in which they began.
  std::vector<Rating> ratings;
  std::vector<Answer> answers;
};

/// Whether a trial with this outcome counts.
bool EndedInOrder(const std::string& outcome);

/// Collects the results of a journal's events.
Records Collect(const std::vector<Event>& events);

/// Failures of the attempt with that id, in the order in which they happened.
std::vector<Failure> FailuresOf(const Records& records, const std::string& trial);
/// The newest attempt that has a failure of that number; null: none.
const Trial* WithFailure(const Records& records, std::uint64_t number);

/// The attempts that count: the last one of each phase that ended by itself or by a
/// person.
std::vector<const Trial*> Counting(const Records& records);

}  // namespace footing::study::records

#pragma once

#include <cstdint>
#include <string>

namespace footing::stream {

/// What goes on, for the participant's screen: footing-view --subject has a text for each.
enum class StudyActivity {
  kUnspecified = 0,    ///< Of a client that does not say it.
  kWait = 1,           ///< The participant has nothing to do.
  kDemonstration = 2,  ///< They are shown the commands.
  kRanges = 3,         ///< Their own ranges are measured.
  kPractice = 4,
  kGetReady = 5,  ///< A trial is about to begin.
  kTrial = 6,     ///< The character stands at the start, or is on its way; left_s: the count-in.
  kFinished = 7,  ///< The trial ended at the finish line.
  kStopped = 8,   ///< The trial ended in another way.
  kRest = 9,
  kSurvey = 10,
};

/// Where a user study's session stands, as its client sent it last; without a participant no study
/// runs.
struct StudyState {
  std::string study;         ///< Its title.
  std::string participant;   ///< Code.
  std::string interface;     ///< Of the phase; empty: of the whole session.
  std::string phase;         ///< Its id, such as wrist.straight1.
  std::uint32_t number = 0;  ///< Of the phase, from 1.
  std::uint32_t phases = 0;
  std::string doing;          ///< What goes on or is waited for, one sentence.
  std::string next;           ///< The phase that follows.
  std::string keys;           ///< What the experimenter may press now.
  double left_s = 0;          ///< Of a countdown, when this was sent; 0: none.
  double active_s = 0;        ///< For how long the participant has been moving.
  std::uint32_t attempt = 0;  ///< Of a trial, from 1.
  StudyActivity activity = StudyActivity::kUnspecified;

  bool operator==(const StudyState&) const = default;
};

}  // namespace footing::stream

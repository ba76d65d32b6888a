#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"

namespace footing::study::plan {

enum class PhaseKind {
  kConsent,
  kDeviceCheck,
  kRest,
  kDemonstration,
  kRanges,
  kPractice,
  kStraight,
  kTestTrack,
  kSurvey,
  kFinalSurvey,
};

const char* Name(PhaseKind kind);

/// A part of a session. It is done as a whole: a session that broke off goes on with the phase that
/// was not finished.
struct Phase {
  std::string id;  ///< Unique within a session, such as "wrist.straight1".
  PhaseKind kind = PhaseKind::kConsent;
  std::string interface;   ///< Empty: of the whole session.
  std::string track;       ///< Of trials, practice and demonstration.
  std::string task;        ///< Of the straight track.
  double duration_s = 0;   ///< Of practice and rest.
  std::uint64_t seed = 0;  ///< Of trials; at most 53 bits.

  bool is_trial() const { return kind == PhaseKind::kStraight || kind == PhaseKind::kTestTrack; }
};

/// What one participant does, from the consent to the final survey (gait paper, section 8.1): for
/// each interface the demonstration, the measurement of personal ranges where the protocol
/// wants it, practice, the straight tracks, one test track, the survey.
struct Session {
  std::string participant;
  std::vector<std::string> interfaces;  ///< In their order.
  std::vector<Phase> phases;

  std::size_t trial_count() const;
};

/// The sessions of all participants, in the protocol's order. Straight tasks and test tracks are
/// drawn without replacement as far as they last.
std::vector<Session> MakeSessions(const Protocol& protocol);

/// What an experimenter should know of the plan, such as a square that is not complete.
std::vector<std::string> Remarks(const Protocol& protocol);

}  // namespace footing::study::plan

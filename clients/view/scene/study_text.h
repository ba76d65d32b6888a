#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/stream/study.h"

/// A study's session as its experimenter and its participant read it.
namespace footing::scene {

bool ShowsStudy(const stream::StudyState& study);

/// "P01, wrist.straight1, attempt 2 (4 of 23)".
std::string StudyTitle(const stream::StudyState& study);

/// What is left of a countdown `passed_s` after it was sent, "4:12"; empty without one.
std::string StudyClock(const stream::StudyState& study, double passed_s);

/// "next: wrist.straight2; in motion so far 12.5 min".
std::string StudyNext(const stream::StudyState& study);

/// "keys: s stops it, u undoes the latest failure"; empty without any.
std::string StudyKeys(const stream::StudyState& study);

/// What a study's participant reads on their own screen.
struct ParticipantText {
  std::string headline = {};  ///< "Get ready".
  std::string count = {};     ///< Of the count-in, "3", "2", "1", "Go!"; of a countdown, "0:42".
  std::string detail = {};    ///< What comes next, or what to do; may be empty.
  bool aside = false;         ///< The world matters more: a banner at the top.
};

/// Empty while nothing is to be read: in a trial, and where no study says what goes on. `started`:
/// the trial of the phase has begun, so its count-in is over.
std::optional<ParticipantText> ParticipantTextOf(const stream::StudyState& study, double passed_s,
                                                 bool started);

/// All of it, a line each.
std::vector<std::string> StudyLines(const stream::StudyState& study, double passed_s);

}  // namespace footing::scene

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/stream/study.h"

/// A study's session as its experimenter reads it.
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

/// All of it, a line each.
std::vector<std::string> StudyLines(const stream::StudyState& study, double passed_s);

}  // namespace footing::scene

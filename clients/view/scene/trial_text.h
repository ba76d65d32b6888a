#pragma once

#include <string>
#include <vector>

#include "clients/view/scene/update.h"

/// A trial as a person reads it.
namespace footing::scene {

/// True for a trial worth showing: somebody named it, or its track has a finish line.
bool ShowsTrial(const stream::TrialState& trial);

/// The trial of a character that the screens show; null: none. While a study's session is led it is
/// the trial of its phase and attempt: what went on before goes on behind the next prompt, but does
/// not belong to it.
const stream::TrialState* ShownTrial(const CharacterPose& pose, const stream::StudyState& study);

/// "trial p07-2 running 12.3 s"; "trial ready".
std::string TrialTitle(const stream::TrialState& trial);

/// What the user has to do: "walk to the line, then run: 12 m" before the mark, "now run" behind
/// it, "run: done" at last; empty without a task.
std::string TaskText(const stream::TrialState& trial, const stream::Track& track);

/// "failed attempts 3 (curve 2, jump 1), withdrawn 1, put back by the operator 1".
std::string AttemptText(const stream::TrialState& trial);

/// All of it and the place on the track, a line each.
std::vector<std::string> TrialLines(const stream::TrialState& trial, const stream::Track& track);

}  // namespace footing::scene

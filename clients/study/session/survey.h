#pragma once

#include <string>

#include "clients/study/plan/protocol.h"
#include "clients/study/session/session_context.h"
#include "common/result/result.h"

namespace footing::study {

/// Asks every item of a survey, on the participant's screen where there is one, else in the
/// terminal, and writes each answer into the journal before the next question. `interface` is empty
/// for the final survey.
Result<void> RunSurvey(SessionContext& context, const plan::Survey& survey,
                       const std::string& interface);

}  // namespace footing::study

#pragma once

#include <vector>

#include "clients/study/plan/survey_items.h"
#include "clients/study/session/session_context.h"
#include "common/base/result.h"

namespace footing::study {

/// Asks what has no answer in the journal yet, on the participant's screen where there is one, else
/// in the terminal, and writes each answer into the journal before the next question. `items` are
/// those of one survey.
Result<void> RunSurvey(SessionContext& context, const std::vector<plan::SurveyItem>& items);

}  // namespace footing::study

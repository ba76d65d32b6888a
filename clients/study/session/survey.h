#pragma once

#include <optional>
#include <string>

#include "clients/study/plan/protocol.h"
#include "clients/study/session/session_context.h"
#include "common/result/result.h"

namespace footing::study {

/// Asks every item of a survey and writes the answers into the journal. `interface` is empty for
/// the final survey.
Result<void> RunSurvey(SessionContext& context, const plan::Survey& survey,
                       const std::string& interface);

/// A whole number within the range that is the whole of `text`, or nothing.
std::optional<int> ParseRating(const std::string& text, int least, int greatest);

}  // namespace footing::study

#pragma once

#include <string>
#include <vector>

#include "clients/study/plan/protocol.h"

namespace footing::study::plan {

enum class SurveyScale {
  kRating,    ///< 1 to 5.
  kExertion,  ///< 0 to 10.
  kText,      ///< One line.
  kChoice,    ///< One of `choices`.
};

/// One question of a survey.
struct SurveyItem {
  std::string interface;  ///< Empty: about the whole study.
  std::string item;       ///< What is rated, or the question; "exertion" for the exertion.
  SurveyScale scale = SurveyScale::kRating;
  bool at_end = false;  ///< Asked after the last interface.
  std::vector<std::string> choices = {};

  bool operator==(const SurveyItem&) const = default;
};

/// What is asked right after an interface, in this order.
std::vector<SurveyItem> ItemsAfter(const Protocol& protocol, const std::string& interface);

/// What is asked at the end. Each item is asked of every interface, in the order in which they were
/// used, before the next item: so they are compared with each other.
std::vector<SurveyItem> ItemsAtEnd(const Protocol& protocol,
                                   const std::vector<std::string>& interfaces);

}  // namespace footing::study::plan

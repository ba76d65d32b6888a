#include "clients/study/plan/survey_items.h"

namespace footing::study::plan {
namespace {

std::vector<SurveyItem> ItemsOf(const Survey& survey, const std::vector<std::string>& interfaces,
                                bool at_end) {
  std::vector<SurveyItem> items;
  const auto add = [&](const std::string& item, SurveyScale scale) {
    for (const std::string& interface : interfaces) {
      items.push_back({interface, item, scale, at_end});
    }
  };
  for (const std::string& item : survey.ratings) add(item, SurveyScale::kRating);
  if (survey.exertion) add(kExertionItem, SurveyScale::kExertion);
  for (const std::string& question : survey.questions) add(question, SurveyScale::kText);
  return items;
}

}  // namespace

std::vector<SurveyItem> ItemsAfter(const Protocol& protocol, const std::string& interface) {
  return ItemsOf(protocol.survey, {interface}, /*at_end=*/false);
}

std::vector<SurveyItem> ItemsAtEnd(const Protocol& protocol,
                                   const std::vector<std::string>& interfaces) {
  const FinalSurvey& survey = protocol.final_survey;
  const std::vector<std::string> whole_study = {""};
  std::vector<SurveyItem> items =
      ItemsOf(survey.items, survey.each_interface ? interfaces : whole_study, /*at_end=*/true);
  for (const std::string& question : survey.overall) {
    if (question == kPreferredItem) {
      items.push_back({"", question, SurveyScale::kChoice, true, interfaces});
      continue;
    }
    items.push_back({"", question, SurveyScale::kText, true});
  }
  return items;
}

}  // namespace footing::study::plan

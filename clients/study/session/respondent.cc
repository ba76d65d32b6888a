#include "clients/study/session/respondent.h"

#include "clients/study/plan/draw.h"

namespace footing::study {

int Respondent::Rate(const std::string& interface, const std::string& item, int least,
                     int greatest) const {
  plan::Draw draw(seed, "rating " + participant + " " + interface + " " + item);
  return least + static_cast<int>(draw.Below(static_cast<std::size_t>(greatest - least + 1)));
}

std::string Respondent::Choose(const std::string& interface, const std::string& question,
                               const std::vector<std::string>& choices) const {
  plan::Draw draw(seed, "choice " + participant + " " + interface + " " + question);
  return choices[draw.Below(choices.size())];
}

std::string Respondent::Answer(const std::string& interface, const std::string& question) const {
  plan::Draw draw(seed, "answer " + participant + " " + interface + " " + question);
  return "synthetic answer " + std::to_string(draw.Below(1000));
}

}  // namespace footing::study

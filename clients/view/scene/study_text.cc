#include "clients/view/scene/study_text.h"

#include <algorithm>
#include <cmath>

#include "clients/view/scene/words.h"

namespace footing::scene {

bool ShowsStudy(const stream::StudyState& study) { return !study.participant.empty(); }

std::string StudyTitle(const stream::StudyState& study) {
  std::string text = study.participant + ", " + study.phase;
  if (study.attempt > 0) text += ", attempt " + std::to_string(study.attempt);
  return text + " (" + std::to_string(study.number) + " of " + std::to_string(study.phases) + ")";
}

std::string StudyClock(const stream::StudyState& study, double passed_s) {
  if (!(study.left_s > 0)) return "";
  const double left_s = std::clamp(study.left_s - passed_s, 0.0, 359'999.0);
  const int seconds = static_cast<int>(std::ceil(left_s));
  const std::string rest = std::to_string(seconds % 60);
  return std::to_string(seconds / 60) + (rest.size() < 2 ? ":0" : ":") + rest;
}

std::string StudyNext(const stream::StudyState& study) {
  return "next: " + study.next + "; in motion so far " + Fixed(study.active_s / 60, 1) + " min";
}

std::string StudyKeys(const stream::StudyState& study) {
  return study.keys.empty() ? "" : "keys: " + study.keys;
}

std::vector<std::string> StudyLines(const stream::StudyState& study, double passed_s) {
  const std::string clock = StudyClock(study, passed_s);
  std::vector<std::string> lines{StudyTitle(study),
                                 study.doing + (clock.empty() ? "" : "   " + clock + " left"),
                                 StudyNext(study)};
  if (const std::string keys = StudyKeys(study); !keys.empty()) lines.push_back(keys);
  return lines;
}

}  // namespace footing::scene

#include "clients/study/progress_text.h"

#include <algorithm>
#include <cmath>

#include "common/base/number.h"

namespace footing::study::simulate {
namespace {

constexpr double kInMinutesFromS = 90, kStepS = 10;

std::string About(double left_s) {
  if (left_s >= kInMinutesFromS) return text::Fixed(left_s / 60, 0) + " min";
  return text::Fixed(std::max(1.0, std::ceil(left_s / kStepS)) * kStepS, 0) + " s";
}

}  // namespace

std::string ProgressText(const StudyProgress& progress) {
  const int left = progress.all - progress.ended;
  std::string line = ", " + std::to_string(progress.ended) + " of " + std::to_string(progress.all) +
                     (progress.all == 1 ? " session" : " sessions");
  if (left <= 0) return line;
  // As many as run at once share what is left; each of them is under way already.
  const double left_s = progress.mean_s * left / std::min(left, std::max(1, progress.at_once));
  return line + "; about " + About(left_s) + " left";
}

}  // namespace footing::study::simulate

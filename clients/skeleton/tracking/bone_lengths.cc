#include "clients/skeleton/tracking/bone_lengths.h"

#include <algorithm>

namespace footing::skeleton {
namespace {

constexpr std::size_t kEvery = 8;  // A median of 5 s changes little from frame to frame.

}  // namespace

void BoneLengths::Add(std::size_t bone, double length_m) {
  History& history = histories_[bone];
  history.lengths_m[history.count % kWindow] = static_cast<float>(length_m);
  ++history.count;
  if (history.count < kLeast || (history.count != kLeast && history.count % kEvery != 0)) return;
  auto sorted = history.lengths_m;
  const auto count = static_cast<std::ptrdiff_t>(std::min(history.count, kWindow));
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.begin() + count);
  history.median_m = static_cast<double>(sorted[static_cast<std::size_t>(count / 2)]);
}

std::optional<double> BoneLengths::Median(std::size_t bone) const {
  if (histories_[bone].count < kLeast) return std::nullopt;
  return histories_[bone].median_m;
}

std::optional<double> BoneLengths::Limb() const {
  double sum_m = 0;
  int count = 0;
  for (std::size_t bone = 0; bone < kBones; ++bone) {
    if (!kBoneList[bone].limb) continue;
    if (const auto median = Median(bone)) {
      sum_m += *median;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum_m / count;
}

}  // namespace footing::skeleton

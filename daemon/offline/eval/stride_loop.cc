#include "daemon/offline/eval/stride_loop.h"

#include <algorithm>
#include <cmath>

namespace footing::eval {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kLeastOverlap = 6;  // Frames of the next stride that show the period.

}  // namespace

Track Smoothed(const Track& track) {
  Track smoothed;
  const int size = static_cast<int>(track.size());
  for (int i = 0; i < size; ++i) {
    Vector3d sum = Vector3d::Zero();
    const int from = std::max(0, i - kSmoothFrames);
    const int to = std::min(size - 1, i + kSmoothFrames);
    for (int j = from; j <= to; ++j) sum += track[static_cast<std::size_t>(j)];
    smoothed.push_back(sum / (to - from + 1));
  }
  return smoothed;
}

double Mismatch(const Track& track, std::size_t period) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + period < track.size(); ++i, ++count) {
    sum += (track[i + period] - track[i]).squaredNorm();
  }
  return count < kLeastOverlap ? kWorstMismatch : sum / static_cast<double>(count);
}

Track Loop(const Track& track, std::size_t period) {
  Track loop(track.begin(), track.begin() + static_cast<std::ptrdiff_t>(period));
  const std::size_t overlap = track.size() - period;
  for (std::size_t i = 0; i < overlap; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(overlap);
    loop[i] = share * track[i] + (1 - share) * track[i + period];
  }
  return loop;
}

Vector3d At(const Track& loop, double index) {
  const double size = static_cast<double>(loop.size());
  const double wrapped = index - size * std::floor(index / size);
  const auto low = static_cast<std::size_t>(wrapped) % loop.size();
  const double share = wrapped - std::floor(wrapped);
  return (1 - share) * loop[low] + share * loop[(low + 1) % loop.size()];
}

std::size_t MidStance(const Track& loop, const Vector3d& standing, double rate_hz) {
  const int half = static_cast<int>(0.06 * rate_hz);
  std::size_t best = 0;
  double least = kWorstMismatch;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    double sum = 0;
    for (int off = -half; off <= half; ++off) {
      sum += (At(loop, static_cast<double>(i) + off) - standing).squaredNorm();
    }
    if (sum < least) {
      least = sum;
      best = i;
    }
  }
  return best;
}

}  // namespace footing::eval

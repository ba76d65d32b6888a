#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace footing::link {

/// How far estimated sample times are from the true ones, the median removed: a constant delay
/// can't be seen from the receiving end.
class SampledTimeError {
 public:
  void Add(std::int64_t sampled_ns, std::int64_t true_ns) {
    error_ms_.push_back(static_cast<double>(sampled_ns - true_ns) * 1e-6);
  }
  std::size_t count() const { return error_ms_.size(); }
  double rms_ms() const {
    double square = 0;
    for (const double one : Centred()) square += one * one;
    return std::sqrt(square / static_cast<double>(error_ms_.size()));
  }
  double p99_ms() const {
    std::vector<double> size = Centred();
    for (double& one : size) one = std::abs(one);
    std::sort(size.begin(), size.end());
    return size[size.size() * 99 / 100];
  }

 private:
  std::vector<double> Centred() const {
    std::vector<double> centred = error_ms_;
    std::sort(centred.begin(), centred.end());
    const double median = centred[centred.size() / 2];
    for (double& one : centred) one -= median;
    return centred;
  }

  std::vector<double> error_ms_;
};

}  // namespace footing::link

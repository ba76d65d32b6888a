#pragma once

namespace footing::momentum {

/// The paper's discrete Kalman filter of one load (section 4.1): a random walk seen through white
/// noise. A plain value.
class LoadFilter {
 public:
  struct Config {
    double walk_n = 60;   ///< Standard deviation of the change from frame to frame.
    double noise_n = 15;  ///< Of the measurement.
  };

  LoadFilter() = default;
  explicit LoadFilter(const Config& config) : config_(config) {}

  double Advance(double load_n) {
    if (!started_) {
      started_ = true;
      estimate_n_ = load_n;
      variance_n2_ = config_.noise_n * config_.noise_n;
      return estimate_n_;
    }
    variance_n2_ += config_.walk_n * config_.walk_n;
    const double gain = variance_n2_ / (variance_n2_ + config_.noise_n * config_.noise_n);
    estimate_n_ += gain * (load_n - estimate_n_);
    variance_n2_ *= 1 - gain;
    return estimate_n_;
  }

  double variance_n2() const { return variance_n2_; }

 private:
  Config config_;
  bool started_ = false;
  double estimate_n_ = 0;
  double variance_n2_ = 0;
};

}  // namespace footing::momentum

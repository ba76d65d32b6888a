#pragma once

namespace footing::transport {

/// How long to wait between tries: doubled each time, from `min_s` to `max_s`, times a random
/// factor from 0.5 to 1 so that many clients do not come back at one instant. A plain value.
class Backoff {
 public:
  Backoff(double min_s, double max_s) : min_s_(min_s), max_s_(max_s), next_s_(min_s) {}

  /// `random` is uniform in [0, 1).
  double Next(double random) {
    const double wait_s = next_s_ * (0.5 + 0.5 * random);
    next_s_ = next_s_ * 2 < max_s_ ? next_s_ * 2 : max_s_;
    return wait_s;
  }
  void Reset() { next_s_ = min_s_; }

 private:
  double min_s_;
  double max_s_;
  double next_s_;
};

}  // namespace footing::transport

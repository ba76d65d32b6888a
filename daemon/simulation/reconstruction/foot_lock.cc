#include "daemon/simulation/reconstruction/foot_lock.h"

#include <algorithm>

namespace footing::reconstruction {

FootLock::Places FootLock::Advance(bool contact, const Places& estimated, const Places& shown,
                                   double step_s) {
  if (!contact) {
    held_ = false;
    return estimated;
  }
  if (!held_) {
    held_ = true;
    since_s_ = 0;
    for (std::size_t i = 0; i < kPoints; ++i) from_m_[i] = shown[i] - estimated[i];
  }
  since_s_ += step_s;
  const Eigen::Vector2d off = estimated[0].head<2>() - place_m_;
  const double beyond_m = off.norm() - config_.band_m;
  if (since_s_ <= config_.free_s) {
    place_m_ = estimated[0].head<2>();
  } else if (beyond_m > 0) {
    place_m_ += beyond_m * std::min(1.0, step_s / config_.follow_s) * off.normalized();
  }
  const double left = std::max(0.0, 1 - since_s_ / config_.ease_s);
  Places places;
  for (std::size_t i = 0; i < kPoints; ++i) {
    places[i] = estimated[i] + left * from_m_[i];
    places[i].head<2>() += place_m_ - estimated[0].head<2>();
  }
  return places;
}

}  // namespace footing::reconstruction

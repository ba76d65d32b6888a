#include "daemon/sensor/service/motion_chain.h"

namespace footing::sensor {

void MotionChain::Take(stream::MotionSample& sample, bool measured) {
  if (measured) filtered_mps2_ = filter_.Advance(sample.sampled_ns, sample.specific_force_mps2);
  sample.filtered_mps2 = filtered_mps2_;
  if (!sample.has_angular_velocity) return;
  gyroscope_bias_.Take(sample.sampled_ns, sample.specific_force_mps2,
                       sample.angular_velocity_radps);
  sample.gyroscope_bias_radps = gyroscope_bias_.bias_radps();
  sample.angular_velocity_radps -= sample.gyroscope_bias_radps;
}

}  // namespace footing::sensor

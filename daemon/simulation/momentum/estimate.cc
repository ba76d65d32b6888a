#include "daemon/simulation/momentum/estimate.h"

#include <cmath>

namespace footing::momentum {

void PlaceHeelAndToe(const FootShape& shape, FootEstimate& foot) {
  const Eigen::Vector3d forward(std::cos(shape.yaw_rad), std::sin(shape.yaw_rad), 0);
  foot.p_WHeel_m = foot.p_WF_m - shape.rest_share * shape.length_m * forward;
  foot.p_WToe_m = foot.p_WF_m + (1 - shape.rest_share) * shape.length_m * forward;
}

}  // namespace footing::momentum

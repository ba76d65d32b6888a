#include "daemon/simulation/biped/skeleton.h"

namespace footing::biped {

stream::Skeleton DescribeSkeleton(const BipedParameters& parameters) {
  const Eigen::Vector3d hip_size_m(0.08, 0.08, 2 * parameters.hip_link_com_below_hip_m);
  const Eigen::Vector3d knee_size_m(0.05, 0.05, 2 * parameters.foot_below_knee_link_com_m);
  stream::Skeleton skeleton;
  skeleton.name = "bird";
  skeleton.links = {{"body", -1, {0.5, 0.2, 0.2}},
                    {"left_hip", 0, hip_size_m},
                    {"left_knee", 1, knee_size_m},
                    {"right_hip", 0, hip_size_m},
                    {"right_knee", 3, knee_size_m}};
  skeleton.contact_points = {"left_foot", "right_foot"};
  return skeleton;
}

}  // namespace footing::biped

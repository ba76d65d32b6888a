#include "daemon/offline/tune/search_space.h"

#include <algorithm>
#include <cmath>

namespace footing::tune {
namespace {

using stream::Gait;

struct Row {
  const char* gain;
  double scale;
  bool relative = true;
};

constexpr double kCoefficient = 0.25;  // Springs and dampers by about a quarter.
constexpr double kLength = 0.02;       // Lengths by 2 %.

const std::vector<Row> kEveryGait{{"servo.hip_stiffness_nm_per_rad", kCoefficient},
                                  {"servo.hip_damping_nms_per_rad", kCoefficient},
                                  {"attitude.roll_stiffness_nm_per_rad", kCoefficient},
                                  {"attitude.roll_damping_nms_per_rad", kCoefficient},
                                  {"attitude.pitch_stiffness_nm_per_rad", kCoefficient},
                                  {"attitude.pitch_damping_nms_per_rad", kCoefficient}};
const std::vector<Row> kOnTheGround{{"attitude.walk_yaw_stiffness_nm_per_rad", kCoefficient},
                                    {"attitude.walk_yaw_damping_nms_per_rad", kCoefficient},
                                    {"walking.leg_stiffness_n_per_m", kCoefficient},
                                    {"walking.leg_damping_ns_per_m", kCoefficient},
                                    {"walking.hip_height_m", kLength},
                                    {"walking.step_width_m", 0.15}};
const std::vector<Row> kInHops{{"hopping.touchdown_length_m", kLength}};
const std::vector<Row> kRunning{{"attitude.run_yaw_stiffness_nm_per_rad", kCoefficient},
                                {"attitude.run_yaw_damping_nms_per_rad", kCoefficient},
                                {"hopping.run_leg_stiffness_n_per_m", kCoefficient},
                                {"hopping.run_leg_damping_ns_per_m", kCoefficient},
                                {"hopping.run_velocity_gain_s", 0.15},
                                {"hopping.speed_gain_s", 0.003, false},
                                {"hopping.run_foot_spacing_m", kCoefficient},
                                {"recovery.idle_yield", kCoefficient}};
const std::vector<Row> kJumping{{"attitude.jump_yaw_stiffness_nm_per_rad", kCoefficient},
                                {"attitude.jump_yaw_damping_nms_per_rad", kCoefficient},
                                {"hopping.jump_leg_stiffness_n_per_m", kCoefficient},
                                {"hopping.jump_leg_damping_ns_per_m", kCoefficient},
                                {"hopping.jump_velocity_gain_s", 0.15},
                                {"attitude.jump_lean_rad_per_mps", 0.03, false},
                                {"recovery.spread_mps", kCoefficient}};

}  // namespace

std::vector<Dimension> DimensionsOf(Gait gait) {
  std::vector<Dimension> dimensions;
  const auto add = [&dimensions](const std::vector<Row>& rows) {
    for (const Row& row : rows) {
      const gait::GainField* gain = gait::FindGain(row.gain);
      FOOTING_CHECK(gain != nullptr);
      dimensions.push_back({gain, row.scale, row.relative});
    }
  };
  add(kEveryGait);
  switch (gait) {
    case Gait::kRun:
      add(kInHops);
      add(kRunning);
      break;
    case Gait::kJump:
      add(kInHops);
      add(kJumping);
      break;
    case Gait::kStep:
    case Gait::kWalk:
    case Gait::kUnspecified:
      add(kOnTheGround);
      break;
  }
  return dimensions;
}

gait::Gains GainsAt(const gait::Gains& start, const std::vector<Dimension>& dimensions,
                    const Eigen::VectorXd& point) {
  gait::Gains gains = start;
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const Dimension& dimension = dimensions[i];
    const double step = dimension.scale * point[static_cast<Eigen::Index>(i)];
    double& value = dimension.gain->of(gains);
    value = dimension.relative ? value * std::exp(step) : value + step;
    value = std::clamp(value, dimension.gain->min, dimension.gain->max);
  }
  return gains;
}

}  // namespace footing::tune

#pragma once

#include <Eigen/Core>

namespace footing::virtual_sensors {

/// Central differences of signals (a row each) at equal steps, one-sided at the ends; needs two
/// columns.
Eigen::MatrixXd Derivative(const Eigen::MatrixXd& values, double rate_hz);

}  // namespace footing::virtual_sensors

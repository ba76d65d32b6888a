#pragma once

#include <Eigen/Core>

namespace footing::virtual_sensors {

/// Each row of `values` (a column a frame) through a Butterworth low-pass of second order, forwards
/// and backwards, so without delay; the -3 dB frequency of both passes together is
/// 0.802 cutoff_hz. Ends are continued by point reflection. A cutoff at or above half the rate
/// changes nothing.
Eigen::MatrixXd LowPass(const Eigen::MatrixXd& values, double cutoff_hz, double rate_hz);

/// Central differences along the rows, one-sided at the ends; needs two columns.
Eigen::MatrixXd Derivative(const Eigen::MatrixXd& values, double rate_hz);

}  // namespace footing::virtual_sensors

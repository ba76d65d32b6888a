#pragma once

#include <Eigen/Core>

namespace footing {

/// Low-pass without lag of sampled signals: a row a signal, a column a time, at equal steps. A
/// Butterworth filter of second order is run forwards, then backwards, with the ends continued by
/// point reflection. Both passes together have -3 dB at `cutoff_hz` (D. Winter, "Biomechanics and
/// Motor Control of Human Movement", 2.2.4.4: the single filter's frequency is raised by
/// 1 / 0.802). A cutoff of 0.36 of the rate or more leaves the signal as it is.
Eigen::MatrixXd LowPass(const Eigen::MatrixXd& signal, double rate_hz, double cutoff_hz);

}  // namespace footing

#pragma once

#include <Eigen/Core>

/// Smoothing and derivatives of sampled signals: a row a signal, a column a time, at equal steps.
namespace footing::motion {

/// Low-pass without lag: a Butterworth filter of second order run forwards, then backwards, with
/// the ends continued by point reflection. Both passes together have -3 dB at `cutoff_hz` (D.
/// Winter, "Biomechanics and Motor Control of Human Movement", 2.2.4.4: the single filter's
/// frequency is raised by 1 / 0.802). A cutoff of 0.45 of the rate or more leaves the signal as it
/// is.
Eigen::MatrixXd LowPass(const Eigen::MatrixXd& signal, double rate_hz, double cutoff_hz);

/// Natural cubic spline through samples at equal steps: continuous to the second derivative.
class Spline {
 public:
  Spline(Eigen::MatrixXd samples, double rate_hz);

  /// At a time from the first sample on, s; outside the samples the end value stays.
  Eigen::VectorXd Value(double t_s) const;
  Eigen::VectorXd FirstDerivative(double t_s) const;
  Eigen::VectorXd SecondDerivative(double t_s) const;

 private:
  struct Place {
    Eigen::Index before;
    double fraction;  ///< From `before` to the next, 0 to 1.
  };
  Place At(double t_s) const;

  Eigen::MatrixXd samples_;
  Eigen::MatrixXd curvatures_;  ///< Second derivatives at the samples.
  double rate_hz_;
};

}  // namespace footing::motion

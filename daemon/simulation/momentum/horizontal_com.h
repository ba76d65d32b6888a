#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>

#include "daemon/simulation/momentum/linear_filter.h"

namespace footing::momentum {

/// Prior of the horizontal motion of a body, before anything is measured, for one axis. c is the
/// sum of a slow part and a rhythmic part, both stationary, each the output of a third-order linear
/// system driven by white noise, so that its acceleration is a state:
///   c''' + (p + 2 zeta w) c'' + (2 zeta w p + w^2) c' + p w^2 c = noise.
/// The centre of pressure is c - beta (z / (z'' + g)) c'' + e: beta takes the mean part of the
/// rate of angular momentum that goes along with c'' (1 for a point mass), e the rest of it, a
/// first-order process.
struct HorizontalPrior {
  struct Part {
    double pole_radps = 1;       ///< p
    double frequency_radps = 3;  ///< w
    double damping = 0.7;        ///< zeta
    double spread_m = 0.05;      ///< Standard deviation of the part.
  };
  Part slow{0.4, 1.5, 0.9, 0.04};
  Part rhythmic{3, 8, 0.5, 0.04};
  double beta = 1.0;
  double moment_spread_m = 0.015;  ///< Standard deviation of e.
  double moment_time_s = 0.1;      ///< Correlation time of e.
  double cop_noise_m = 0.002;      ///< White, at full weight; grows with the inverse of the load.
  /// Factor of the reported deviation of c over the filter's, whose parts reach further than c
  /// does.
  double spread_factor = 1;
};

/// One frame of what the horizontal estimator needs.
struct HorizontalInput {
  double cop_m = 0;         ///< Along this axis, W.
  bool cop_valid = false;   ///< False: too little load for a centre of pressure.
  double load_n = 0;        ///< Total vertical load.
  double com_height_m = 1;  ///< Over the ground.
  double centre_m = 0;      ///< Where c tends to: the middle between the feet.
};

/// The inverted-pendulum Kalman filter with a stationary prior, for one axis (facts: equation (1)
/// of the paper with the shear forces eliminated). A plain value.
class HorizontalCom {
 public:
  static constexpr int kStates = 8;
  /// Steps that are remembered: 200 ms at 120 Hz.
  static constexpr int kSlots = 25;
  using Filter = LinearFilter<kStates, kSlots>;

  /// `step_s` is the time between frames, > 0.
  HorizontalCom(const HorizontalPrior& prior, const PostureError& posture, double mass_kg,
                double step_s);

  /// Only Position of up to so many steps ago will be asked for. Before Start.
  void KeepLag(int lag_steps) { filter_.Keep(lag_steps + 1); }
  /// The body is at rest at c_m.
  void Start(double c_m, double centre_m);
  /// The feet have just come down from a flight that nobody has seen: the body is somewhere over
  /// them, and moves as bodies do.
  void Land(double cop_m, double centre_m);
  void Advance(const HorizontalInput& input);
  /// C is there by hands and feet alone, in the frame of the last Advance.
  void SeePosture(double c_m);

  /// In W, as it was `lag_steps` ago (at most kSlots - 1).
  Filter::Scalar Position(int lag_steps) const;
  Filter::Scalar Velocity() const { return filter_.Of(velocity_); }
  Filter::Scalar Acceleration() const { return filter_.Of(acceleration_); }

  const Filter& filter() const { return filter_; }
  const Filter::Matrix& transition() const { return a_; }
  const Filter::Matrix& noise() const { return q_; }
  /// How far the COPs of the last second were from where the filter expected them: mean square over
  /// the variance, 1 where the filter is right about the body.
  double surprise() const { return surprise_; }
  double centre_m() const { return centre_m_; }
  const Filter::Row& position_row() const { return position_; }

 private:
  void Surprise(double innovation);

  HorizontalPrior prior_;
  PostureError posture_;
  double mass_kg_;
  double step_s_;
  Filter filter_;
  Filter::Matrix a_;
  Filter::Matrix q_;
  Filter::Matrix stationary_;
  Filter::Row position_;
  Filter::Row velocity_;
  Filter::Row acceleration_;
  double centre_m_ = 0;
  double surprise_ = 0;
  double landed_s_ = std::numeric_limits<double>::infinity();  ///< Since Land.
};

/// Offline: the whole recording at once, by the Rauch-Tung-Striebel recursion. Allocates.
std::vector<HorizontalCom::Filter::Scalar> SmoothHorizontal(
    const HorizontalPrior& prior, double mass_kg, double step_s, double start_m,
    const std::vector<HorizontalInput>& inputs);

// The horizontal filters expect a body in place. Where a body steps, lunges or pushes off, they
// lag behind by more than they report, and filters of a travelling body, which also see where
// hands and feet have C, are better.

/// The prior of a body that travels, for the axis of this prior of a body in place.
HorizontalPrior Travelling(HorizontalPrior in_place);
/// How the pose from hands and feet alone is wrong about C of such a body.
PostureError TravellingPosture();

/// Variance (m²) of C beyond what the filter of a body in place reports: by how much the last COPs
/// surprised it, and how far a body that has just stepped is from it (`stepped_m`, else 0).
double DoubtOf(const HorizontalCom& in_place, double stepped_m);

/// C by the filter of a body in place, moved towards that of a travelling body as far as the doubt
/// in the former goes. Without doubt it is the former.
HorizontalCom::Filter::Scalar Weigh(const HorizontalCom::Filter::Scalar& in_place, double doubt_m2,
                                    const HorizontalCom::Filter::Scalar& travelling);

}  // namespace footing::momentum

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemon/simulation/momentum/angular_momentum.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/foot_place.h"
#include "daemon/simulation/momentum/height_hypotheses.h"
#include "daemon/simulation/momentum/horizontal_com.h"

namespace footing::momentum {

/// Priors of the two horizontal axes, from recorded motion (docs/momentum.md, "Horizontal COM").
HorizontalPrior ForwardPrior();
HorizontalPrior LateralPrior();

/// How postures are wrong about the place of C along the lateral axis and upwards: `lateral` by the
/// mean of all poses, and `height` by that or by poses that were found to go with hands and feet
/// (docs/momentum.md).
PostureError PlainLateralPosture();
PostureError PlainHeightPosture();
PostureError LearnedHeightPosture();

struct BestConfig {
  HorizontalPrior forward = ForwardPrior();
  HorizontalPrior lateral = LateralPrior();
  PostureError lateral_posture = PlainLateralPosture();
  PostureError height_posture = PlainHeightPosture();
  FootContactConfig contact;
  FootPlaceConfig place;
  double lag_s = 0;               ///< 0 to 0.2: positions of C come this much later, and better.
  double angular_memory_s = 1.0;  ///< The angular momentum leaks away in this time.
};

/// Our momentum: inverted-pendulum filters for the horizontal centre of mass, a self-calibrating
/// filter bank for the vertical one, feet as places with covariance. A plain value that allocates
/// nothing.
class BestEstimator {
 public:
  BestEstimator(const BestConfig& config, const Subject& subject, const TPose& pose, double step_s);

  /// One frame, `step_s` after the one before. A source that is not valid, or values that are not
  /// finite, make the frame a gap: the estimate coasts, its covariance grows, and after a second
  /// it restarts when loads come again (`resets`).
  const Estimate& Advance(const ContactLoads& loads);
  /// Where C is by hands and feet alone, in the frame of the last Advance: by the mean of all poses
  /// along the lateral axis, and by poses that were found to go with hands and feet. C is estimated
  /// again. What is not finite, or comes in a gap, is passed over.
  const Estimate& SeePosture(double lateral_W_m, const Eigen::Vector3d& likely_W_m);
  const Estimate& estimate() const { return estimate_; }
  const HeightHypotheses& vertical() const { return vertical_; }
  /// Weighed in the T-pose, and again where what came after contradicts that.
  double mass_kg() const { return vertical_.mass_kg(); }

 private:
  void Begin();
  /// The feet come down after a flight that began elsewhere.
  void LandElsewhere(const ContactLoads& loads);
  void WatchFlight(const ContactLoads& loads, bool gap, double total_n);
  void AdvanceFeet(const ContactLoads& loads);
  void AdvanceCom(const ContactLoads& loads, bool gap);
  void ReportCom(bool sees_posture);
  /// One axis of the horizontal place.
  HorizontalCom::Filter::Scalar PlaceOn(std::size_t axis, bool sees_posture) const;
  void AdvanceAngular();
  Eigen::Vector2d Centre() const;
  std::array<double, kFeet> FeetForward() const;

  BestConfig config_;
  Subject subject_;
  TPose pose_;
  double step_s_;
  int lag_steps_;
  std::array<HorizontalCom, 2> horizontal_;
  std::array<HorizontalCom, 2> travelling_;
  HeightHypotheses vertical_;
  std::array<FootContact, kFeet> contacts_;
  std::array<FootPlace, kFeet> places_;
  std::array<Pressure, kFeet> pressures_{};
  LoadShare load_share_;
  StepWatch step_watch_;
  double away_s_ = 0;    // Since the feet had load, or the sources were valid.
  double aloft_s_ = 0;   // Since the feet had any load.
  bool silent_ = false;  // The sources were not valid in the frame before.
  Estimate estimate_;
};

}  // namespace footing::momentum

#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "daemon/simulation/momentum/angular_momentum.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contacts.h"
#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/momentum/height_models.h"
#include "daemon/simulation/momentum/horizontal_com.h"

namespace footing::momentum {

/// Priors of the two horizontal axes, from recorded motion (docs/momentum.md, "Horizontal COM").
HorizontalPrior ForwardPrior();
HorizontalPrior LateralPrior();

/// How postures are wrong about the place of C along the lateral axis (docs/momentum.md).
PostureError PlainLateralPosture();

/// Standard deviation of the height by a learned posture that shows it, m.
inline constexpr double kLearnedPostureM = 0.03;

struct BestConfig {
  HorizontalPrior forward = ForwardPrior();
  HorizontalPrior lateral = LateralPrior();
  PostureError lateral_posture = PlainLateralPosture();
  double height_posture_m = 0;    ///< 0: postures are not asked for the height.
  double lag_s = 0;               ///< 0 to 0.2: positions of C come this much later, and better.
  double angular_memory_s = 1.0;  ///< The angular momentum leaks away in this time.
};

/// Where C is by hands and feet alone, W: by the mean of all poses along the lateral axis, and by
/// poses that were found to go with hands and feet. What is not finite says nothing.
struct PostureCom {
  double lateral_W_m = 0;
  Eigen::Vector3d likely_W_m = Eigen::Vector3d::Zero();
};

/// Our momentum: inverted-pendulum filters for the horizontal centre of mass and several
/// models for the vertical one, from the contacts and the postures of a frame. A plain value
/// that allocates nothing.
class BestEstimator {
 public:
  BestEstimator(const BestConfig& config, const Subject& subject, const TPose& pose, double step_s);

  /// One frame, `step_s` after the one before, with the posture where one is known. In a frame
  /// without valid contacts the estimate coasts and its covariance grows; when a body comes back or
  /// lands elsewhere it restarts (`resets`).
  const Estimate& Advance(const ContactFrame& contacts,
                          const std::optional<PostureCom>& posture = std::nullopt);
  const Estimate& estimate() const { return estimate_; }
  const HeightModels& vertical() const { return vertical_; }
  /// Weighed in the T-pose, and again where what came after contradicts that.
  double mass_kg() const { return vertical_.mass_kg(); }

 private:
  using Place = HorizontalCom::Filter::Scalar;

  void Begin(const Eigen::Vector2d& centre_m);
  /// The feet come down after a flight that began elsewhere, or out of a silence.
  void LandElsewhere(const ContactFrame& contacts);
  void AdvanceCom(const ContactFrame& contacts);
  void AdvanceAngular(const ContactFrame& contacts);
  void SeePosture(const PostureCom& posture);
  void Report(const ContactFrame& contacts, bool sees_posture);
  /// One axis of the horizontal place.
  Place PlaceOn(std::size_t axis, bool sees_posture) const;

  BestConfig config_;
  double com_height_m_;
  TPose pose_;
  double step_s_;
  int lag_steps_;
  std::array<HorizontalCom, 2> horizontal_;
  std::array<HorizontalCom, 2> travelling_;
  HeightModels vertical_;
  Estimate estimate_;
};

}  // namespace footing::momentum

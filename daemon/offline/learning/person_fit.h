#pragma once

#include <string>

#include <Eigen/Core>

#include "common/model/model.h"
#include "daemon/offline/learning/pose_regression.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

/// Corrections of a pose model by a few minutes of one person's motion: by how much the pose that
/// boards and hands make likely is off a better known pose, such as one with more sensors.
namespace footing::learning {

/// Frames of one person: what boards and hands alone show, beside a better known pose.
struct PersonExamples {
  PoseExamples likely;   ///< By boards and hands.
  PoseExamples posture;  ///< By hands and feet.

  /// The frame that `plain` has just reconstructed from boards and hands alone, with its better
  /// known pose, W. Frames of one `piece` are held out together.
  void Add(const reconstruction::Reconstruction& plain, const Eigen::VectorXd& reference_q,
           int piece);
  std::size_t size() const { return likely.poses.size(); }
};

/// A correction of one regression, how it was chosen, and what it gains on held-out pieces.
struct FittedCorrection {
  reconstruction::PersonCorrection correction;
  double penalty = 0;     ///< Penalty of the correction, in frames; infinite: none.
  double error = 0;       ///< Root mean square, scaled, of held-out pieces with it,
  double error_base = 0;  ///< and without.
};

/// Ridge regression of the errors of `base` on its own features, whose penalty is chosen by holding
/// out pieces; no correction where none helps. The covariance of the errors is a mean of that of
/// `rest` and of the person's own, by the number of frames.
FittedCorrection FitCorrection(const PoseExamples& examples,
                               const reconstruction::PoseRegression& base,
                               const pose::PoseBasis& rest);

/// Their names begin with `prefix`, as those of the regression that is corrected.
void AppendTensors(const reconstruction::PersonCorrection& correction, const std::string& prefix,
                   model::Model& model);

}  // namespace footing::learning

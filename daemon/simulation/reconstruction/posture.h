#pragma once

#include <Eigen/Core>
#include <array>

#include "daemon/simulation/momentum/estimate.h"
#include "daemon/simulation/reconstruction/features.h"
#include "daemon/simulation/reconstruction/inputs.h"
#include "daemon/simulation/reconstruction/subject_model.h"

namespace footing::reconstruction {

/// The pose that hands and feet alone make likely, frame by frame: nothing of the loads but where
/// the feet are and that they stand. A value; `model` must outlive it.
class LikelyPosture {
 public:
  LikelyPosture(const SubjectModel& model, double step_s);

  void Start();
  /// The next frame: fists in W, left and right.
  void Advance(const std::array<Eigen::Vector3d, kHands>& hands_W_m,
               const momentum::Estimate& estimate);
  /// Of the last frame, from `origin_m`; only where the model knows postures.
  const Eigen::VectorXd& Predict(const Eigen::Vector3d& origin_m);
  const Features& features() const { return features_; }
  /// From where the features' places are.
  const Eigen::Vector3d& middle_W_m() const { return middle_W_m_; }

 private:
  const SubjectModel* model_;
  double step_s_;
  Features features_;
  Eigen::Vector3d middle_W_m_ = Eigen::Vector3d::Zero();
  PoseRegression::Workspace workspace_;
  Eigen::VectorXd likely_q_;
};

}  // namespace footing::reconstruction

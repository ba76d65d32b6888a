#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/body/body.h"
#include "common/base/result.h"

namespace footing::eval {

/// Joint angles and orientations of links against the truth, as the exports have them.
class AngleScore {
 public:
  /// `body` must outlive it.
  explicit AngleScore(const body::Body& body) : body_(body) {}

  void Add(const Eigen::VectorXd& q, const Eigen::VectorXd& true_q, bool valid);

  /// The field joint_angles has an entry for each coordinate (joint_angles::JointAngles; both sides
  /// of a limb together) with RMS error, mean error, and the range of the true and the estimated
  /// angle; link_orientations one for each kind of link with the RMS of the whole rotation between
  /// estimate and truth in W. RMS errors are of all frames, of the valid ones, and of those in
  /// which a knee is reported as bent by kBentDeg or more (all: bent, and less: upright). A share
  /// without frames has no field.
  Result<void> WriteTo(nlohmann::ordered_json& json) const;

  /// Of the mean of both knees.
  static constexpr double kBentDeg = 30;

 private:
  const body::Body& body_;
  std::vector<Eigen::VectorXd> q_, true_q_;
  std::vector<bool> valid_;
};

}  // namespace footing::eval

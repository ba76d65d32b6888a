#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "daemon/offline/analysis/pose_metrics.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/pose/arm_network.h"

namespace footing::eval {

/// The arms estimated from the devices of a run against the truth from the T-pose on, beside an arm
/// that never moves, beside the kinematic prediction alone and beside these networks; the fields of
/// `footing-eval arm`. Straps on both segments need no model. `observed`: the devices whose
/// observability is reported (ArmBound); none where the motion repeats itself.
nlohmann::ordered_json RunArmTrial(const pose_run::ArmRun& run,
                                   const std::optional<arms::ArmModel>& model,
                                   const std::vector<arm_network::ArmNetwork>& networks,
                                   const std::optional<pose_run::Places>& observed);

/// One way to estimate an arm, against the truth.
class ArmScore {
 public:
  void Add(const arms::ArmGeometry& geometry, const arms::ArmDirections& estimate,
           const arms::ArmDirections& truth, const Eigen::Vector3d& hand_m);
  /// The fields of `footing-eval arm` that every way has.
  nlohmann::ordered_json Json() const;

 private:
  Spread shoulder_, elbow_, hand_;
  std::vector<double> cm_;  ///< Errors of hand_ in the order of time, cm.
};

/// How far the estimated rotation of a device since the T-pose is off, in all and of its up alone.
class TurnScore {
 public:
  void Add(const Eigen::Matrix3d& estimate, const Eigen::Matrix3d& truth);
  double mean_deg() const { return all_.mean(); }
  double inclination_deg() const { return inclination_.mean(); }

 private:
  Spread all_, inclination_;
};

/// Squared errors over the variances that go with them, per number; 1 where the deviations are
/// right.
class NeesScore {
 public:
  void Add(const arms::ArmEstimate& estimate, const arms::ArmDirections& truth);
  /// Mean over all frames, and means over parts of equal duration.
  double mean() const;
  std::vector<double> Parts(std::size_t count) const;

 private:
  std::vector<double> nees_;
};

/// footing-eval arm: the arms from a Wiimote in each hand under a motion, against the truth.
void AddArmCommand(CLI::App& app, Shared& shared);

/// How far one arm is from another: degrees, degrees and cm.
struct ArmDistance {
  double shoulder_deg = 0, elbow_deg = 0, hand_cm = 0;
};

ArmDistance Distance(const arms::ArmGeometry& geometry, const arms::ArmDirections& a,
                     const arms::ArmDirections& b);

/// One frame of an arm.
struct ArmMoment {
  /// How each place has truly turned since the T-pose, by arms::Place.
  std::array<Eigen::Matrix3d, arms::kPlaces> turns_W;
  arms::ArmDirections truth;
  ArmDistance error;  ///< Error of an estimate.
};

/// Lower bound on an arm's error given its devices. Where one person has the same attitude of all
/// devices at several times, now and a moment before, but holds the arm differently, no estimator
/// that goes by these attitudes can be right each time: its error is at least the deviation among
/// those moments, 1 / sqrt(2) of their distances from each other. Other people's motion, which
/// estimators are trained with, leaves more open.
class ArmBound {
 public:
  ArmBound(const arms::ArmGeometry& geometry, const pose_run::Places& places, double rate_hz)
      : geometry_(geometry), places_(places), rate_hz_(rate_hz) {}

  /// The next frame.
  void Add(const ArmMoment& moment) { moments_.push_back(moment); }
  /// Scores of both arms: the share of frames that have moments like them, the least error there,
  /// the share of these frames in which it is within the aims (8 and 8 degrees, 6 cm), and the
  /// estimate's error in them.
  static nlohmann::ordered_json Json(const std::vector<ArmBound>& arms);

 private:
  struct Sums {
    std::size_t alike = 0, observable = 0;
    ArmDistance least, error;  ///< Sums over frames; of the hands, of squares.
  };

  bool Alike(std::size_t a, std::size_t b, double most_rad) const;
  /// The arm of moment `other` as the devices of moment `now` would show it.
  arms::ArmDirections Moved(const ArmMoment& other, const ArmMoment& now) const;
  void AddFrame(std::size_t frame, Sums& sums) const;

  arms::ArmGeometry geometry_;
  pose_run::Places places_;
  double rate_hz_;
  std::vector<ArmMoment> moments_;
};

}  // namespace footing::eval

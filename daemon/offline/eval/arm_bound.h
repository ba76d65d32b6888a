#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/pose_run/held_hands.h"
#include "daemon/simulation/pose/arm_geometry.h"

namespace footing::eval {

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
  ArmDistance error;  ///< Of an estimate.
};

/// What the devices on an arm leave open of it. Where one person has the same attitude of all
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
  /// Of both arms: the share of frames that have moments like them, the least error there, the
  /// share of these frames in which it is within the aims (8 and 8 degrees, 6 cm), and the
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

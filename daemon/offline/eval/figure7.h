#pragma once

#include <optional>
#include <string>

#include "daemon/offline/eval/fused_score.h"
#include "daemon/offline/analysis/stick_plot.h"

namespace footing::eval {

/// The joints of a skeleton, and both hands.
struct StickPlaces {
  JointPlaces joints;
  std::array<Eigen::Vector3d, 2> hands;
};

/// Lines between them, seen from the front left.
plot::Sticks SticksOf(const StickPlaces& places);

/// Figure 7 of the pose paper: in the moment that hides most, the skeleton alone and what is made
/// of it with the boards, each over the truth. A moment is a squat, or any other in which joints
/// are inferred.
class Figure7 {
 public:
  struct Moment {
    double weight = 0;  ///< How much it shows: the one of most weight is drawn.
    double time_s = 0;
    int hidden = 0;
    StickPlaces truth, alone, fused;
  };

  void AddSquat(const Moment& moment) { Keep(moment, squat_); }
  void AddOther(const Moment& moment) { Keep(moment, other_); }
  std::string Svg() const;

 private:
  static void Keep(const Moment& moment, std::optional<Moment>& best) {
    if (!best || moment.weight > best->weight) best = moment;
  }

  std::optional<Moment> squat_, other_;
};

}  // namespace footing::eval

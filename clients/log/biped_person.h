#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "common/body/skeleton.h"
#include "footing/v1/character.pb.h"

namespace footing::log_client {

/// The place of a link, m, and its rotation, in W.
Eigen::Vector3d PlaceOf(const v1::Character& character, int link);
Eigen::Matrix3d TurnOf(const v1::Character& character, int link);

/// The biped of footing-sim's gait engine as a person, for formats and programs that know people.
///
/// The biped is a trunk on two legs that lengthen and shorten. The person has the standard
/// proportions, hips and ankles where the biped has its hips and feet, and knees that bend forwards
/// by as much as each leg is shorter than its longest. The trunk is that of the biped, the arms
/// hang, the feet are level. Knees, feet, arms and head are therefore a drawing; hips and ankles
/// are the simulation's.
class BipedPerson {
 public:
  /// Nothing where the skeleton is not the biped. `longest_leg_m` is the longest distance of a hip
  /// and its foot; a leg beyond it is drawn straight.
  static std::optional<BipedPerson> Of(const v1::Skeleton& biped, double longest_leg_m);
  /// Whether a skeleton is the biped, by the names of its links.
  static bool IsBiped(const v1::Skeleton& skeleton);
  /// The longer of the distances of a hip and its foot in this frame, m.
  static double LongestLegM(const v1::Skeleton& biped, const v1::Character& character);

  /// Joints and parents as a recording of the pose engine has them.
  v1::Skeleton Skeleton() const;
  /// The frame with the poses of the person's joints in place of the biped's links. The body counts
  /// as calibrated, and the forces at the feet are those of its contacts.
  v1::CharacterFrame Frame(const v1::CharacterFrame& frame) const;

 private:
  struct Leg {
    int hip = 0, knee = 0, ankle = 0;  ///< Joints of the person.
    int hip_link = 0, foot_link = 0;   ///< Links of the biped.
  };

  body::Skeleton skeleton_;
  std::array<Leg, 2> legs_;  ///< Left, right.
  std::array<int, 2> shoulders_{};
  double foot_below_link_m_ = 0;  ///< The foot's middle under the link that carries it.
  double ankle_over_foot_m_ = 0;
  std::array<Eigen::Matrix3d, 2> level_;  ///< R_WJ of the ankles of a person who stands ahead.
};

}  // namespace footing::log_client

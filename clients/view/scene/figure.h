#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "clients/view/scene/part.h"
#include "common/body/landmarks.h"
#include "common/stream/character.h"

namespace footing::scene {

/// Links of a skeleton that are landmarks of a person.
struct Anatomy {
  bool person = false;  ///< All that a figure is drawn from is there.
  body::Landmarks landmarks{};
  std::vector<int> parents;
  std::vector<float> radii_m;  ///< Half of each link's suggested size; 0 where it has none.
};

/// Finds the links by name; `person` is false where they are not a person's.
Anatomy FindAnatomy(const stream::Skeleton& skeleton);

/// True when a body of those parents has the same tree, so that the names fit it, too.
bool Fits(const Anatomy& anatomy, const std::vector<int>& parents);

/// Colours of a figure.
struct PersonLook {
  Colour skin, hair, eyes, lips, shirt, trousers, left_shoe, right_shoe;
  bool plain = false;  ///< Without fingers and features, which a silhouette does not show.
};

/// A dressed mannequin: left shoe blue, right shoe amber.
PersonLook MannequinLook();
/// All of one colour: a silhouette, or what is compared with.
PersonLook PlainLook(const Colour& colour);

/// Where the links of a person are, in W.
struct PersonPose {
  std::vector<Eigen::Vector3d> p_m;  ///< One a link.
  /// One a link; at rest, arms level, the axes of all are those of W. May be empty: the face then
  /// looks where the chest does, and the hands are turned as little as their arms allow.
  std::vector<Eigen::Quaterniond> orientations;
  std::vector<double> sd_m;  ///< Joints that are the less certain are the redder; may be empty.
};

/// Adds a figure in that pose. Where the links are not a person's, or not as many, a limb is drawn
/// along each of them.
void AddPerson(const Anatomy& anatomy, const PersonPose& pose, const PersonLook& look,
               PartList& parts);

/// Limbs along the links of any tree.
void AddLimbs(const std::vector<int>& parents, const std::vector<float>& radii_m,
              const std::vector<Eigen::Vector3d>& p_m, const Colour& colour, PartList& parts);

}  // namespace footing::scene

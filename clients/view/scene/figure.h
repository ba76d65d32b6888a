#pragma once

#include <vector>

#include <Eigen/Core>

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
  Colour skin, shirt, trousers, left_shoe, right_shoe, visor;
};

/// A dressed mannequin: left shoe blue, right shoe amber.
PersonLook MannequinLook();
/// All of one colour: a silhouette, or what is compared with.
PersonLook PlainLook(const Colour& colour);

/// Adds a figure whose joints are at `p_m` (W, one a link). Where the links are not a person's, or
/// not as many, a limb is drawn along each of them. Joints that are the less certain (`sd_m`, may
/// be empty) are the redder.
void AddPerson(const Anatomy& anatomy, const std::vector<Eigen::Vector3d>& p_m,
               const std::vector<double>& sd_m, const PersonLook& look, PartList& parts);

/// Limbs along the links of any tree.
void AddLimbs(const std::vector<int>& parents, const std::vector<float>& radii_m,
              const std::vector<Eigen::Vector3d>& p_m, const Colour& colour, PartList& parts);

}  // namespace footing::scene

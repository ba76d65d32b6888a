#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "clients/view/scene/anatomy.h"
#include "clients/view/scene/part.h"

namespace footing::scene {

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

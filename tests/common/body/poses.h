#pragma once

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/virtual/devices/noise.h"

namespace footing::body::test {

inline constexpr double kHeightM = 1.75;

inline Body StandardBody(double mass_kg = 70) {
  PersonParameters person;
  person.mass_kg = mass_kg;
  person.height_m = kHeightM;
  return MakeBody(StandardPerson(kHeightM), person).value();
}

inline Eigen::VectorXd RandomVector(int size, double range, noise::Random& random) {
  Eigen::VectorXd vector(size);
  for (int i = 0; i < size; ++i) vector(i) = random.Uniform(-range, range);
  return vector;
}

}  // namespace footing::body::test

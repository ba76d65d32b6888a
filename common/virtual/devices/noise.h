#pragma once

#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace footing::noise {

/// Random numbers whose bits depend on the seed alone: the standard fixes mt19937_64, and what
/// comes after it here is additions and one multiplication (the standard's distributions are not
/// fixed).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1), of 53 bits.
  double Uniform();
  /// In [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// A whole number in [low, high], evenly.
  int Integer(int low, int high) { return low + static_cast<int>(Uniform() * (high - low + 1)); }
  /// Mean 0, standard deviation 1: the sum of twelve uniforms less six, so within +-6.
  double Normal();

 private:
  std::mt19937_64 engine_;
};

/// Three independent normal numbers of mean 0, drawn x first.
Eigen::Vector3d NormalVector(double sd, Random& random);

}  // namespace footing::noise

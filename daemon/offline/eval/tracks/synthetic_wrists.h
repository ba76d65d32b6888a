#pragma once

#include "common/virtual/wrists/accelerometer.h"
#include "daemon/offline/eval/chain/features_chain.h"
#include "daemon/simulation/biped/command.h"
#include "daemon/simulation/mapping/wrist.h"

namespace footing::eval {

/// Two hands that swing a controller each so that the wrist interface understands a command, their
/// sensors, and footingd's chain from samples to features. The hands change over in 0.1 to 0.2 s.
class SyntheticWrists {
 public:
  SyntheticWrists(const mapping::WristMapping& mapping, std::uint64_t seed);

  /// Moves on by one reading of the sensors, kReadingS, towards what `wanted` needs.
  mapping::Inputs Advance(const biped::GaitCommand& wanted);

  static constexpr double kReadingS = 0.01;

 private:
  struct Swing {
    double frequency_hz = 1.5;
    double phase_rad = 3.14159265;
    double amplitude_mps2 = 0;
    double roll_rad = 0;
  };

  Swing For(const biped::GaitCommand& wanted) const;
  Eigen::Vector3d SpecificForce(double angle_rad) const;

  mapping::WristMapping mapping_;
  Chain chain_;
  noise::Random random_;
  wrists::SensorModel sensor_;
  wrists::Shape shape_;
  Swing now_;
  double angle_rad_ = 0;
  std::int64_t readings_ = 0;
};

}  // namespace footing::eval

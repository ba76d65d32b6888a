#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "tests/simulation/reconstruction/made_person.h"

namespace footing::reconstruction {

/// One person's movement, what is measured of it, and a reconstruction whose basis has seen it.
struct World {
  body::Body person = MadePerson();
  motion::Motion motion = MadeMotion(person, 18);
  std::vector<Inputs> inputs = Measured(person, motion);
  Models models = MakeModels({BasisOf(person, motion)}).value();
  body::Kinematics at{person.skeleton};

  Options AtRate(Mode mode = Mode::kBest, double lag_s = 0) const {
    Options options;
    options.mode = mode;
    options.rate_hz = kMadeRateHz;
    options.lag_s = lag_s;
    return options;
  }
  Reconstruction Made(const Options& options) const {
    return Reconstruction::Create(person, models, options).value();
  }
  /// Reconstruction by a basis in which everything moves, where the person's own is of crouches
  /// alone.
  Reconstruction FreelyMade() const {
    motion::Motion loose = motion;
    noise::Random random(5);
    for (double& value : loose.q.reshaped()) value += 0.1 * random.Normal();
    return Reconstruction::Create(person, MakeModels({BasisOf(person, loose)}).value(), AtRate())
        .value();
  }
  /// Mean distance of the joints from where they were `back` frames before frame i.
  double ErrorM(const Output& output, std::size_t i, std::size_t back) {
    body::ComputeKinematics(person.skeleton, motion.q.col(static_cast<Eigen::Index>(i - back)), at);
    double sum = 0;
    for (std::size_t k = 0; k < at.p_WJ.size(); ++k) sum += (output.p_WJ_m[k] - at.p_WJ[k]).norm();
    return sum / static_cast<double>(at.p_WJ.size());
  }
  double MeanErrorM(Reconstruction& reconstruction, std::size_t back) {
    double sum = 0, frames = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const Output& output = reconstruction.Advance(inputs[i]);
      if (!output.calibrated || i < 400) continue;
      sum += ErrorM(output, i, back);
      ++frames;
    }
    return frames > 0 ? sum / frames : std::numeric_limits<double>::infinity();
  }
};

inline bool Finite(const Output& output) {
  bool finite = output.q.allFinite();
  for (const Eigen::Vector3d& p : output.p_WJ_m) finite = finite && p.allFinite();
  for (const Eigen::Matrix3d& R : output.R_WJ) finite = finite && R.allFinite();
  finite = finite && output.com_W_m.allFinite() && output.com_variance_m2.allFinite() &&
           output.com_variance_m2.minCoeff() > 0;
  for (const double sd : output.joint_sd_m) finite = finite && std::isfinite(sd) && sd >= 0;
  return finite;
}

}  // namespace footing::reconstruction

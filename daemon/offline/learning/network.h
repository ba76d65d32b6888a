#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "daemon/simulation/pose/arm_network.h"

namespace footing::arm_network {

/// One arm in one recording, a frame after the other; the first ones in the T-pose.
struct Sequence {
  std::vector<FrameInput> inputs;
  std::vector<ArmPose> truth;
  std::vector<Eigen::Vector3d> forearm;  ///< Elbow to fist in the truth.
  double step_s = 0;
};

/// Options of an arm network's training.
struct TrainingOptions {
  /// Rounds of scheduled teacher forcing (Bengio et al. 2015): in the first the network receives
  /// the true last pose, in the last nothing but its own estimates. One: teacher forcing alone.
  int rounds = 4;
  /// On the true poses it receives, the same for two seconds: one network each, the best of which
  /// in closed loop is the result.
  std::vector<double> noises_rad = {0.2};
  int every = 12;  ///< Frames from one row of training to the next.
  /// Least numbers of hidden units, tried likewise; growth stops by the validation rows.
  std::vector<int> hidden_min = {0};
  int hidden_max = 10;
};

/// A trained arm network with its closed-loop error.
struct Trained {
  ArmNetwork network;
  int hidden_units = 0;
  int round = 0;           ///< The round it comes from, from 0.
  double noise_rad = 0;    ///< With which it was trained.
  double closed_loop = 0;  ///< RMS error of upper, hinge and forearm on the last fifths.
  std::size_t rows = 0;    ///< Rows in the last round's training.
};

/// Options of the paper's network: as well as it can be trained, since the paper does not say how.
TrainingOptions PaperOptions();

/// The last fifth of each sequence trains nothing; it chooses the hidden units, and the round by
/// its closed loop. At least one sequence with a bent elbow.
Trained Train(Kind kind, const std::vector<Sequence>& sequences, const TrainingOptions& options,
              std::uint64_t seed);

}  // namespace footing::arm_network

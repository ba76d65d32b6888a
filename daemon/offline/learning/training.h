#pragma once

#include <cstdint>
#include <vector>

#include "daemon/offline/learning/network.h"

namespace footing::arm_network {

/// One arm in one recording, a frame after the other; the first ones in the T-pose.
struct Sequence {
  std::vector<FrameInput> inputs;
  std::vector<ArmPose> truth;
  std::vector<Eigen::Vector3d> forearm;  ///< Of the truth: elbow to fist.
  double step_s = 0;
};

struct TrainingOptions {
  /// Of scheduled teacher forcing (Bengio et al. 2015): in the first the network receives the true
  /// last pose, in the last nothing but its own estimates. One: teacher forcing alone.
  int rounds = 4;
  double noise_rad = 0.2;  ///< On the true poses it receives, the same for two seconds.
  int every = 12;          ///< Frames from one row of training to the next.
  int hidden_max = 10;
};

struct Trained {
  ArmNetwork network;
  int hidden_units = 0;
  int round = 0;           ///< Of which it comes, from 0.
  double closed_loop = 0;  ///< RMS error of upper, hinge and forearm on the last fifths.
  std::size_t rows = 0;    ///< Of the last round's training.
};

/// The paper's: one round, no noise.
TrainingOptions PaperOptions();

/// The last fifth of each sequence trains nothing; it chooses the hidden units, and the round by
/// its closed loop. At least one sequence with a bent elbow.
Trained Train(Kind kind, const std::vector<Sequence>& sequences, const TrainingOptions& options,
              std::uint64_t seed);

}  // namespace footing::arm_network

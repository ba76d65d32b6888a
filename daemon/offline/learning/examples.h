#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

/// Trainers of small networks. The same examples, options and seed give the same bits.
namespace footing::learning {

/// What a network learns from: row p of `inputs` gives row p of `targets`, in the data's own units.
struct Examples {
  Eigen::MatrixXd inputs;
  Eigen::MatrixXd targets;

  Eigen::Index rows() const { return inputs.rows(); }
};

/// Training and validation, split in time: neighbours in a recording are nearly equal, so that rows
/// drawn at random would test a network by what it learned from.
struct Split {
  Examples train, validation;
};

/// The last `fraction` of the rows, in [0, 1), is for validation.
Split SplitInTime(const Examples& all, double fraction);

/// The rows of all, one after the other. At least one; equal columns.
Examples Joined(const std::vector<const Examples*>& parts);

/// Noise on inputs that are the network's own earlier outputs in use. A network trained on perfect
/// ones goes on from its first error to the end of the world (closed loop, pose paper, section 4.2:
/// the COM positions); one trained with noise learns to come back.
struct FeedbackNoise {
  /// Columns of one signal at several instants, a group each: an estimate that is wrong is wrong by
  /// nearly the same at each of them.
  std::vector<std::vector<Eigen::Index>> groups;
  double common_sd = 0;  ///< Of the error that a row's group shares, in the inputs' unit.
  double own_sd = 0;     ///< Of each column's own error besides.
  int copies = 1;        ///< Of every row, each with other noise.
};

/// The rows with noise on their inputs; targets stay true. Without groups, the rows as they are.
Examples WithFeedbackNoise(const Examples& examples, const FeedbackNoise& noise,
                           std::uint64_t seed);

}  // namespace footing::learning

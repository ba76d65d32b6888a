#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/camera/disc_model.h"
#include "common/camera/settings.h"

/// Pixels side by side, their residuals and their normal equations.
namespace footing::sphere::disc {

inline constexpr int kLevels = kShape + kMotion;  // Where those of the first channel are.
inline constexpr int kParameters = kLevels + 6;
inline constexpr int kOwn = kShape + 2;  // What one pixel of a sphere at rest depends on.
inline constexpr int kOwnMoving = kOwn + kMotion;
inline constexpr double kHuber = 2.5;

using Normal = Eigen::Matrix<double, kParameters, kParameters>;
using Right = Eigen::Matrix<double, kParameters, 1>;

/// One pixel that takes part.
struct Sample {
  Eigen::Vector2d slopes;
  double value;
  int channel;
  int sector;
  double later = 0;   // When its row is exposed, after the row of the blob's middle, in exposures.
  double behind = 0;  // What is behind the sphere there, less the state's `outside`, DN.
  // At the state that was evaluated last.
  double beyond = 0;    // Blurs outside of the edge.
  double residual = 0;  // Over its deviation.
  double height = 0;    // Contrast of its channel, alike.
};

/// About `most` of them, spread evenly; the four pixels of a quad stay together.
std::vector<Sample> Thinned(const std::vector<Sample>& all, std::size_t most);

/// Pixels of one channel; `is_used` is 0 for what is left over, 1 for others.
struct Block {
  std::size_t channel = 0;
  int count = 0;
  std::array<std::size_t, kBlock> samples{};
  Lane s, t, later, value, behind, is_used;
  Lane beyond, residual, height;  // As a sample's.
};

/// When a block's pixels are exposed after the row of a state's axis, in exposures.
Lane AfterAxis(const Block& block, const State& state, const PixelScale& scale);

void ToBlocks(const std::vector<Sample>& samples, std::vector<Block>& blocks);
/// What was evaluated, back to the samples.
void ToSamples(const std::vector<Block>& blocks, std::vector<Sample>& samples);

/// How pixels depend on their own parameters (`kSize` is kOwn or kOwnMoving): the model's, then
/// the levels inside and outside of their channel.
template <int kSize>
struct Rows {
  std::array<Lane, static_cast<std::size_t>(kSize)> row;
  Lane off;       // Value less the model's, DN.
  Lane weight;    // Huber's, over the variance; zero for what is left over.
  Lane cost;      // Huber's.
  Lane modelled;  // The model's value, DN.
};

/// Evaluates a block at a state.
template <int kSize>
void ToRows(Block& block, const State& state, const PixelNoise& noise, const PixelScale& scale,
            const ProfileTable& table, Rows<kSize>& rows);

/// Normal equations; a pixel knows only its own channel's levels.
template <int kSize>
class Equations {
 public:
  void Add(const Rows<kSize>& rows, std::size_t channel);
  /// Of all parameters; those that take no part get a 1 on the diagonal.
  void Assemble(Normal& normal, Right& right) const;

 private:
  using Part = Eigen::Matrix<double, kSize, kSize>;  // Its upper triangle.
  using Row = Eigen::Matrix<double, kSize, 1>;
  std::array<Part, 3> per_channel_{Part::Zero(), Part::Zero(), Part::Zero()};
  std::array<Row, 3> right_{Row::Zero(), Row::Zero(), Row::Zero()};
};

}  // namespace footing::sphere::disc

#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/camera/disc_fit.h"
#include "common/camera/disc_model.h"
#include "common/camera/edges.h"

/// Pixels side by side, their residuals and their normal equations.
namespace footing::sphere::disc {

inline constexpr int kLevels = kShape + kMotion;  // Where those of the first channel are.
inline constexpr int kParameters = kLevels + 6;
inline constexpr int kOwn = kShape + 2;  // Parameters of one pixel of a sphere at rest.
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
  double behind = 0;  // Light behind the sphere there, less the state's `outside`, DN.
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

/// Packs samples into blocks for vector arithmetic.
void ToBlocks(const std::vector<Sample>& samples, std::vector<Block>& blocks);
/// Copies the evaluated values back to the samples.
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
  /// Equations of all parameters; those that take no part get a 1 on the diagonal.
  void Assemble(Normal& normal, Right& right) const;

 private:
  using Part = Eigen::Matrix<double, kSize, kSize>;  // Its upper triangle.
  using Row = Eigen::Matrix<double, kSize, 1>;
  std::array<Part, 3> per_channel_{Part::Zero(), Part::Zero(), Part::Zero()};
  std::array<Row, 3> right_{Row::Zero(), Row::Zero(), Row::Zero()};
};

inline constexpr double kPoorSds = 4;            // A misfit that noise does not explain.
inline constexpr double kGoodSds = 2.5;          // One that it does.
inline constexpr std::size_t kSomePixels = 200;  // Enough to choose between explanations.

/// How well a solution explains the pixels.
struct Solution {
  State state;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Errors of axis and tangent.
  double misfit = 0;          ///< Mean square residual over its expectation.
  double misfit_sds = 0;      ///< By how many of its deviations that is more than 1.
  double excess_chi2 = 0;     ///< Chi² of the residuals beyond its expectation.
  double residual_share = 0;  ///< RMS residual over the contrast.
  double log_evidence = 0;    ///< Log evidence but for a constant; Laplace's approximation.
  std::size_t pixels = 0;
};

/// Mean by evidence of several explanations of the same pixels, with their distances in its
/// covariance. The rest is the likeliest one's.
Solution Mean(const std::vector<Solution>& modes);

/// Evidence of motion in the residuals of a sphere at rest.
struct MotionScore {
  double chi2 = 0;                  ///< Chi² with four degrees of freedom if it is at rest.
  Eigen::Vector2d motion_px{0, 0};  ///< To begin with; its sign is uncertain.
  /// Covariance of axis and tangent that a motion too small to be seen adds.
  Eigen::Matrix3d unseen = Eigen::Matrix3d::Zero();
};

/// The pixels around a sphere and the fit of the model to them.
class Fitter {
 public:
  /// `motion_sd_px`: travel in the image during the exposure that is expected; `lit`: quads that
  /// take no part. All but the number are borrowed.
  Fitter(const Settings& settings, const ProfileTable& table, const PixelScale& scale,
         const LitQuads& lit, double motion_sd_px)
      : settings_(settings), table_(table), scale_(scale), lit_(lit), motion_sd_px_(motion_sd_px) {}

  /// Takes the pixels of a disc and of `far_blurs` around it, some `most_pixels` of them.
  void Collect(const Image& image, const LocalSlopes& slopes, const Eigen::Vector2d& middle_px,
               const State& state, double far_blurs, int most_pixels);
  /// Leaves out what is beyond each sector's reach; says which sectors have the edge in reach.
  std::vector<bool> Limit(const State& state, const SectorReach& reach);
  /// See disc::LookBehind; `moving_px` is the travel within the ring.
  void LookBehind(const State& state, double moving_px, std::vector<bool>& sectors);
  /// Leaves out what is not on the near side of a line: (slopes - at) . away < -margin.
  void KeepBefore(const Eigen::Vector2d& at, const Eigen::Vector2d& away, double margin);
  /// Sectors whose light around the edge does not fit are taken out. Returns how many were.
  int DropSectors(std::vector<bool>& sectors);

  /// From a start; nothing when it runs away. `moves`: the motion is a parameter, too.
  std::optional<Solution> Solve(State state, bool moves, int rounds);
  /// Sets the residuals of the samples, of a sphere at rest.
  void Evaluate(const State& state);
  /// Score of the solution that was found last, of a sphere at rest.
  MotionScore ScoreMotion(const State& state);

  const std::vector<Sample>& samples() const { return samples_; }
  void Use(std::vector<Sample> samples) { samples_ = std::move(samples); }
  /// Share of the pixels inside that are at the sensor's limit.
  double clipped_share() const { return inside_ > 0 ? static_cast<double>(clipped_) / inside_ : 0; }
  /// One blur, in slopes.
  double Blur() const { return settings_.profile.blur_px * scale_.Along(Eigen::Vector2d::UnitX()); }

 private:
  template <int kSize>
  std::optional<State> Descend(State state, int rounds, double& cost);
  template <int kSize>
  double Evaluate(const State& state, Equations<kSize>& equations);
  template <int kSize>
  void Assemble(const State& state, const Equations<kSize>& equations, Normal& normal,
                Right& right) const;
  void CollectQuad(const Image& image, const LocalSlopes& slopes, const Eigen::Vector2d& middle_px,
                   const State& state, int u, int v, double far_blurs, int& quad, int every);
  double BeyondOf(const Eigen::Vector2d& slopes, const State& state) const;
  double PriorCost(const State& state) const;
  struct ScoreSums;
  ScoreSums SumScore(const State& state);
  Solution Report(const State& state, double cost, bool moves) const;

  const Settings& settings_;
  const ProfileTable& table_;
  const PixelScale& scale_;
  const LitQuads& lit_;
  double motion_sd_px_;
  double growth_sd_ = 1;  // Deviation of `growth` in the last solution.
  std::vector<Sample> samples_;
  std::vector<Block> blocks_;  // The same, as they were solved last.
  int inside_ = 0, clipped_ = 0;
  Normal normal_;  // Normal equations at the state that was solved last.
};

/// Evidence of motion in the residuals of a sphere at rest, and the effect of motion on its fit.
struct MotionEvidence {
  /// Blur with twice the angle, px: its cosine and sine; travel that the rolling shutter shows, px.
  Eigen::Vector4d change;
  Eigen::Matrix4d information;             ///< Inverse of the noise of these.
  double blur_px = 0;                      ///< Blur of the sphere at rest.
  Eigen::Vector3d per_blur;                ///< Axis and tangent by an even blur,
  Eigen::Matrix<double, 3, 2> per_travel;  ///< and by travel.
};

/// Mean square error of axis and tangent that a motion leaves which is not modelled: over all
/// motions that the evidence allows. Travel is normal along each axis, with `motion_sd_px`; some
/// hands are at rest.
Eigen::Matrix3d UnseenMotion(const MotionEvidence& evidence, double motion_sd_px);

/// Variance of a pixel's value, DN².
double Variance(const PixelNoise& noise, double value);

/// Sets `behind` of each sample. Where what is behind the sphere is not the same all around, as a
/// coloured thing beyond part of its edge, a sector gets a level of its own, of the ring around it;
/// sectors on a border of two levels are taken out, with their samples at the edge. `beyond` of the
/// samples is used. `more_blurs`: how much farther out the ring begins, beyond a sphere's travel.
void LookBehind(std::vector<Sample>& samples, const State& state, const PixelNoise& noise,
                double more_blurs, std::vector<bool>& sectors);

/// Sectors whose edge is seen, less those beside a hidden part of it: what hides it darkens the
/// edge there too, as far as the blur reaches, which is `beside` sectors. One or two unseen sectors
/// are noise, and hidden by nothing.
std::vector<bool> WithoutBorders(const std::vector<bool>& seen, double beside);

}  // namespace footing::sphere::disc

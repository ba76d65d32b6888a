#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/camera/disc_fit.h"
#include "common/camera/disc_rows.h"

namespace footing::sphere::disc {

inline constexpr double kPoorSds = 4;            // A misfit that noise does not explain.
inline constexpr double kGoodSds = 2.5;          // One that it does.
inline constexpr std::size_t kSomePixels = 200;  // Enough to choose between explanations.

/// How well a solution explains the pixels.
struct Solution {
  State state;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of axis and tangent.
  double misfit = 0;          ///< Mean square residual over its expectation.
  double misfit_sds = 0;      ///< By how many of its deviations that is more than 1.
  double excess_chi2 = 0;     ///< Of the residuals, beyond their expectation.
  double residual_share = 0;  ///< RMS residual over the contrast.
  double log_evidence = 0;    ///< Of the pixels, but for a constant; Laplace's approximation.
  std::size_t pixels = 0;
};

/// Of several explanations of the same pixels: their mean by evidence, and how far they are apart
/// in its covariance. The rest is the likeliest one's.
Solution Mean(const std::vector<Solution>& modes);

/// What the residuals of a sphere at rest say of motion.
struct MotionScore {
  double chi2 = 0;                  ///< Of four degrees of freedom if it is at rest.
  Eigen::Vector2d motion_px{0, 0};  ///< To begin with; its sign is uncertain.
  /// What a motion that is too small to be seen adds to the covariance of axis and tangent.
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
  /// Of the solution that was found last, of a sphere at rest.
  MotionScore ScoreMotion(const State& state);

  const std::vector<Sample>& samples() const { return samples_; }
  void Use(std::vector<Sample> samples) { samples_ = std::move(samples); }
  /// Of the pixels inside, those at the sensor's limit.
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
  double growth_sd_ = 1;  // Of what was solved last.
  std::vector<Sample> samples_;
  std::vector<Block> blocks_;  // The same, as they were solved last.
  int inside_ = 0, clipped_ = 0;
  Normal normal_;  // Of the state that was solved last.
};

}  // namespace footing::sphere::disc

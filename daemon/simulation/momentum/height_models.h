#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "daemon/simulation/momentum/cell_play.h"
#include "daemon/simulation/momentum/linear_filter.h"

namespace footing::momentum {

/// A body at rest has loads that hardly change, whatever they are, and a COP that stays. A plain
/// value.
class RestWatch {
 public:
  /// `raw_mps2`: the acceleration that the loads show, with the weight of the T-pose.
  void Advance(double raw_mps2, const VerticalInput& input, double step_s);
  void Stop() { steady_s_ = 0; }
  bool rests() const;
  /// Mean of the acceleration since the loads are steady.
  double level_mps2() const { return level_mps2_; }

 private:
  bool started_ = false;
  double steady_s_ = 0, near_mps2_ = 0, level_mps2_ = 0;
  Eigen::Vector2d cop_m_ = Eigen::Vector2d::Zero();  ///< Smoothed, and so its speed.
  double cop_mps_ = 0;
};

/// Height of the centre of mass over its height in the T-pose, from the loads and from postures
/// (docs/momentum.md, "Vertical COM").
///
/// An interacting multiple-model estimator (Blom & Bar-Shalom 1988): each assumption about the
/// cells and the weight goes with each of two about the posture. It shows the height, or hides it,
/// as of a person who squats with still hands. Each of these models is a Kalman filter with a
/// probability; the estimate is the mean of all, with their distances in its variance.
///
/// States of a filter: height, velocity, slow error of the acceleration, the gain error of each
/// group of cells, half the width of the cells' play, the posture's error. A plain value that
/// allocates nothing.
class HeightModels {
 public:
  static constexpr int kGroups = VerticalInput::kGroups;
  static constexpr int kStates = 5 + kGroups;
  static constexpr int kSlots = 25;
  using Filter = LinearFilter<kStates, kSlots>;
  /// Assumptions about the cells: accurate, inaccurate, with play, and four of a weight that has
  /// just changed, since different times.
  static constexpr std::size_t kCells = 7;

  /// `arms_hang_m` is Subject's, `cell_noise_n` the T-pose's. `posture_spread_m`: standard
  /// deviation of the height of a posture that shows it; 0: postures are not asked.
  HeightModels(double mass_kg, double step_s, double arms_hang_m, double cell_noise_n,
               double posture_spread_m);

  /// Only Height of up to so many steps ago will be asked for. Before Start.
  void KeepLag(int lag_steps);
  /// The body stands still in its T-pose; `mean` is the calibration's mean load of each group.
  void Start(const VerticalInput& mean);
  void Advance(const VerticalInput& input);
  /// Hands and feet alone have the body that high over the T-pose, in the frame of the last
  /// Advance.
  void SeePosture(double height_m);
  /// Nothing was measured in this step.
  void Coast();
  /// The body comes down onto the cells, at an unknown height and velocity. After Start.
  void Land();
  /// The cells, which were silent, measure a body again: it most likely stands. After Start.
  void Reappear();
  /// The body's feet come down, so its legs are nearly straight. False where the height is certain
  /// to be another: the flight did not begin here.
  bool CanLand() const;
  /// The height is known to 12 cm.
  bool trusted() const;

  /// Mean and variance, with what remains uncertain in every model.
  Filter::Scalar Height(int lag_steps) const;
  Filter::Scalar Velocity() const;
  double acceleration_mps2() const;
  /// The T-pose's, or what it was found to be.
  double mass_kg() const;

 private:
  struct Model {
    Filter filter;
    double probability = 0;
  };
  /// Models with the same cells: the posture shows the height, or hides it.
  static constexpr std::size_t kShows = 0, kHides = 1, kPostures = 2;
  using Pair = std::array<Model, kPostures>;

  template <typename Apply>
  void ForEach(Apply&& apply);
  /// Sum over all models of probability and apply(filter).
  template <typename Apply>
  double Mean(Apply&& apply) const;
  Filter::Scalar Mixture(const Filter::Row& row) const;

  /// Weighs the models by what `apply` finds.
  template <typename Apply>
  void Reweigh(Apply&& apply);
  bool sees_posture() const;
  double posture_spread_m() const;
  void Predict(const VerticalInput& input);
  /// Whether the posture is still that of the T-pose.
  void FollowTPose(double height_m);
  void LookAtRest();
  void Look();
  void LookAtPosture();
  void LookAtLimits();
  /// The least and the greatest height that legs allow; without postures also where bodies are.
  double Limit(std::size_t cells, Filter& filter, double top_m, bool anchors) const;
  /// Log of the probability that the cells measure a weight so wrong.
  double LogMostWrong(const Filter& filter) const;
  /// Postures begin and cease to show the height.
  void MixPostures(Pair& pair) const;
  /// Cells become others, at a low rate.
  void MixCells();
  void Restart();
  /// The cells begin with the state of others.
  void Fork(std::size_t cells, std::size_t from);
  /// No body is where all models have it.
  bool IsLost(std::size_t best);
  void Normalise();
  void Begin(double height_sd_m, double velocity_mps, double velocity_sd_mps);
  /// Load that the cells measure too much, as a part of the weight, with the T-pose's loads.
  Filter::Row OverweightRow() const;
  /// Acceleration that the loads show of a body that has none.
  Filter::Row LevelRow() const;

  double mass_kg_, step_s_, arms_hang_m_, noise_n_, posture_m_;
  std::array<Pair, kCells> models_;
  /// Log odds of the cells against the best ones, without the rate at which cells change, and the
  /// time since they began with the state of others.
  std::array<double, kCells> behind_{}, since_fork_s_{};
  VerticalInput mean_, last_;
  CellPlay play_;
  RestWatch rest_;
  bool started_ = false;
  double raw_mps2_ = 0;    ///< Acceleration that the loads of the last frame show.
  double unloaded_s_ = 0;  ///< Since when hardly any load was on the cells.
  double lost_s_ = 0, landing_s_ = 0;
  struct {
    bool held = true;
    double frames = 0, mean_m = 0, near_m = 0;  ///< Heights of the postures so far, and now.
  } t_pose_;
  struct {
    double posture_s = 0, rest_s = 0, anchor_s = 0;
  } since_look_;
  struct {
    double since_s = 1;  ///< Since the last one.
    double height_m = 0, smooth_m = 0;
    double looked_m = 0, looked_mps = 0;  ///< At the last look, and its speed there.
    bool landed = true;                   ///< One was seen since the landing.
  } seen_;
};

/// Offline: the inaccurate cells' filter without postures, forward, then Rauch-Tung-Striebel
/// backwards. Allocates.
std::vector<HeightModels::Filter::Scalar> SmoothHeight(double mass_kg, double step_s,
                                                       double arms_hang_m, double cell_noise_n,
                                                       const VerticalInput& mean,
                                                       const std::vector<VerticalInput>& inputs);

}  // namespace footing::momentum

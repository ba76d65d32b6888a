#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "daemon/simulation/momentum/linear_filter.h"

namespace footing::momentum {

/// Assumptions about a body's height, its stillness and the load cells.
struct VerticalConfig {
  // The cells.
  double cell_noise_n = 0.5;     ///< White, of each cell and frame.
  double gain_spread = 0.005;    ///< Standard deviation of a cell group's gain.
  double slow_force_n = 1.0;     ///< Standard deviation of the boards' slow error.
  double slow_force_time_s = 5;  ///< Its correlation time.
  double play_n = 0;             ///< Standard deviation of half the width of all cells' play.
  double mass_error_kg = 0.05;   ///< Standard deviation of the calibration's mass.
  /// Standard deviation of the gain error that all cells share, beside their own gains.
  struct {
    double spread = 0;  ///< At first, as a share of the weight.
    double walk = 0;    ///< By which it wanders, per root second.
    /// By which the weight may differ, as a share, once the T-pose is left: who leaned on something
    /// in it, or held something, may do so no longer.
    double after_t_pose = 0;
  } weight;
  /// Still is who keeps the acceleration that the loads show, whatever it is; else who has none.
  bool still_at_any_weight = false;
  // Zero-velocity events.
  double still_acceleration_mps2 = 0.12;  ///< Limit of the smoothed |acceleration|.
  double still_cop_mps = 0.06;            ///< Limit of the smoothed speed of the COP.
  double still_velocity_mps = 0.01;       ///< Standard deviation of the velocity then.
  // The anchor: at one look a body stands upright with some probability, or is anywhere.
  double look_s = 0.5;  ///< Time between independent looks.
  double upright_share = 0.85;
  double upright_below_m = 0.02;  ///< Arms hang: lower than in the T-pose.
  double upright_spread_m = 0.03;
  double low_below_m = 0.12;  ///< Mean and spread of all other heights.
  double low_spread_m = 0.15;
  double highest_m = 0.12;  ///< Over the T-pose, with load on the feet: tiptoe, arms up.
  PostureError posture;     ///< Error of the height by hands and feet alone.
  /// Postures count only where the body rests, with an error that stays the same; for a few seconds
  /// from one rest to the next the loads alone are integrated.
  bool by_rests = false;
};

/// One frame: the load of each group of cells, and where the COP is.
struct VerticalInput {
  static constexpr int kGroups = 8;
  std::array<double, kGroups> load_n{};
  double play = 0;  ///< CellPlay::Advance; 0 where it does not count.
  bool cop_valid = false;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
};

/// Finding of a filter with VerticalConfig::by_rests when the body rests again.
struct Return {
  /// As high and as slow as the posture shows, within what both may be off, or still at a height
  /// that the posture does not show.
  bool back = false;
  bool by_loads = false;  ///< Nothing but the loads led there from the last rest.
  double evidence = 0;    ///< Log density of that, less its log density if the cells were wrong.
};

/// Height of the centre of mass over its height in the T-pose, by a Kalman filter of the loads.
///
/// States: height, velocity, slow error of the acceleration, one gain error per group of cells,
/// half the width of the cells' play, the posture's error. The loads enter as an input; the cells'
/// gains and play, the mass and the slow error are found by what the filter learns when the body is
/// still (zero velocity) and upright (a mixture of densities, matched in its moments): the more
/// doubtful the height, the wider the reach of the anchor. A plain value.
class VerticalCom {
 public:
  static constexpr int kStates = 5 + VerticalInput::kGroups;
  /// Where the gains begin in the state, and where play and posture are.
  static constexpr int kGains = 3, kPlay = kGains + VerticalInput::kGroups, kPosture = kPlay + 1;
  static constexpr int kSlots = 25;
  static constexpr double kStillAfterS = 0.2;
  /// By which raised heels lift a body that a posture has upright.
  static constexpr double kTiptoeM = 0.08;
  using Filter = LinearFilter<kStates, kSlots>;

  VerticalCom(const VerticalConfig& config, double mass_kg, double step_s);

  /// Only Height of up to so many steps ago will be asked for. Before Start.
  void KeepLag(int lag_steps) { filter_.Keep(lag_steps + 1); }
  /// The body stands still in its T-pose; `mean` is the calibration's mean load of each group.
  void Start(const VerticalInput& mean);
  void Advance(const VerticalInput& input);
  /// Hands and feet alone have the body that high, in the frame of the last Advance.
  void SeePosture(double height_m);
  /// True once it is sure of a height that no body has, or that no posture comes near: what it has
  /// learned is wrong. Until Reseed, Adopt or Start.
  bool strayed() const { return posture_.strayed; }
  /// The last posture was further off than both can be wrong by, by three deviations.
  bool contradicted() const { return posture_.contradicted; }
  /// With config.by_rests: what came of the way to the rest that was found in the last frame with a
  /// posture, or a way on which the body is certainly too high. Once.
  std::optional<Return> TakeReturn();
  /// With config.by_rests: the body rests, or did so few enough seconds ago.
  bool follows_loads() const { return rest_.away_s <= kAwayS; }
  /// Adopt of a filter with config.by_rests: the posture's error is not known, the weight doubted.
  void RestartFrom(const VerticalCom& other);
  /// Restarts at that height, with what was learned of the cells doubted.
  void Reseed(double height_m, double height_sd_m, double velocity_mps, double velocity_sd_mps);
  /// The same of a body whose feet have just come down: how far its knees give way is not shown by
  /// hands and feet.
  void Land(double height_m, double height_sd_m, double velocity_mps, double velocity_sd_mps);

  Filter::Scalar Height(int lag_steps) const { return filter_.Delayed(lag_steps); }
  Filter::Scalar Velocity() const { return filter_.Of(Filter::Row::Unit(1)); }
  double acceleration_mps2() const { return acceleration_mps2_; }  ///< Corrected, of this frame.
  /// With config.still_at_any_weight: the body is still in its T-pose, with loads that are steady.
  bool holds_t_pose() const;
  bool still() const { return still_.for_s >= kStillAfterS; }
  /// Load that the cells measure too much beside the mass, as a part of the weight, with the
  /// T-pose's loads.
  Filter::Scalar Overweight() const { return filter_.Of(overweight_); }
  /// Half the width of the cells' play, N.
  Filter::Scalar Play() const;
  /// Takes what they measure too much into the mass.
  void Reweigh();
  double mass_kg() const { return mass_kg_; }  ///< By which the loads are divided.
  double weighed_kg() const;                   ///< The same with what they measure too much.

  /// How well the last minute's events were foreseen: the sum of the log densities of what was
  /// found at them, older ones forgotten.
  double score() const { return score_; }
  /// Takes over the state and the mass of another filter, with its doubts; its own configuration
  /// stays.
  void Adopt(const VerticalCom& other);
  /// The width of the cells' play is no longer taken to be surer than at first.
  void DoubtPlay();
  /// Nothing was measured in this step.
  void Coast();

  const Filter& filter() const { return filter_; }
  const Filter::Matrix& transition() const { return a_; }
  const Filter::Matrix& noise() const { return q_; }
  const Filter::Vector& input_shift() const { return u_; }

 private:
  void Watch(const VerticalInput& input, double raw_mps2);
  /// For how long the loads are steady, by what they show.
  void WatchLevel(double raw_mps2);
  /// Where a posture is the T-pose's no longer, it says nothing more of height and weight.
  void FollowHold(double height_m);
  /// All groups may measure too much in common, by one more deviation of that share.
  void DoubtWeight(double share);
  void LookAtTPose(const VerticalInput& input);
  /// Steady loads that show so much of an acceleration show a weight: were they not, the body would
  /// have moved further than its posture.
  bool IsWeight(double left_mps2) const;
  /// Nobody stands still at two loads. Where a body that hands and feet show to be still, too,
  /// should be accelerating by what its filter has learned, what it weighs has changed since.
  void LookAtLevel(const VerticalInput& input);
  /// Row of the load that the cells measure too much, as the acceleration (m/s²) that they show of
  /// a body that has none.
  Filter::Row LevelRow(const VerticalInput& input) const;
  /// It is `level_mps2`, to within a deviation, and `left_mps2` more than the filter knew.
  void LearnLevel(const Filter::Row& row, double level_mps2, double left_mps2, double sd_mps2);
  void LookAtVelocity();
  void Anchor();
  void AnchorToPosture(double height_m);
  /// Takes the height by a posture, over that in the T-pose, where postures count only at rest.
  void SeeRest(double height_m);
  /// Whether the body has come to rest, at the height of the posture or at another.
  void ComeToRest(double height_m);
  void LookAtRest(double height_m);
  /// Where the last rest was no longer says anything.
  void LeaveRests();
  /// Fit of the state to the height that a posture shows and to a velocity of zero; `wrong`: error
  /// that wrong cells may add to both (m, m/s).
  struct Fit {
    double distance2 = 0, log_density = 0;
  };
  Fit FitOfRest(double height_m, double wrong) const;
  /// Fit of the state to a velocity of zero alone.
  Fit FitOfStillness(double wrong) const;
  double PostureMean() const;
  double PostureSpread() const;
  /// Where the body is by a posture that has it that high.
  std::array<Component, 2> ByPosture(double height_m) const;
  /// The speed at which the posture rises, and from time to time a look at it.
  void FollowSpeed(double height_m);
  void LookAtPostureSpeed();
  /// The body does not fly, by what the loads show beside the weight.
  static bool Loaded(double raw_mps2);
  /// Too high or too low for any body, for sure: its height is not to be corrected but given up.
  bool IsImpossible(const Filter::Scalar& height) const;
  void Score(double log_density);

  VerticalConfig config_;
  double mass_kg_;
  double step_s_;
  Filter filter_;
  Filter::Matrix a_;
  Filter::Matrix q_;
  Filter::Vector u_;
  Filter::Row overweight_ = Filter::Row::Zero();
  struct {
    bool started = false;
    VerticalInput input;
    double raw_mps2 = 0;
  } last_;
  double acceleration_mps2_ = 0;
  double level_mps2_ = 0;  // Acceleration that the loads show, slowly smoothed.
  struct {
    Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();  ///< Smoothed, and so its speed.
    double speed_mps = 0;
  } cop_;
  struct {
    double mean_mps2 = 0;  ///< |acceleration|, smoothed.
    double for_s = 0, since_look_s = 0;
  } still_;
  double since_look_s_ = 0;
  struct {
    double since_score_s = 0;
    double anchors_s = 0;               ///< For how much longer the last one stands for the height.
    double level_m = 0, speed_mps = 0;  ///< Smoothed.
    double gained_mps = 0;  ///< Velocity now beside one that is smoothed like the speed.
    double since_speed_s = 0;
    double far_s = 0;      ///< For how long it has been too far from the posture.
    double landing_s = 0;  ///< For how much longer its knees may give way.
    bool strayed = false;
    bool contradicted = false;
  } posture_;
  struct {
    /// Acceleration by loads that hardly change: now, and the mean so far.
    double near_mps2 = 0, mean_mps2 = 0;
    double since_s = 0;
  } steady_;
  struct {
    bool held = true;                           ///< The posture is still that of the T-pose.
    double frames = 0, mean_m = 0, near_m = 0;  ///< Heights of the postures so far, and now.
    double since_look_s = 0;
  } t_pose_;
  double score_ = 0;
  static constexpr double kAwayS = 6;
  struct {
    bool rests = false;
    bool known = true;                   ///< In the rest the height is that of the posture.
    double away_s = 0;                   ///< Since the last rest, 0 in it and in the T-pose.
    double calm_s = 0;                   ///< For how long the loads hardly move.
    double lowest_m = 0, highest_m = 0;  ///< Heights since it left the last rest.
    double since_look_s = 0;
    std::optional<Return> found;
  } rest_;
};

/// Offline: forward, then Rauch-Tung-Striebel backwards. Allocates.
std::vector<VerticalCom::Filter::Scalar> SmoothVertical(const VerticalConfig& config,
                                                        double mass_kg, double step_s,
                                                        const VerticalInput& mean,
                                                        const std::vector<VerticalInput>& inputs);

/// At which end of its play each group of cells is, by its readings alone. A cell with a play of
/// half width h reads h too little while its load grows and h too much while it falls, and does not
/// move between the two (the play operator: Krasnosel'skii & Pokrovskii 1989). A reading that moves
/// by more than its noise is at an end; where the load is within the play of one that rests is not
/// shown, so that the middle is taken within a tenth of a second. A plain value.
class CellPlay {
 public:
  explicit CellPlay(double cell_noise_n) : noise_n_(cell_noise_n) {}

  /// The sum over the groups of the shares of h, -1 to 1, that they read too little, `step_s` after
  /// the sample before. 0 at first.
  double Advance(const std::array<double, VerticalInput::kGroups>& load_n, double step_s);

 private:
  struct Group {
    double reading_n = 0;  ///< Without the noise: follows once the reading is beyond it.
    double end = 0;        ///< 1: it reads h too little.
  };

  double noise_n_;
  bool started_ = false;
  std::array<Group, VerticalInput::kGroups> groups_{};
};

}  // namespace footing::momentum

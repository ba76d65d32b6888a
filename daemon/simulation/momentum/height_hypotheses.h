#pragma once

#include <array>
#include <cstddef>

#include "daemon/simulation/momentum/vertical_com.h"

namespace footing::momentum {

/// Hypotheses of the height, the more special ones first: the first one that is
/// active supplies the output (docs/momentum.md, "Vertical COM").
enum class HeightRow : std::size_t {
  kBetweenRests,  ///< The loads are right from one rest to the next; postures
                  ///< count at rest only.
  kPlay,          ///< The cells have play.
  kFreeWeight,    ///< The weight is never known for good.
  kFreeMass,      ///< The mass of the T-pose may be wrong.
  kAccurate,      ///< Errors of the cells are small.
  kInaccurate,    ///< Errors of the cells are those of real boards.
};
inline constexpr std::size_t kHeightRows = 6;

/// Assumptions of the row. `arms_hang_m` is Subject's, `cell_noise_n` and
/// `mass_kg` are the T-pose's.
VerticalConfig HeightHypothesis(HeightRow row, double arms_hang_m, double cell_noise_n,
                                double mass_kg);

/// Filters of the height, one a hypothesis, with the same states and inputs: an
/// interacting multiple-model estimator with hard decisions. Each filter sums
/// the log densities of what it foresaw (its score); the difference of two
/// scores is the log odds of their hypotheses. Odds decide, with hysteresis,
/// which hypotheses are active, and one that is much less likely than another
/// adopts its state. A plain value.
class HeightHypotheses {
 public:
  HeightHypotheses(double mass_kg, double step_s, double arms_hang_m, double cell_noise_n,
                   const PostureError& posture);

  /// VerticalCom::KeepLag of all.
  void KeepLag(int lag_steps);
  void Start(const VerticalInput& mean);
  void Advance(const VerticalInput& input);
  /// Hands and feet alone have the body that high over the T-pose.
  void SeePosture(double height_m);
  void Coast();
  /// The body comes down onto the cells, at an unknown height and velocity.
  /// After Start.
  void Land();
  /// The cells, which were silent, measure a body again: it most likely stands.
  /// After Start.
  void Reappear();
  /// The body's feet come down, so its legs are nearly straight. False where
  /// the height is certain to be another: the flight did not begin where these
  /// filters were.
  bool CanLand() const;
  /// False while the output contradicts the posture or, from rest to rest, the
  /// loads, or is not sure of the height.
  bool trusted() const;

  /// Row that supplies the output.
  HeightRow output_row() const { return FirstActive(HeightRow::kBetweenRests); }
  const VerticalCom& output() const { return Of(output_row()); }
  /// The T-pose's, or what it was found to be.
  double mass_kg() const;
  /// Mean and variance, with what the posture itself may be wrong by in it.
  VerticalCom::Filter::Scalar Height(int lag_steps) const;

 private:
  VerticalCom& Of(HeightRow row) { return filters_[static_cast<std::size_t>(row)]; }
  const VerticalCom& Of(HeightRow row) const { return filters_[static_cast<std::size_t>(row)]; }
  bool& Active(HeightRow row) { return active_[static_cast<std::size_t>(row)]; }
  bool Active(HeightRow row) const { return active_[static_cast<std::size_t>(row)]; }
  /// The first active row from this one on: what would supply the output
  /// without the rows before.
  HeightRow FirstActive(HeightRow from) const;
  /// Whether the row is active, by its log odds against the rows after it.
  void Decide(HeightRow row, double log_odds);
  bool SeesPosture() const;
  /// Those who lost their way, or foresaw much less than another one, adopt its
  /// state. `compare`: scores are compared in this frame.
  void Recover(bool compare);
  /// Whether cells have play.
  void WatchPlay(bool compare);
  /// Whether the mass of the T-pose is wrong, and what it is.
  void WatchMass();
  void WatchAccuracy();
  /// Whether the loads led back from rest to rest, after a posture was seen.
  void WatchRests();
  void ForgetRests();
  /// The loads alone, from the last rest on, have the body elsewhere than the
  /// output, and nothing shows which of them is wrong.
  bool LoadsContradict() const;

  std::array<VerticalCom, kHeightRows> filters_;
  std::array<bool, kHeightRows> active_;
  CellPlay play_;
  double rests_evidence_ = 0;  ///< That the loads are right from rest to rest.
  bool held_t_pose_ = false;   ///< While kFreeMass is active: the body kept its T-pose meanwhile.
  double adopted_s_ = 0;       ///< Since kAccurate adopted the state of kInaccurate.
  double step_s_;
  PostureError posture_;
  double since_posture_s_ = 0;
  double since_compared_s_ = 0;
};

}  // namespace footing::momentum

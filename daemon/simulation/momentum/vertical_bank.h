#pragma once

#include <array>

#include "daemon/simulation/momentum/cell_play.h"
#include "daemon/simulation/momentum/vertical_com.h"

namespace footing::momentum {

/// For cells whose only error is white noise: the loads are trusted for many seconds.
VerticalConfig TrustingVertical(double arms_hang_m, double cell_noise_n);
/// For cells with gains and slow errors as real boards have them.
VerticalConfig DoubtfulVertical(double arms_hang_m, double cell_noise_n);

/// For a body whose weight is not known from the T-pose: it is what nobody can fall or rise from
/// for long.
VerticalConfig UnweighedVertical(double arms_hang_m, double cell_noise_n, double mass_kg);

/// For a body whose weight is never known for good, and for cells that are wrong by as much as the
/// worst boards are.
VerticalConfig WaryVertical(double arms_hang_m, double cell_noise_n, double mass_kg);

/// For cells that follow their loads with play, of a width that is not known.
VerticalConfig LooseVertical(double arms_hang_m, double cell_noise_n);

/// For one that integrates the loads from rest to rest.
VerticalConfig ReturningVertical(double arms_hang_m, double cell_noise_n, double mass_kg);

/// Filters of the height side by side, one that trusts the cells and one that doubts them. The
/// one that foresaw the last minute's events better speaks; a trusting filter that lost its way is
/// set right by the doubtful one. A third one takes nothing for granted of the weight: when it is
/// sure that the T-pose's is wrong, it speaks until the weight is settled, then gives it to the
/// others. A fourth one knows nothing for good: where the others stray or foresee much less than it
/// does, it speaks, and they adopt its state. A fifth one takes the cells to have play: where it
/// foresees more than all others, it speaks, and those that foresee much less adopt its state. A
/// sixth one uses no posture from one rest to the next: it speaks once its ways have led back to
/// what postures show at rest, until one does not. A plain value.
class VerticalBank {
 public:
  VerticalBank(double mass_kg, double step_s, double arms_hang_m, double cell_noise_n,
               const PostureError& posture);

  /// VerticalCom::KeepLag of all.
  void KeepLag(int lag_steps);
  void Start(const VerticalInput& mean);
  void Advance(const VerticalInput& input);
  /// Hands and feet alone have the body that high over the T-pose.
  void SeePosture(double height_m);
  void Coast();
  /// The body comes down onto the cells, at an unknown height and velocity. After Start.
  void Land();
  /// The cells, which were silent, measure a body again: it most likely stands. After Start.
  void Reappear();
  /// The body's feet come down, so its legs are nearly straight. False where the height is certain
  /// to be another: the flight did not begin where these filters were.
  bool CanLand() const;
  /// False while what speaks contradicts the posture, or is not sure of the height.
  bool trusted() const;

  const VerticalCom& chosen() const { return returning_speaks_ ? returning_ : Others(); }
  bool trusts() const { return trusts_; }
  /// The T-pose's, or what it was found to be.
  double mass_kg() const {
    return returning_speaks_ ? returning_.mass_kg()
           : loose_speaks_   ? loose_.mass_kg()
           : wary_speaks_    ? wary_.weighed_kg()
           : weighing_       ? unweighed_.weighed_kg()
                             : chosen().mass_kg();
  }
  /// Mean and variance, with what the anchor itself may be wrong by in it.
  VerticalCom::Filter::Scalar Height(int lag_steps) const;

 private:
  std::array<VerticalCom*, 6> All() {
    return {&trusting_, &doubtful_, &unweighed_, &wary_, &loose_, &returning_};
  }
  void Weigh();
  /// The wary filter restarts where it has strayed; others that have, or that foresaw much less
  /// than it did, adopt its state.
  void Recover();
  /// What would speak if cells had no play.
  const VerticalCom& Tight() const {
    if (wary_speaks_) return wary_;
    if (weighing_) return unweighed_;
    return trusts_ ? trusting_ : doubtful_;
  }
  /// Whether cells have play, by how well the loose filter foresees; `look`: states are adopted.
  void WatchPlay(bool seen, bool look);
  /// Whether the loads led back from rest to rest, after a posture was seen.
  void WatchReturns();
  void ForgetReturns();
  /// The loads alone, from the last rest on, have the body elsewhere than the output, and nothing
  /// shows which of them is wrong.
  bool LoadsContradict() const;
  /// What would speak if no way from rest to rest were known.
  const VerticalCom& Others() const { return loose_speaks_ ? loose_ : Tight(); }
  bool SeesPosture() const;

  VerticalCom trusting_;
  VerticalCom doubtful_;
  VerticalCom unweighed_;
  VerticalCom wary_;
  VerticalCom loose_;
  VerticalCom returning_;
  CellPlay play_;
  double returns_ = 0;  ///< Evidence of its ways from rest to rest.
  bool returning_speaks_ = false;
  bool loose_speaks_ = false;
  bool wary_speaks_ = false;
  bool trusts_ = false;
  double adopted_s_ = 0;
  bool weighing_ = false;  ///< The T-pose's weight is known to be wrong, the true one not yet.
  bool weighed_in_t_pose_ = false;  ///< While weighing: the body kept its T-pose meanwhile.
  double step_s_;
  PostureError posture_;
  double since_posture_s_ = 0;
  double since_look_s_ = 0;
};

}  // namespace footing::momentum

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "daemon/simulation/momentum/foot_contact.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::reconstruction {

/// Cells in a shoe. Foot frame F: x to the toes, y left, origin where the COP rests
/// (momentum::FootShape).
struct InsoleFoot {
  bool valid = false;
  std::size_t count = 0;
  std::array<Eigen::Vector2d, momentum::kMaxCells> p_F_m{};
  std::array<double, momentum::kMaxCells> load_n{};
};

struct InsoleInputs {
  double time_s = 0;
  std::array<InsoleFoot, momentum::kFeet> feet;
  std::array<HandInput, kHands> hands;  ///< W.
};

/// The reconstruction of somebody who walks away in shoes with cells (the paper's section 8). Cells
/// do not tell where they are: a foot that carries stays where it landed, and it lands half a step
/// ahead of the body, which the hands tell, at the side where the reconstructed pose has it. The
/// load's place in the sole says when heel or toes may be up. Everything happens in a frame that
/// follows the feet smoothly, so that what was learned of people in place holds; to the laws of
/// motion it is as good as W. The person looks along W's x axis. Best mode, without its momentum. A
/// value that can be copied.
class InsoleWalk {
 public:
  static Result<InsoleWalk> Create(const body::Body& body, const Models& models,
                                   const Options& options);

  /// One frame, 1 / rate_hz after the one before. Begins in a T-pose. Output is in W.
  const Output& Advance(const InsoleInputs& inputs);

  const Output& output() const { return output_; }
  /// Point F of a foot, and whether it carries; W.
  const Eigen::Vector2d& place_m(std::size_t foot) const { return feet_[foot].place_m; }
  bool contact(std::size_t foot) const { return feet_[foot].contact.contact(); }

 private:
  struct Foot {
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
    momentum::FootContact contact;
  };

  InsoleWalk(Reconstruction reconstruction, const Options& options);
  void StandUnder(const std::array<HandInput, kHands>& hands);
  Eigen::Vector2d PlaceInPose(std::size_t f) const;
  Eigen::Vector2d LandingPlace(std::size_t f) const;
  Inputs InMovingFrame(const InsoleInputs& inputs) const;
  Known::Foot Carrying(std::size_t f, const InsoleFoot& cells) const;
  Known::Foot Swinging(std::size_t f) const;
  void Tell();
  void MoveFrame(const std::array<HandInput, kHands>& hands);

  Reconstruction reconstruction_;
  double step_s_;
  std::array<FootGeometry, momentum::kFeet> geometry_;
  std::array<Foot, momentum::kFeet> feet_;
  bool placed_ = false;
  Eigen::Vector2d frame_m_ = Eigen::Vector2d::Zero();  ///< Origin of the moving frame, W.
  Eigen::Vector2d frame_mps_ = Eigen::Vector2d::Zero();
  Output output_;
};

}  // namespace footing::reconstruction

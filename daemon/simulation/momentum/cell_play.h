#pragma once

#include <array>

#include <Eigen/Core>

namespace footing::momentum {

/// One frame: the load of each group of cells, and where the COP is.
struct VerticalInput {
  static constexpr int kGroups = 8;
  std::array<double, kGroups> load_n{};
  double play = 0;  ///< CellPlay::Advance; 0 where it does not count.
  bool cop_valid = false;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();

  double total_n() const;
};

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

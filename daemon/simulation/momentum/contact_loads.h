#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

/// From the vertical loads under two feet to the motion of the centre of mass, the angular momentum
/// and the places of the feet (Ha, Bai & Liu 2011, sections 4 and 6; docs/momentum.md).
namespace footing::momentum {

inline constexpr std::size_t kFeet = 2;  ///< 0 is the left one.
inline constexpr std::size_t kMaxCells = 16;

/// One load cell, in W (x forward, y left, z up; m).
struct Cell {
  Eigen::Vector3d p_WS_m = Eigen::Vector3d::Zero();
  double load_n = 0;  ///< Vertical force of the foot on the cell, downwards positive.
};

/// Cells under one foot: four of a board, more of an insole. `valid` is false when the source says
/// nothing at this time (a lost link), which is not the same as no load.
struct FootLoads {
  bool valid = false;
  std::size_t count = 0;
  std::array<Cell, kMaxCells> cells{};
};

/// All cells at one time. An insole's cells move with the foot; a board's stay.
struct ContactLoads {
  double time_s = 0;
  std::array<FootLoads, kFeet> feet{};
};

/// Centre of pressure and total of a set of cells.
struct Pressure {
  double total_n = 0;
  bool cop_valid = false;  ///< The total is over the limit that was asked for.
  Eigen::Vector3d p_WP_m = Eigen::Vector3d::Zero();
};

/// Pressure of one foot; its centre counts from `least_n` (> 0) on. An invalid source and cells
/// that are not finite give 0 and no centre.
Pressure PressureOf(const FootLoads& foot, double least_n);
/// Pressure of both feet together.
Pressure PressureOf(const ContactLoads& loads, double least_n);

/// Whether the COP has reached the edge of a board, by its cells in the order of board::Corners:
/// nearly all load is on the two cells of one side. It cannot be further out: a foot that is
/// presses the edge all the same. Never where there is little load or cells pull, which are those
/// of a simulated plate without an edge.
bool AtEdge(const FootLoads& foot);

/// True when every load and position is finite and no count is over kMaxCells.
bool IsFinite(const ContactLoads& loads);

struct FootContactConfig {
  double on_n = 20;   ///< Over what the cells read when nobody stands on them.
  double off_n = 12;  ///< Below: the foot is off.
  double tare_time_s = 2;
  double most_tare_n = 10;  ///< An offset above this is a weight, not a drift.
};

/// Whether a foot is on its cells: hysteresis about the cells' own zero, which is tracked while
/// the foot is off. A plain value.
class FootContact {
 public:
  explicit FootContact(const FootContactConfig& config = {}) : config_(config) {}

  /// Total load of the foot's cells. Returns the state after it.
  bool Advance(double total_n, double step_s);

  bool contact() const { return contact_; }
  double since_s() const { return since_s_; }  ///< Time in this state.
  double tare_n() const { return tare_n_; }

 private:
  FootContactConfig config_;
  bool contact_ = false;
  double since_s_ = 0;
  double tare_n_ = 0;
};

/// Whether a foot has stepped ahead or back, as in a lunge: it stands far from where it stood in
/// the mean of the last seconds. Who moves in place does not do that, and the filters of the
/// horizontal COM know no other bodies. A plain value.
class StepWatch {
 public:
  /// Places of the feet along W's x axis.
  void Start(const std::array<double, kFeet>& forward_m);
  void Advance(const std::array<double, kFeet>& forward_m, double step_s);
  bool stepped() const { return stepped_; }

 private:
  std::array<double, kFeet> mean_m_{};
  bool stepped_ = false;
};

/// How much of a body's weight its cells carry, in the mean of seconds. A body that neither falls
/// nor rises without end has all of it there, in leaps and hops too; less stands on something else,
/// such as the floor beside a board. A plain value.
class LoadShare {
 public:
  /// `share`: load over the T-pose's weight.
  void Advance(double share, double step_s);
  double share() const { return share_; }
  /// False from well outside of what bodies have until well inside of it again.
  bool whole() const { return whole_; }

 private:
  double early_ = 1, share_ = 1;  ///< Smoothed once, and twice.
  bool whole_ = true;
};

/// The paper's discrete Kalman filter of one load (section 4.1): a random walk seen through white
/// noise. A plain value.
class LoadFilter {
 public:
  struct Config {
    double walk_n = 60;   ///< Standard deviation of the change from frame to frame.
    double noise_n = 15;  ///< Standard deviation of the measurement.
  };

  LoadFilter() = default;
  explicit LoadFilter(const Config& config) : config_(config) {}

  double Advance(double load_n) {
    if (!started_) {
      started_ = true;
      estimate_n_ = load_n;
      variance_n2_ = config_.noise_n * config_.noise_n;
      return estimate_n_;
    }
    variance_n2_ += config_.walk_n * config_.walk_n;
    const double gain = variance_n2_ / (variance_n2_ + config_.noise_n * config_.noise_n);
    estimate_n_ += gain * (load_n - estimate_n_);
    variance_n2_ *= 1 - gain;
    return estimate_n_;
  }

  double variance_n2() const { return variance_n2_; }

 private:
  Config config_;
  bool started_ = false;
  double estimate_n_ = 0;
  double variance_n2_ = 0;
};

}  // namespace footing::momentum

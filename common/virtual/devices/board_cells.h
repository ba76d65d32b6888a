#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/board/geometry.h"
#include "common/body/body.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/motion.h"

/// Sensors under a moving body: forces and centres of pressure by inverse dynamics, and the cells
/// of two boards with their limits and errors.
namespace footing::virtual_sensors {

inline constexpr int kFeet = 2;  ///< 0 is the left one.
inline constexpr int kFootPoints = 4;

/// A body in motion, as far as the ground feels it; a column a frame. In W, z = 0 is the ground.
struct BodyCourse {
  double rate_hz = 0;
  double mass_kg = 0;
  Eigen::Matrix3Xd com_m;
  Eigen::Matrix3Xd angular_momentum;  ///< About the COM, kg m²/s.
  /// Corners of each sole: heel inside and outside, ball inside and outside. Heights are above
  /// those of a flat standing foot, so 0 where the corner carries.
  std::array<std::array<Eigen::Matrix3Xd, kFootPoints>, kFeet> sole_m;

  Eigen::Index frames() const { return com_m.cols(); }
};

/// Kinematics of every frame. Angles and position of the root are low-passed first (measured
/// positions are not fit to be differentiated twice). The motion's skeleton is the body's.
BodyCourse Follow(const body::Body& body, const motion::Motion& motion, double cutoff_hz = 6);

/// The force of the ground on the body, a column a frame.
struct GroundReaction {
  Eigen::Matrix3Xd force_n;
  /// Where a vertical force and a shear on the ground make the body's moment. Valid where
  /// `supported`.
  Eigen::Matrix2Xd cop_m;
  /// False in flight: the vertical force is under 6 % of the weight.
  std::vector<bool> supported;
};

/// F = m (c'' + g), and the COP from L' = (p - c) x F (equation (1) of Ha, Bai & Liu 2011). In
/// flight the force of recorded motion is a little above or below zero; it is left so, since a
/// clipped one would give the body momentum that it never had.
GroundReaction React(const BodyCourse& course, double cutoff_hz = 10);

/// Vertical force and COP under one foot at one time.
struct FootForce {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();  ///< The sole's middle where there is no load.
};

/// Shares the reaction of one frame between the corners of both soles: forces that push only, that
/// make the total and the COP as well as soles of this size can, and that are as even as the
/// corners' heights allow (a corner 2.5 cm above the ground is e times more reluctant).
std::array<FootForce, kFeet> ShareBetweenFeet(const BodyCourse& course,
                                              const GroundReaction& reaction, Eigen::Index frame);

/// React of a motion from markers, with as little smoothing as each moment needs: 6 Hz on angles
/// and 8 Hz on accelerations where forces change slowly, up to 10 and 12 Hz where both differ by
/// more than 5 % of the weight for a tenth of a second (a landing). `smooth` is Follow(body,
/// motion) at 6 Hz. For comparison with plates.
GroundReaction ReactToImpacts(const body::Body& body, const motion::Motion& motion,
                              const BodyCourse& smooth);

/// A pressure insole: two columns of eight cells. Foot frame F: x from heel to ball, y left, origin
/// under the heel's middle.
inline constexpr std::size_t kInsoleCells = 16;

/// Where a sole is on the ground.
struct SolePlace {
  Eigen::Vector2d heel_m = Eigen::Vector2d::Zero();  ///< Middle of its heel, W.
  double yaw_rad = 0;                                ///< Direction from heel to ball, about z.
  double length_m = 0;                               ///< From heel to ball.
};
SolePlace PlaceOfSole(const BodyCourse& course, std::size_t foot, Eigen::Index frame);

/// The cells' places in F for a sole of this length; they never move in the shoe.
std::array<Eigen::Vector2d, kInsoleCells> InsolePlaces(double length_m);

/// Loads of the cells under a foot, N: none pulls, they have the foot's load and its COP (moved to
/// where cells can have it, 5 mm inside of their outline), and are as even as these allow (greatest
/// entropy: each cell's share is an exponential of its place).
std::array<double, kInsoleCells> LoadInsole(
    const std::array<Eigen::Vector2d, kInsoleCells>& places_m, const SolePlace& sole,
    const FootForce& foot);

/// Central differences of signals (a row each) at equal steps, one-sided at the ends; needs two
/// columns.
Eigen::MatrixXd Derivative(const Eigen::MatrixXd& values, double rate_hz);

/// Where a board lies: its middle in W, and how far its front (away from the power button) is
/// turned to the left from W's x axis.
struct BoardPlace {
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
};

/// Two boards, one under each foot, with their long sides ahead, edge to edge.
std::array<BoardPlace, kFeet> SideBySide();

/// The layout one_foot_each: their long sides ahead, `gap_m` between them, the origin in the
/// middle of the gap, their front edges facing each other.
std::array<BoardPlace, kFeet> OneFootEach(double gap_m);

/// N on the four corners.
using Corners = board::Corners;

/// Place of each corner's sensor in W.
std::array<Eigen::Vector2d, board::kCorners> SensorPlaces(const BoardPlace& board);

/// The corners under a foot. A cell only pushes, so a COP outside the sensors' rectangle is one
/// the board cannot have without tipping: it is moved to the nearest edge.
struct BoardLoad {
  Corners corners_n{};
  bool outside = false;  ///< The COP was outside the rectangle.
};
/// Not `limited`: cells that pull, too, as if the plate had no edge.
BoardLoad LoadBoard(const BoardPlace& board, const FootForce& foot, bool limited = true);

/// Whether the COP is beyond the board's plate: the foot stands on the floor beside it.
bool IsBeside(const BoardPlace& board, const FootForce& foot);

/// Errors of a board's cells (Bartlett, Ting & Bingham 2014: absolute within 9.1 N, repeatable
/// within 4.5 N).
struct CellErrorConfig {
  double gain_spread = 0;   ///< Standard deviation of each cell's gain.
  double hysteresis_n = 0;  ///< Half the width of each cell's play.
  double slow_force_n = 0;  ///< Standard deviation of the slow error of a loaded board.
  double slow_time_s = 3;   ///< Its correlation time.
  double noise_kg = 0;      ///< White, of each cell and sample.
  std::uint64_t seed = 1;
};

/// One board's cells with errors. A plain value; times go forward.
class CellErrors {
 public:
  explicit CellErrors(const CellErrorConfig& config);

  /// Reading of the cells under these forces, `step_s` after the sample before.
  Corners Advance(const Corners& true_n, double step_s);

  const std::array<double, 4>& gains() const { return gains_; }

 private:
  CellErrorConfig config_;
  noise::Random random_;
  std::array<double, 4> gains_{};
  bool started_ = false;
  Corners play_n_{};
  double slow_n_ = 0;
};

}  // namespace footing::virtual_sensors

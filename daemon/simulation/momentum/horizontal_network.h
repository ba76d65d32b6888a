#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/momentum/calibration.h"
#include "daemon/simulation/momentum/contact_loads.h"

/// The paper's prediction of the horizontal centre of mass (section 4.2), in closed loop.
///
/// | paper               | here           | unit, frame                                      |
/// |---------------------|----------------|--------------------------------------------------|
/// | F(t-1), F(t)        | NetworkLoads   | parts of the weight, eight cells                 |
/// | c(t-2), c(t-1), c(t)| com_m          | m, W, from the point between the feet's rest COPs|
/// | x, z                | axis 0, 1      | W's x (forward), y (left)                        |
namespace footing::momentum {

inline constexpr double kNetworkRateHz = 60;
inline constexpr std::size_t kNetworkCells = 8;
/// F(t-1), F(t), c(t-2), c(t-1), c(t) of the axis, c(t) of the other.
inline constexpr std::size_t kNetworkInputs = 2 * kNetworkCells + 4;

/// Loads of the left foot's, then the right foot's cells: front left, front right, rear left, rear
/// right.
using NetworkLoads = std::array<double, kNetworkCells>;

/// The cells' places in W from the origin of NetworkLoads: two boards, long sides ahead, edge to
/// edge. m.
std::array<Eigen::Vector2d, kNetworkCells> NetworkCells();

/// The loads that eight cells at NetworkCells() about `origin_m` would read: of each foot the same
/// sum and moment as its own cells have, linear in them. Departure from the paper, which gives the
/// network its boards' own cells: so a network serves any layout, stance and number of cells.
NetworkLoads ToNetworkLoads(const ContactLoads& loads, const Eigen::Vector2d& origin_m,
                            double weight_n);

/// X of the axis's network.
std::array<double, kNetworkInputs> NetworkInputs(const NetworkLoads& before,
                                                 const NetworkLoads& now,
                                                 const std::array<Eigen::Vector2d, 3>& com_m,
                                                 int axis);

/// The loop at the training rate: each output is the next input. Nothing it says is further than
/// kBorderM from the origin, whatever the networks do. A plain value; the networks must outlive it.
class HorizontalLoop {
 public:
  static constexpr double kBorderM = 1;
  using Networks = std::array<cascade::CascadeNetwork, 2>;

  /// Begins at rest at `com_m`, or with c(t-2), c(t-1), c(t). Networks have kNetworkInputs inputs
  /// and one output.
  HorizontalLoop(const Networks& networks, const NetworkLoads& loads, const Eigen::Vector2d& com_m);
  HorizontalLoop(const Networks& networks, const NetworkLoads& loads,
                 const std::array<Eigen::Vector2d, 3>& com_m);

  /// `loads` are those of t; c(t+1) comes back, and is c(t) then. Loads that are not finite leave
  /// the ones before.
  const Eigen::Vector2d& Step(const NetworkLoads& loads);

  /// c(t-2), c(t-1), c(t).
  const std::array<Eigen::Vector2d, 3>& com_m() const { return com_m_; }

 private:
  const Networks* networks_;
  NetworkLoads before_;
  std::array<Eigen::Vector2d, 3> com_m_;
};

/// The loop behind the cells of a person, at any rate of frames. Begins at the T-pose, where C is
/// over the COP. A plain value; the networks must outlive it.
class HorizontalNetwork {
 public:
  HorizontalNetwork(const HorizontalLoop::Networks& networks, const TPose& pose, double step_s);

  /// The frame's C, horizontal, in W: on the line between the two predictions beside it. Loads
  /// since the last step are averaged; a source that says nothing holds the estimate.
  const Eigen::Vector2d& Advance(const ContactLoads& loads);

 private:
  Eigen::Vector2d origin_m_;
  double weight_n_;
  double steps_a_frame_;
  HorizontalLoop loop_;
  NetworkLoads sum_{};
  double frames_ = 0;  ///< In the sum.
  double phase_ = 0;   ///< From one step to the next, 0 to 1.
  Eigen::Vector2d p_WC_m_;
};

/// Where C is counted from: half way between the feet's centres of pressure at rest.
Eigen::Vector2d NetworkOrigin(const TPose& pose);

}  // namespace footing::momentum

#include "daemon/simulation/momentum/horizontal_network.h"

#include <algorithm>
#include <cmath>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/board/geometry.h"

namespace footing::momentum {
namespace {

// Half the distances between a board's sensors, and from the middle of two boards that touch to
// that of one: the places that the network is trained with, whatever boards are in use.
constexpr double kHalfLengthM = board::kBalanceBoard.sensor_distance_x_m / 2;
constexpr double kHalfWidthM = board::kBalanceBoard.sensor_distance_y_m / 2;
constexpr double kBoardM = board::kBalanceBoard.plate_y_m / 2;

constexpr std::array<double, 4> kFront{1, 1, -1, -1};
constexpr std::array<double, 4> kLeft{1, -1, 1, -1};

constexpr double BoardLeftM(std::size_t foot) { return foot == 0 ? kBoardM : -kBoardM; }

bool IsFinite(const NetworkLoads& loads) {
  return std::all_of(loads.begin(), loads.end(), [](double load) { return std::isfinite(load); });
}

NetworkLoads LoadsOf(const TPose& pose) {
  ContactLoads loads;
  for (std::size_t f = 0; f < kFeet; ++f) {
    loads.feet[f].valid = true;
    loads.feet[f].count = 1;
    loads.feet[f].cells[0] = {pose.p_WP_m[f], pose.load_n[f]};
  }
  return ToNetworkLoads(loads, NetworkOrigin(pose), KilogramsToNewtons(pose.mass_kg));
}

}  // namespace

std::array<Eigen::Vector2d, kNetworkCells> NetworkCells() {
  std::array<Eigen::Vector2d, kNetworkCells> cells;
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i] = {kHalfLengthM * kFront[i % 4], BoardLeftM(i / 4) + kHalfWidthM * kLeft[i % 4]};
  return cells;
}

NetworkLoads ToNetworkLoads(const ContactLoads& loads, const Eigen::Vector2d& origin_m,
                            double weight_n) {
  NetworkLoads out{};
  for (std::size_t f = 0; f < kFeet; ++f) {
    const FootLoads& foot = loads.feet[f];
    if (!foot.valid) continue;
    double total = 0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < std::min(foot.count, kMaxCells); ++i) {
      const Cell& cell = foot.cells[i];
      const Eigen::Vector2d place = cell.p_WS_m.head<2>() - origin_m;
      total += cell.load_n;
      moment += cell.load_n * Eigen::Vector2d(place.x(), place.y() - BoardLeftM(f));
    }
    for (std::size_t i = 0; i < 4; ++i)
      out[4 * f + i] =
          (total + kFront[i] * moment.x() / kHalfLengthM + kLeft[i] * moment.y() / kHalfWidthM) /
          (4 * weight_n);
  }
  return out;
}

std::array<double, kNetworkInputs> NetworkInputs(const NetworkLoads& before,
                                                 const NetworkLoads& now,
                                                 const std::array<Eigen::Vector2d, 3>& com_m,
                                                 int axis) {
  std::array<double, kNetworkInputs> inputs;
  auto end = std::copy(before.begin(), before.end(), inputs.begin());
  end = std::copy(now.begin(), now.end(), end);
  for (const Eigen::Vector2d& c_m : com_m) *end++ = c_m(axis);
  *end = com_m[2](1 - axis);
  return inputs;
}

HorizontalLoop::HorizontalLoop(const Networks& networks, const NetworkLoads& loads,
                               const Eigen::Vector2d& com_m)
    : HorizontalLoop(networks, loads, {com_m, com_m, com_m}) {}

HorizontalLoop::HorizontalLoop(const Networks& networks, const NetworkLoads& loads,
                               const std::array<Eigen::Vector2d, 3>& com_m)
    : networks_(&networks), before_(loads), com_m_(com_m) {
  for (const cascade::CascadeNetwork& network : networks) {
    FOOTING_CHECK(network.weights().inputs == kNetworkInputs && network.weights().outputs == 1);
  }
}

const Eigen::Vector2d& HorizontalLoop::Step(const NetworkLoads& loads) {
  const NetworkLoads& now = IsFinite(loads) ? loads : before_;
  Eigen::Vector2d next_m;
  for (int axis = 0; axis < 2; ++axis) {
    const auto inputs = NetworkInputs(before_, now, com_m_, axis);
    std::array<float, kNetworkInputs> floats;
    std::transform(inputs.begin(), inputs.end(), floats.begin(),
                   [](double value) { return static_cast<float>(value); });
    std::array<float, 1> output;
    // Not finite: the network says its mean, which is.
    (*networks_)[static_cast<std::size_t>(axis)].Evaluate(floats, output);
    next_m(axis) = std::clamp(static_cast<double>(output[0]), -kBorderM, kBorderM);
  }
  before_ = now;
  com_m_ = {com_m_[1], com_m_[2], next_m};
  return com_m_[2];
}

Eigen::Vector2d NetworkOrigin(const TPose& pose) {
  return 0.5 * (pose.p_WP_m[0] + pose.p_WP_m[1]).head<2>();
}

HorizontalNetwork::HorizontalNetwork(const HorizontalLoop::Networks& networks, const TPose& pose,
                                     double step_s)
    : origin_m_(NetworkOrigin(pose)),
      weight_n_(KilogramsToNewtons(pose.mass_kg)),
      steps_a_frame_(step_s * kNetworkRateHz),
      loop_(networks, LoadsOf(pose), pose.cop_m.head<2>() - origin_m_),
      p_WC_m_(pose.cop_m.head<2>()) {}

const Eigen::Vector2d& HorizontalNetwork::Advance(const ContactLoads& loads) {
  if (!loads.feet[0].valid || !loads.feet[1].valid) return p_WC_m_;
  const NetworkLoads now = ToNetworkLoads(loads, origin_m_, weight_n_);
  if (!IsFinite(now)) return p_WC_m_;
  for (std::size_t i = 0; i < now.size(); ++i) sum_[i] += now[i];
  frames_ += 1;
  phase_ += steps_a_frame_;
  // Half a thousandth for rates that are not quite a multiple. At a low rate several steps a frame
  // see the same loads.
  if (phase_ >= 1 - 5e-4) {
    NetworkLoads mean = sum_;
    for (double& load : mean) load /= frames_;
    while (phase_ >= 1 - 5e-4) {
      loop_.Step(mean);
      phase_ = std::max(phase_ - 1, 0.0);
    }
    sum_ = {};
    frames_ = 0;
  }
  // The last step foretold a frame's C from the loads of the one before: c(t+1) stands at t+1.
  const auto& com_m = loop_.com_m();
  p_WC_m_ = origin_m_ + com_m[1] + phase_ * (com_m[2] - com_m[1]);
  return p_WC_m_;
}

}  // namespace footing::momentum

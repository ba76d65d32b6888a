#include "daemon/offline/learning/horizontal_com.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/learning/time_alignment.h"
#include "daemon/simulation/momentum/estimate.h"

namespace footing::learning {
namespace {

/// Sum of sines of random phase at frequencies from `low_hz` to `high_hz`, amplitude falling with
/// the square root of frequency, with its second derivative.
class Wander {
 public:
  Wander(double sd, double low_hz, double high_hz, noise::Random& random) {
    constexpr int kSines = 12;
    double power = 0;
    for (int i = 0; i < kSines; ++i) {
      const double f_hz = low_hz * std::pow(high_hz / low_hz, (i + random.Uniform()) / kSines);
      sines_.push_back({1 / std::sqrt(f_hz), 2 * std::numbers::pi * f_hz,
                        random.Uniform(0, 2 * std::numbers::pi)});
      power += sines_.back().amplitude * sines_.back().amplitude / 2;
    }
    for (Sine& sine : sines_) sine.amplitude *= sd / std::sqrt(power);
  }

  double Value(double t_s) const {
    double sum = 0;
    for (const Sine& s : sines_) sum += s.amplitude * std::sin(s.radps * t_s + s.phase_rad);
    return sum;
  }
  double Acceleration(double t_s) const {
    double sum = 0;
    for (const Sine& s : sines_) {
      sum -= s.amplitude * s.radps * s.radps * std::sin(s.radps * t_s + s.phase_rad);
    }
    return sum;
  }

 private:
  struct Sine {
    double amplitude, radps, phase_rad;
  };
  std::vector<Sine> sines_;
};

constexpr double kHeightM = 1.0;
constexpr double kBoardOffsetM = 0.16;  // Distance of each board's middle to the side.
constexpr double kHalfLengthM = 0.119;  // From a cell to the board's middle, forward.
constexpr double kHalfWidthM = 0.1075;

using momentum::kNetworkInputs;

/// The loads of a board's cells under a load whose COP is at `cop_P_m` from the board's middle.
void ShareOut(double load, const Eigen::Vector2d& cop_P_m, double* cells) {
  const double forward = cop_P_m.x() / kHalfLengthM, left = cop_P_m.y() / kHalfWidthM;
  for (const int f : {1, -1}) {
    for (const int l : {1, -1}) *cells++ = load / 4 * (1 + f * forward) * (1 + l * left);
  }
}

/// A row for every t of every clip that has c(t-2) and c(t+1). `com_m` says c(t-2), c(t-1), c(t).
template <typename Past>
Examples MakeExamples(std::span<const LoadClip> clips, int axis, const Past& com_m) {
  std::size_t rows = 0;
  for (const LoadClip& clip : clips) rows += clip.size() > 3 ? clip.size() - 3 : 0;
  Examples examples{.inputs = Eigen::MatrixXd(rows, kNetworkInputs),
                    .targets = Eigen::MatrixXd(rows, 1)};
  Eigen::Index row = 0;
  for (const LoadClip& clip : clips) {
    for (std::size_t t = 2; t + 1 < clip.size(); ++t, ++row) {
      const auto inputs =
          momentum::NetworkInputs(clip[t - 1].load, clip[t].load, com_m(clip, t), axis);
      examples.inputs.row(row) = Eigen::RowVectorXd::Map(inputs.data(), kNetworkInputs);
      examples.targets(row, 0) = clip[t + 1].c_W_m(axis);
    }
  }
  return examples;
}

std::array<Eigen::Vector2d, 3> TruePast(const LoadClip& clip, std::size_t t) {
  return {clip[t - 2].c_W_m, clip[t - 1].c_W_m, clip[t].c_W_m};
}

momentum::HorizontalLoop LoopFrom(const Networks& networks, const LoadClip& clip, std::size_t t) {
  return {networks, clip[t - 1].load, TruePast(clip, t)};
}

}  // namespace

std::optional<Eigen::Vector2d> Cop(const LoadFrame& frame) {
  const auto cells = momentum::NetworkCells();
  double total = 0;
  Eigen::Vector2d moment_m = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < cells.size(); ++k) {
    total += frame.load[k];
    moment_m += frame.load[k] * cells[k];
  }
  if (total < 0.1) return std::nullopt;
  return moment_m / total;
}

std::vector<LoadClip> PartsInPlace(const LoadClip& clip) {
  constexpr double kReachM = 0.4;
  constexpr double kFewest = 3 * momentum::kNetworkRateHz;
  std::vector<LoadClip> parts;
  LoadClip part;
  const auto close = [&] {
    if (static_cast<double>(part.size()) >= kFewest) parts.push_back(part);
    part.clear();
  };
  for (const LoadFrame& frame : clip) {
    if (frame.c_W_m.cwiseAbs().maxCoeff() > kReachM) {
      close();
    } else {
      part.push_back(frame);
    }
  }
  close();
  return parts;
}

std::vector<std::vector<Eigen::Index>> FeedbackColumns() {
  constexpr Eigen::Index kFirst = 2 * momentum::kNetworkCells;
  return {{kFirst, kFirst + 1, kFirst + 2}, {kFirst + 3}};
}

Examples HorizontalExamples(std::span<const LoadClip> clips, int axis) {
  return MakeExamples(clips, axis, TruePast);
}

Examples RolledOutExamples(const Networks& networks, std::span<const LoadClip> clips, int axis,
                           double restart_s) {
  const auto restart = static_cast<std::size_t>(std::lround(restart_s * momentum::kNetworkRateHz));
  std::optional<momentum::HorizontalLoop> loop;
  return MakeExamples(clips, axis, [&](const LoadClip& clip, std::size_t t) {
    if ((t - 2) % restart == 0) loop = LoopFrom(networks, clip, t);
    const std::array<Eigen::Vector2d, 3> past = loop->com_m();
    loop->Step(clip[t].load);
    return past;
  });
}

Eigen::Vector2d ClosedLoopError(const Networks& networks, const LoadClip& clip) {
  if (clip.size() < 4) return Eigen::Vector2d::Zero();
  momentum::HorizontalLoop loop = LoopFrom(networks, clip, 2);
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (std::size_t t = 2; t + 1 < clip.size(); ++t)
    squares += (loop.Step(clip[t].load) - clip[t + 1].c_W_m).cwiseAbs2();
  return (squares / static_cast<double>(clip.size() - 3)).cwiseSqrt();
}

Eigen::Vector2d CopError(const LoadClip& clip) {
  if (clip.empty()) return Eigen::Vector2d::Zero();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();
  for (const LoadFrame& frame : clip) {
    cop_m = Cop(frame).value_or(cop_m);
    squares += (cop_m - frame.c_W_m).cwiseAbs2();
  }
  return (squares / static_cast<double>(clip.size())).cwiseSqrt();
}

LoadClip MakeSway(const SwaySettings& settings, std::uint64_t seed) {
  noise::Random random(seed);
  const Wander forward(0.05, 0.1, 1.0, random), side(0.07, 0.1, 1.0, random);
  const Wander height(0.1, 0.2, 0.8, random);
  const Wander feet_apart(0.02, 0.1, 0.8, random);  // Left COP before right COP.
  const std::array foot_side = {Wander(0.008, 0.1, 0.8, random), Wander(0.008, 0.1, 0.8, random)};

  LoadClip clip(static_cast<std::size_t>(settings.seconds * settings.rate_hz + 0.5));
  for (std::size_t i = 0; i < clip.size(); ++i) {
    const double t_s = static_cast<double>(i) / settings.rate_hz;
    LoadFrame& frame = clip[i];
    frame.c_W_m = {forward.Value(t_s), side.Value(t_s)};
    const double weight = 1 + height.Acceleration(t_s) / kStandardGravityMps2;
    const double lever_s2 = (kHeightM + height.Value(t_s)) / (kStandardGravityMps2 * weight);
    const Eigen::Vector2d cop_m =
        frame.c_W_m - lever_s2 * Eigen::Vector2d(forward.Acceleration(t_s), side.Acceleration(t_s));
    // The left board's share, after what the feet do within their boards.
    const double left_y_m = foot_side[0].Value(t_s), right_y_m = foot_side[1].Value(t_s);
    const double share = std::clamp(
        (cop_m.y() - right_y_m + kBoardOffsetM) / (2 * kBoardOffsetM + left_y_m - right_y_m), 0.05,
        0.95);
    const double apart_m = feet_apart.Value(t_s);
    ShareOut(weight * share, {cop_m.x() + (1 - share) * apart_m, left_y_m}, frame.load.data());
    ShareOut(weight * (1 - share), {cop_m.x() - share * apart_m, right_y_m}, frame.load.data() + 4);
    for (double& load : frame.load) load += settings.noise_sd * random.Normal();
  }
  return clip;
}

namespace {

namespace sensors = virtual_sensors;

/// The point of a sole from its heel's (0) to its ball's (1) middle, a column a frame.
Eigen::Matrix2Xd SolePoint(const std::array<Eigen::Matrix3Xd, sensors::kFootPoints>& sole,
                           double share) {
  return (0.5 * (1 - share) * (sole[0] + sole[1]) + 0.5 * share * (sole[2] + sole[3])).topRows<2>();
}

Eigen::Vector2d Median(const Eigen::Matrix2Xd& points) {
  return {Quantile(points.row(0), 0.5), Quantile(points.row(1), 0.5)};
}

}  // namespace

LoadClip BoardLoads(const motion::Motion& motion, const body::Body& body,
                    const BoardLoadSettings& settings, std::uint64_t seed) {
  if (motion.frames() < 3) return {};
  const sensors::BodyCourse course = sensors::Follow(body, motion);
  const sensors::GroundReaction reaction = sensors::React(course);
  std::array<sensors::BoardPlace, sensors::kFeet> boards = sensors::SideBySide();
  std::vector<sensors::CellErrors> errors;
  Eigen::Matrix2Xd rest = Eigen::Matrix2Xd::Zero(2, course.frames());
  for (std::size_t f = 0; f < sensors::kFeet; ++f) {
    boards[f].middle_m = Median(SolePoint(course.sole_m[f], 0.5));
    rest += SolePoint(course.sole_m[f], momentum::FootShape{}.rest_share) / sensors::kFeet;
    errors.emplace_back(
        sensors::CellErrorConfig{.noise_kg = settings.noise_kg, .seed = 2 * seed + f});
  }
  const Eigen::Vector2d origin_m = Median(rest);
  const double side = settings.mirrored ? -1 : 1;

  LoadClip clip;
  const double weight_n = KilogramsToNewtons(body.mass_kg);
  const double step_s = 1 / momentum::kNetworkRateHz;
  for (double t_s = 0;; t_s += step_s) {
    const auto at = static_cast<Eigen::Index>(std::lround(t_s * motion.rate_hz));
    if (at >= course.frames()) break;
    const auto feet = sensors::ShareBetweenFeet(course, reaction, at);
    momentum::ContactLoads loads;
    for (std::size_t f = 0; f < sensors::kFeet; ++f) {
      const auto read_n = errors[f].Advance(
          sensors::LoadBoard(boards[f], feet[f], settings.limited).corners_n, step_s);
      const auto places = sensors::SensorPlaces(boards[f]);
      momentum::FootLoads& foot = loads.feet[settings.mirrored ? 1 - f : f];
      foot.valid = true;
      foot.count = places.size();
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Eigen::Vector2d place = places[k] - origin_m;
        foot.cells[k] = {{place.x(), side * place.y(), 0}, read_n[k]};
      }
    }
    LoadFrame& frame = clip.emplace_back();
    frame.load = momentum::ToNetworkLoads(loads, Eigen::Vector2d::Zero(), weight_n);
    frame.c_W_m = course.com_m.col(at).head<2>() - origin_m;
    frame.c_W_m.y() *= side;
  }
  return clip;
}

}  // namespace footing::learning

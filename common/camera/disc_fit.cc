#include "common/camera/disc_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "common/camera/disc_fitter.h"
#include "common/camera/disc_hidden.h"

namespace footing::sphere {
namespace {

constexpr int kTries = 60;

/// Solves (s, t, 1) . w = |(s, t, 1)| by its normal equations; w.z() comes less 1, since the rays
/// are nearly parallel. Slopes are scaled to be of the order of 1.
class ConeEquations {
 public:
  explicit ConeEquations(double scale) : scale_(scale) {}
  void Add(const Eigen::Vector2d& slopes) {
    const Eigen::Vector3d row(slopes.x() / scale_, slopes.y() / scale_, 1);
    const double r2 = slopes.squaredNorm();
    const double length_less_1 = r2 / (1 + std::sqrt(1 + r2));
    normal_ += row * row.transpose();
    right_ += row * (length_less_1 / (scale_ * scale_));
  }
  std::optional<Cone> Solve() const {
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal_);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-9))
      return std::nullopt;
    const Eigen::Vector3d w = solver.solve(right_);
    // |w|² - 1 = tan² of the half angle.
    const double third = scale_ * scale_ * w.z();
    const Eigen::Vector2d lateral = scale_ * w.head<2>();
    const double tangent2 = lateral.squaredNorm() + third * (2 + third);
    if (!(tangent2 > 0)) return std::nullopt;
    return Cone{lateral / (1 + third), std::sqrt(tangent2)};
  }

 private:
  double scale_;
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
};

double ScaleOf(const std::vector<Eigen::Vector2d>& slopes) {
  double largest = 1e-6;
  for (const auto& one : slopes) largest = std::max(largest, one.norm());
  return largest;
}

}  // namespace

double Beyond(const Cone& cone, const Eigen::Vector2d& slopes) {
  return (slopes - cone.axis).norm() - cone.tangent;
}

std::optional<Cone> FitCone(const std::vector<Eigen::Vector2d>& slopes,
                            const std::vector<bool>& use) {
  ConeEquations equations(ScaleOf(slopes));
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (use[i]) equations.Add(slopes[i]);
  }
  return equations.Solve();
}

std::optional<ConeFit> FitConeRobustly(const std::vector<Eigen::Vector2d>& slopes, double tolerance,
                                       double narrowest, double widest) {
  const std::size_t count = slopes.size();
  if (count < 5) return std::nullopt;
  const double scale = ScaleOf(slopes);
  std::optional<Cone> best;
  std::size_t most = 0;
  std::uint32_t state = 12345;  // The same three points for the same picture.
  const auto pick = [&state, count] {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::size_t>(state >> 8) % count;
  };
  for (int i = 0; i < kTries; ++i) {
    ConeEquations equations(scale);
    for (int k = 0; k < 3; ++k) equations.Add(slopes[pick()]);
    const auto cone = equations.Solve();
    if (!cone || cone->tangent < narrowest || cone->tangent > widest) continue;
    const auto inside = static_cast<std::size_t>(std::count_if(
        slopes.begin(), slopes.end(),
        [&](const Eigen::Vector2d& one) { return std::abs(Beyond(*cone, one)) < tolerance; }));
    if (inside <= most) continue;
    most = inside;
    best = cone;
    if (10 * inside >= 9 * count) break;
  }
  if (!best || most < 5) return std::nullopt;
  ConeFit fit{*best, std::vector<bool>(count)};
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < count; ++i)
      fit.inliers[i] = std::abs(Beyond(fit.cone, slopes[i])) < tolerance;
    const auto again = FitCone(slopes, fit.inliers);
    if (!again || again->tangent < narrowest || again->tangent > widest) break;
    fit.cone = *again;
  }
  return fit;
}

LocalSlopes::LocalSlopes(const Lens& lens, const Eigen::Vector2d& middle, double half_px)
    : middle_(middle), half_px_(half_px) {
  const Eigen::Vector2d ahead = Undistort(lens, middle);
  R_CL_.col(2) = Eigen::Vector3d(ahead.x(), ahead.y(), 1).normalized();
  R_CL_.col(0) = Eigen::Vector3d::UnitY().cross(R_CL_.col(2)).normalized();
  R_CL_.col(1) = R_CL_.col(2).cross(R_CL_.col(0));
  // Values at x, y in {-1, 0, 1}, then the polynomial through them, first along x, then along y.
  Eigen::Vector2d node[3][3];
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d slopes =
          Undistort(lens, middle + half_px * Eigen::Vector2d(i - 1, j - 1));
      const Eigen::Vector3d ray_L = R_CL_.transpose() * Eigen::Vector3d(slopes.x(), slopes.y(), 1);
      node[j][i] = ray_L.head<2>() / ray_L.z();
    }
  }
  const auto quadratic = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c, Eigen::Vector2d out[3]) {
    out[0] = b;
    out[1] = 0.5 * (c - a);
    out[2] = 0.5 * (a + c) - b;
  };
  Eigen::Vector2d row[3][3], column[3];
  for (int j = 0; j < 3; ++j) quadratic(node[j][0], node[j][1], node[j][2], row[j]);
  for (int i = 0; i < 3; ++i) {
    quadratic(row[0][i], row[1][i], row[2][i], column);
    for (int j = 0; j < 3; ++j) terms_.col(3 * j + i) = column[j];
  }
  scale_.col(0) = terms_.col(1) / half_px;
  scale_.col(1) = terms_.col(3) / half_px;
}

Eigen::Matrix2d LocalSlopes::ScaleChange(int axis) const {
  Eigen::Matrix2d change;
  change.col(axis) = 2 * terms_.col(axis == 0 ? 2 : 6);
  change.col(1 - axis) = terms_.col(4);
  return change / (half_px_ * half_px_);
}

Eigen::Vector2d LocalSlopes::At(double u, double v) const {
  const double x = (u - middle_.x()) / half_px_, y = (v - middle_.y()) / half_px_;
  const auto row = [&](int j) -> Eigen::Vector2d {
    return terms_.col(3 * j) + x * (terms_.col(3 * j + 1) + x * terms_.col(3 * j + 2));
  };
  return row(0) + y * (row(1) + y * row(2));
}

namespace {

/// exp(-x) I0(x), x >= 0: Abramowitz & Stegun 9.8.1 and 9.8.2, errors below 2e-7.
double ScaledBessel(double x) {
  if (x < 3.75) {
    const double t = (x / 3.75) * (x / 3.75);
    const double value =
        1 +
        t * (3.5156229 +
             t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
    return std::exp(-x) * value;
  }
  const double t = 3.75 / x;
  const double value =
      0.39894228 +
      t * (0.01328592 +
           t * (0.00225319 +
                t * (-0.00157565 +
                     t * (0.00916281 +
                          t * (-0.02057706 +
                               t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))));
  return value / std::sqrt(x);
}

struct Discs {
  double disc, limb;
};

/// At distance x from the middle of a unit disc blurred by b: the integral over radius q of
/// L(q) q/b² exp(-(x - q)²/2b²) exp(-z) I0(z), z = x q / b². With q = sin(a) the limb is smooth.
Discs Blurred(double x, double b) {
  const double reach = 6 * b;
  const double low = std::asin(std::clamp(x - reach, 0.0, 1.0));
  const double high = std::asin(std::clamp(x + reach, 0.0, 1.0));
  constexpr int kSteps = 120;  // Even; Simpson's rule.
  const double step = (high - low) / kSteps;
  Discs sum{0, 0};
  if (!(step > 0)) return sum;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = low + i * step, q = std::sin(a), cosine = std::cos(a);
    const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
    const double apart = (x - q) / b;
    const double value = weight * cosine * q / (b * b) * std::exp(-0.5 * apart * apart) *
                         ScaledBessel(x * q / (b * b));
    sum.disc += value;
    sum.limb += value * (1 - cosine);
  }
  return {sum.disc * step / 3, sum.limb * step / 3};
}

}  // namespace

ProfileTable::ProfileTable() {
  cells_.reserve(static_cast<std::size_t>(kBlurs) * kDistances);
  for (int j = 0; j < kBlurs; ++j) {
    const double blur = kLeastBlur + j * kBlurStep;
    for (int i = 0; i < kDistances; ++i) {
      const double x = 1 + blur * (-kReach + i * kDistanceStep);
      // Left of the middle there is nothing to look up; the table goes on as its mirror image.
      const Discs discs = Blurred(std::abs(x), blur);
      cells_.push_back({static_cast<float>(discs.disc), static_cast<float>(discs.limb)});
    }
  }
}

ProfileValue ProfileTable::At(float beyond, float blur) const {
  ProfileValue value;
  if (beyond >= kReach) return value;
  const float b = std::clamp(blur, kLeastBlur, kLeastBlur + (kBlurs - 1.001F) * kBlurStep);
  if (beyond <= -kReach) {
    const float q = std::clamp(1 + b * beyond, 0.0F, 0.999F);
    const float cosine = std::sqrt(1 - q * q);
    // Blur adds half its variance times the Laplacian.
    const float laplacian = 1 / cosine + 1 / (cosine * cosine * cosine);
    value.disc = 1;
    value.limb = 1 - cosine + 0.5F * b * b * laplacian;
    value.limb_d = b * q / cosine;
    value.limb_blur = beyond * q / cosine + b * laplacian;
    return value;
  }
  const float row = (b - kLeastBlur) * (1 / kBlurStep);
  const float column = (beyond + kReach) * (1 / kDistanceStep);
  const int j = static_cast<int>(row), i = std::min(static_cast<int>(column), kDistances - 2);
  const float p = row - static_cast<float>(j), q = column - static_cast<float>(i);
  // Two nodes side by side: disc and limb of the nearer one, disc and limb of the farther one.
  const Cell* node = cells_.data() + static_cast<std::size_t>(j * kDistances + i);
  const Eigen::Map<const Eigen::Array4f> low(&node[0].disc), high(&node[kDistances].disc);
  const Eigen::Array4f apart = high - low, middle = low + p * apart;
  const Eigen::Array2f along = middle.tail<2>() - middle.head<2>();
  const Eigen::Array2f at = middle.head<2>() + q * along;
  const Eigen::Array2f along_blur = apart.head<2>() + q * (apart.tail<2>() - apart.head<2>());
  value.disc = at[0];
  value.limb = at[1];
  value.disc_d = along[0] * (1 / kDistanceStep);
  value.limb_d = along[1] * (1 / kDistanceStep);
  value.disc_blur = along_blur[0] * (1 / kBlurStep);
  value.limb_blur = along_blur[1] * (1 / kBlurStep);
  return value;
}

namespace {

using disc::Fit, disc::Fitter;
using disc::kGoodSds, disc::kPoorSds, disc::kSomePixels;
using disc::Sample, disc::Solution, disc::State;

constexpr int kMostPixels = 700, kMostPixelsMoving = 400;  // A moving one costs twice as much.
constexpr double kFarBlurs = 4;       // Beyond the edge; the background needs no more.
constexpr double kMaybeMoves = 13.3;  // Chi² of four degrees; 1 % of spheres at rest exceed it.
constexpr double kSurelyMoves = 40;
constexpr double kLeastMotionPx = 0.4;
constexpr double kNoMotionSds = 8;  // A misfit of a part of the pixels that motion never has.
constexpr double kFastestSds = 8;   // Deviations of a hand's speed; limits the start of a fit.
// On a smaller sphere an occluder looks like its edge. A misfit that nothing explains is then
// taken for coherent: it can move each of three parameters by the root of a third of its chi².
constexpr double kSmallBlurs = 5;
constexpr int kMostHidden = kSectors / 2;  // With less of the edge, motion cannot be measured.

/// An explanation of the light.
struct Mode {
  Solution solution;
  bool moves = false;
};

class Strategy {
 public:
  Strategy(const Image& image, const LocalSlopes& slopes, const DiscStart& start,
           const Settings& settings, const ProfileTable& table)
      : image_(image),
        slopes_(slopes),
        start_(start),
        settings_(settings),
        scale_(slopes, settings.shutter.row_s / settings.shutter.exposure_s),
        fitter_(settings, table, scale_, start.lit, MotionSdPx()) {
    begin_.shape << start.cone.axis, start.cone.tangent, settings.profile.blur_px,
        settings.profile.limb, 0, 0;
    begin_.inside = start.contrast.inside;
    begin_.outside = start.contrast.outside;
  }

  std::optional<DiscFit> Run() {
    if (start_.motion_px && start_.motion_px->norm() > kLeastMotionPx) {
      if (auto fit = Moving(*start_.motion_px, {1})) Take(*fit);
    }
    if (!best_) {
      disc::MotionScore score;
      if (auto fit = AtRest(score)) Take(*fit);
      const double length = score.motion_px.norm();
      if (score.chi2 > kMaybeMoves && length > 0 && MayMove()) {
        score.motion_px *= std::min(1.0, kFastestSds * MotionSdPx() / length);
        std::vector<double> ways = {1, -1};
        if (score.chi2 < kSurelyMoves) ways.push_back(0);
        if (auto fit = Moving(score.motion_px, ways)) Take(*fit);
      }
      // A motion that is too small to be seen shifts it, too.
      if (best_ && best_->solution.state.motion_px.isZero() && !start_.motion_px)
        best_->solution.covariance += score.unseen;
    }
    const bool is_cut = disc::IsCut(start_.reach);
    if (!IsGood() || is_cut) {
      // Fewer pixels always fit better: a hidden part must explain all of the misfit.
      if (const auto fit = BehindAnEdge()) {
        Keep(*fit);
        is_behind_edge_ = true;
      } else if (is_cut && !(best_ && best_->solution.misfit_sds < MostSdsOfCut())) {
        return std::nullopt;  // Part of it is hidden, and it is not clear which.
      }
    }
    if (!best_) return std::nullopt;
    if (!IsGood() && IsSmall()) best_->solution.covariance *= 1 + best_->solution.excess_chi2 / 3;
    return ToFit();
  }

 private:
  double MotionSdPx() const {
    const double px_per_m =
        start_.cone.tangent / (start_.radius_m * std::sqrt(slopes_.scale().determinant()));
    return settings_.shutter.speed_sd_mps * settings_.shutter.exposure_s * px_per_m;
  }

  bool MayMove() const { return !start_.is_unlikely && !IsMostlyHidden(); }
  /// Limit for a fit of the whole sphere where edges are missing.
  double MostSdsOfCut() const { return IsSmall() ? kGoodSds : kPoorSds; }
  bool IsMostlyHidden() const { return disc::HiddenSectors(start_.reach) > kMostHidden; }
  int MostPixels() const {
    return start_.is_unlikely ? static_cast<int>(kSomePixels) : kMostPixels;
  }
  bool IsSmall() const { return begin_.shape[2] < kSmallBlurs * fitter_.Blur(); }
  bool IsGood() const { return best_ && best_->solution.misfit_sds < kPoorSds; }

  /// The better one of two by its misfit; of two good ones the later.
  void Take(const Fit& fit) {
    if (!best_ || fit.solution.misfit_sds <= std::max(kPoorSds, best_->solution.misfit_sds))
      Keep(fit);
  }

  void Keep(const Fit& fit) {
    best_ = fit;
    clipped_share_ = fitter_.clipped_share();
  }

  std::optional<Fit> AtRest(disc::MotionScore& score) {
    fitter_.Collect(image_, slopes_, start_.middle_px, begin_, kFarBlurs, MostPixels());
    pixels_ = fitter_.samples();
    std::vector<bool> used = fitter_.Limit(begin_, start_.reach);
    fitter_.LookBehind(begin_, 0, used);
    auto solution = fitter_.Solve(begin_, false, 8);
    if (!solution) return std::nullopt;
    score = fitter_.ScoreMotion(solution->state);
    for (int round = 0; round < 2; ++round) {
      if (fitter_.DropSectors(used) == 0) break;
      solution = fitter_.Solve(solution->state, false, 4);
      if (!solution) return std::nullopt;
    }
    return Fit{*solution, used};
  }

  /// Both ways along a line, and at rest if that is possible: their mean by evidence. A part of the
  /// pixels says which of them are likely.
  std::optional<Fit> Moving(const Eigen::Vector2d& motion_px, const std::vector<double>& factors) {
    double length_px = motion_px.norm();
    std::vector<bool> used = CollectMoving(length_px);
    std::vector<State> starts;
    for (const double factor : factors) {
      starts.push_back(begin_);
      starts.back().motion_px = factor * motion_px;
    }
    std::vector<Mode> modes = Likely(starts);
    // A score is that of a short travel. Of a longer one the light reaches what was taken for
    // background.
    if (!modes.empty() && TravelPx(modes) > length_px + settings_.profile.blur_px) {
      length_px = TravelPx(modes);
      used = CollectMoving(length_px);
      starts.clear();
      for (const Mode& mode : modes) starts.push_back(mode.solution.state);
      modes = Likely(starts);
    }
    if (modes.empty() || modes.back().solution.misfit_sds > kNoMotionSds) return std::nullopt;
    fitter_.Use(moving_pixels_);
    std::vector<Solution> solutions = SolveAgain(modes);
    // The likeliest one was solved last.
    if (!solutions.empty() && fitter_.DropSectors(used) > 0) solutions = SolveAgain(modes);
    if (solutions.empty()) return std::nullopt;
    return Fit{disc::Mean(solutions), used};
  }

  static double TravelPx(const std::vector<Mode>& modes) {
    return modes.back().solution.state.motion_px.norm();
  }

  /// The pixels of a sphere with such a travel, and the sectors that take part.
  std::vector<bool> CollectMoving(double length_px) {
    fitter_.Collect(image_, slopes_, start_.middle_px, begin_,
                    kFarBlurs + 0.5 * length_px / settings_.profile.blur_px, kMostPixelsMoving);
    std::vector<bool> used = fitter_.Limit(begin_, start_.reach);
    fitter_.LookBehind(begin_, length_px, used);
    moving_pixels_ = fitter_.samples();
    return used;
  }

  /// Fits to a part of the pixels: those that are likely, the likeliest last.
  std::vector<Mode> Likely(const std::vector<State>& starts) {
    fitter_.Use(disc::Thinned(moving_pixels_, kSomePixels));
    std::vector<Mode> modes;
    for (const State& start : starts) {
      const bool moves = !start.motion_px.isZero();
      if (const auto found = fitter_.Solve(start, moves, 4)) modes.push_back({*found, moves});
    }
    KeepLikely(modes);
    return modes;
  }

  std::vector<Solution> SolveAgain(const std::vector<Mode>& modes) {
    std::vector<Solution> solutions;
    for (const Mode& mode : modes) {
      if (auto solution = fitter_.Solve(mode.solution.state, mode.moves, 3))
        solutions.push_back(*solution);
    }
    return solutions;
  }

  /// Those that are likely, the likeliest last.
  static void KeepLikely(std::vector<Mode>& modes) {
    constexpr double kUnlikely = 4;  // In the exponent, of a part of the pixels.
    std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
      return a.solution.log_evidence < b.solution.log_evidence;
    });
    const double most = modes.empty() ? 0 : modes.back().solution.log_evidence;
    std::erase_if(modes,
                  [&](const Mode& mode) { return mode.solution.log_evidence < most - kUnlikely; });
  }

  std::optional<Fit> BehindAnEdge() {
    if (pixels_.empty()) {
      fitter_.Collect(image_, slopes_, start_.middle_px, begin_, kFarBlurs, MostPixels());
    } else {
      fitter_.Use(pixels_);
    }
    const bool has_whole = best_ && best_->solution.state.motion_px.isZero();
    return disc::HiddenPart(fitter_, start_, begin_)
        .Find(has_whole ? best_->solution.state : begin_, IsGood());
  }

  DiscFit ToFit() const {
    const Solution& solution = best_->solution;
    DiscFit fit;
    fit.cone = {solution.state.shape.head<2>(), solution.state.shape[2]};
    fit.covariance = solution.covariance;
    fit.blur_px = solution.state.shape[3];
    fit.limb = solution.state.shape[4];
    fit.motion_px = solution.state.motion_px;
    fit.misfit = solution.misfit;
    fit.residual_share = solution.residual_share;
    fit.used_share =
        static_cast<double>(std::count(best_->sectors.begin(), best_->sectors.end(), true)) /
        kSectors;
    fit.clipped_share = clipped_share_;
    fit.is_doubtful = is_behind_edge_ || fit.cone.tangent < 2 * fitter_.Blur();
    return fit;
  }

  const Image& image_;
  const LocalSlopes& slopes_;
  const DiscStart& start_;
  const Settings& settings_;
  disc::PixelScale scale_;
  Fitter fitter_;
  State begin_;
  std::vector<Sample> pixels_;         // All that were collected, for a sphere at rest.
  std::vector<Sample> moving_pixels_;  // The same for a moving sphere.
  std::optional<Fit> best_;
  double clipped_share_ = 0;
  bool is_behind_edge_ = false;
};

}  // namespace

std::optional<DiscFit> FitDisc(const Image& image, const LocalSlopes& slopes,
                               const DiscStart& start, const Settings& settings,
                               const ProfileTable& table) {
  return Strategy(image, slopes, start, settings, table).Run();
}

namespace {

constexpr double kEdgeSdPx = 0.5;  // Standard deviation of one edge, found between quads.
// Error that all edges share: a small blurred disc beside a brighter thing seems smaller or larger.
constexpr double kRadiusSdPx = 0.4;
constexpr double kQuadPx = 2;  // Rays that are nearer to each other see the same quads.
constexpr std::size_t kFewestEdges = 8;

}  // namespace

SectorReach ReachOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes) {
  constexpr double kNear = 1.6 * 2 * std::numbers::pi / kSectors;
  SectorReach reach;
  std::vector<Eigen::Vector2d> polar;  // Angle and distance of each edge.
  for (const Eigen::Vector2d& at : slopes) {
    const Eigen::Vector2d from = at - fit.cone.axis;
    polar.emplace_back(std::atan2(from.y(), from.x()), from.norm());
  }
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double middle = 2 * std::numbers::pi * static_cast<double>(s) / kSectors;
    double nearest = fit.cone.tangent;
    int outliers = 0, inliers = 0;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const double apart = std::abs(polar[i].x() - middle);  // Up to one and a half turns.
      if (std::min(apart, std::abs(apart - 2 * std::numbers::pi)) > kNear) continue;
      ++(fit.inliers[i] ? inliers : outliers);
      if (!fit.inliers[i]) nearest = std::min(nearest, polar[i].y());
    }
    if (inliers > outliers) {
      reach[s] = std::numeric_limits<double>::infinity();
    } else {
      reach[s] = outliers > 0 ? nearest : 0;
    }
  }
  return reach;
}

std::optional<DiscFit> FitEdge(const LocalSlopes& slopes, const DiscStart& start,
                               const std::vector<bool>& inliers, double radius_sd_px) {
  const double per_px = std::sqrt(slopes.scale().determinant());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  double square = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    if (!inliers[i]) continue;
    const Eigen::Vector2d unit = (start.edges[i] - start.cone.axis).normalized();
    const Eigen::Vector3d row(unit.x(), unit.y(), 1);
    const double beyond = Beyond(start.cone, start.edges[i]);
    normal += row * row.transpose();
    square += beyond * beyond;
    ++count;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  if (count < kFewestEdges || !(solver.vectorD().minCoeff() > 1e-6)) return std::nullopt;
  const double circumference_px = 2 * std::numbers::pi * start.cone.tangent / per_px;
  const double same = std::max(1.0, kEdgeRays * kQuadPx / circumference_px);
  const double edge_sd = std::max(kEdgeSdPx * per_px, std::sqrt(square / double(count)));
  DiscFit fit;
  fit.cone = start.cone;
  fit.covariance = same * edge_sd * edge_sd * solver.solve(Eigen::Matrix3d::Identity());
  fit.covariance(2, 2) += std::pow(std::hypot(kRadiusSdPx, radius_sd_px) * per_px, 2);
  fit.used_share = static_cast<double>(count) / kEdgeRays;
  fit.is_doubtful = true;
  return fit;
}

namespace {

constexpr double kUnlikelyColourOff = 0.3;  // Its confidence is 0.6 at most.
// Before a lamp the half level is that of the clipped light, so that the sphere seems smaller: by
// 0.2 blurs before a lamp at 1.2 times the sensor's limit, by 1.6 at 8 times.
constexpr double kLampBlurs = 0.9, kLampBlursSd = 0.5;

}  // namespace

double Likeness(const Blob& blob, const Eigen::Vector3d& colour_dn) {
  const double chroma = (colour_dn.array() - colour_dn.mean()).matrix().norm();
  const int width = blob.right - blob.left + 1, height = blob.bottom - blob.top + 1;
  const double fill = blob.area / (0.25 * std::numbers::pi * width * height);
  const double aspect = static_cast<double>(std::min(width, height)) / std::max(width, height);
  const double strength = blob.score / (blob.area * chroma);
  return std::min(1.0, fill) * std::min(1.0, 1.5 * aspect) * std::min(1.0, strength);
}

double ColourOff(const Eigen::Vector3d& seen_dn, const Eigen::Vector3d& colour_dn) {
  const double scale = seen_dn.dot(colour_dn) / colour_dn.squaredNorm();
  if (!(scale > 0)) return 1;
  const double hue = (seen_dn / scale - colour_dn).norm() / colour_dn.norm();
  return std::hypot(hue, std::max(0.0, 1 - scale));
}

std::optional<Candidate> CandidateOf(const Scene& scene, const Target& target, const Blob& blob,
                                     Surroundings around) {
  const InnerQuads inner = InnerQuadsOf(blob);
  const double colour_off = ColourOff(ColourOf(scene.quads, inner), target.colour_dn);
  if (colour_off >= kMostColourOff) return std::nullopt;  // Its confidence would be zero.
  const auto edges = FindEdges(scene.image, scene.quads, blob, inner, scene.settings.noise, around);
  if (!edges) return std::nullopt;
  const Eigen::Vector2d middle_px = blob.MiddlePx();
  const double size_px = blob.SizePx(), blur_px = scene.settings.profile.blur_px;
  // Its nodes lie near the edge, where an error would be one of the distance.
  LocalSlopes slopes(scene.lens, middle_px, 0.5 * size_px);
  std::vector<Eigen::Vector2d> at;
  for (std::size_t i = 0; i < edges->pixels.size(); ++i) {
    Eigen::Vector2d pixel = edges->pixels[i];
    if (edges->at_lamp[i]) pixel += kLampBlurs * blur_px * (pixel - middle_px).normalized();
    at.push_back(slopes.At(pixel.x(), pixel.y()));
  }
  const double per_px = std::sqrt(slopes.scale().determinant());
  const double tolerance = per_px * std::max(0.5, 0.04 * size_px);
  auto fit = FitConeRobustly(at, tolerance, 0.8 * per_px, 1.5 * size_px * per_px);
  if (!fit) return std::nullopt;
  const std::vector<bool> inliers = fit->inliers;
  int count = 0, at_lamp = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!inliers[i]) continue;
    ++count;
    if (!edges->at_lamp[i]) continue;
    ++at_lamp;
    fit->inliers[i] = false;  // The light there is the lamp's, too.
  }
  Candidate candidate{
      slopes,
      {edges->contrast, middle_px, fit->cone, ReachOf(*fit, at), at, target.radius_m},
      inliers};
  if (around == Surroundings::kLamp) candidate.start.lit = LitQuads(scene.quads, blob);
  candidate.colour_off = colour_off;
  candidate.is_compact = size_px < 3 * fit->cone.tangent / per_px + 4;
  candidate.start.is_unlikely = colour_off > kUnlikelyColourOff;
  candidate.quality =
      static_cast<double>(count) / kEdgeRays * std::max(0.0, 1 - candidate.colour_off);
  candidate.radius_sd_px = kLampBlursSd * blur_px * at_lamp / std::max(1, count);
  return candidate;
}

}  // namespace footing::sphere

#include "common/camera/disc_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/camera/disc_fitter.h"
#include "common/camera/disc_hidden.h"

namespace footing::sphere {
namespace {

using disc::Fit, disc::Fitter;
using disc::kGoodSds, disc::kPoorSds, disc::kSomePixels;
using disc::Sample, disc::Solution, disc::State;

constexpr int kMostPixels = 700, kMostPixelsMoving = 400;  // A moving one costs twice as much.
constexpr double kFarBlurs = 4;       // Beyond the edge; the background needs no more.
constexpr double kMaybeMoves = 13.3;  // Of chi² with four degrees: 1 % of spheres at rest.
constexpr double kSurelyMoves = 40;
constexpr double kLeastMotionPx = 0.4;
constexpr double kNoMotionSds = 8;  // A misfit of a part of the pixels that motion never has.
constexpr double kFastestSds = 8;   // Of a hand's speed: the start of a fit is held to that.
// Of a smaller sphere what hides a part looks like its edge. A misfit that nothing explains is then
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
  /// Of a fit of the whole sphere where edges are missing.
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

  /// Of fits to a part of the pixels, those that are likely, the likeliest last.
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
  std::vector<Sample> pixels_;         // Of a sphere at rest, all that were collected.
  std::vector<Sample> moving_pixels_;  // Of one that moves.
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

}  // namespace footing::sphere

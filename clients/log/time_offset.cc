#include "clients/log/time_offset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "common/base/low_pass.h"
#include "common/base/text.h"

namespace footing::log_client {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kStride = 4;         // Step of the search, in samples: 25 Hz.
constexpr double kCutoffHz = 6;      // Below what markers measure and a board's 60 Hz.
constexpr double kRawCutoffHz = 30;  // Before a faster signal is sampled.
constexpr double kLeastOverlapS = 1;
constexpr double kGreatestCorrelation = 0.9995;  // Beyond it evidence would say more than data can.
constexpr double kStandsN = 100;
/// Nobody is on the boards, and something else supports the markers' person.
constexpr double kOffBoards = 0.1, kSupported = 0.5;  // Parts of the standing force.

// The sum of eight cells; a Balance Board's repeat within some newtons each.
constexpr double kPlaySdN = 15, kMostPlayN = 80;
constexpr int kPasses = 12;
constexpr int kFewestPieces = 6, kMostPieces = 12;
constexpr double kPieceS = 0.5;
// Systematic parts of the standard deviation: of plates and of markers.
constexpr double kForceSdS = 0.002, kMarkersSdS = 0.004;
constexpr double kForcePlaySdN = 1, kMarkersPlaySdN = 4;

// Sure from here on.
constexpr double kLeastEvidence = 8, kLeastLead = 6;  // Nats.
constexpr double kLeastMarkersCorrelation = 0.9, kLeastForceCorrelation = 0.97;
constexpr double kMostMisfit = 0.025;  // In parts of the standing force.
constexpr double kLeastGain = 0.5, kMostGain = 2;

/// Without gaps, for filters: straight lines over them.
VectorXd Filled(const VectorXd& values) {
  VectorXd filled = values;
  Index before = -1;
  for (Index i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values(i))) continue;
    for (Index k = before + 1; k < i; ++k) {
      const double share = static_cast<double>(k - before) / static_cast<double>(i - before);
      filled(k) = before < 0 ? values(i) : (1 - share) * values(before) + share * values(i);
    }
    before = i;
  }
  for (Index k = before + 1; k < values.size(); ++k) filled(k) = before < 0 ? 0 : values(before);
  return filled;
}

VectorXd LowPass(const VectorXd& values, double rate_hz, double cutoff_hz) {
  return footing::LowPass(Filled(values).transpose(), rate_hz, cutoff_hz).row(0);
}

/// Between the samples before and after `place`; NaN outside and beside a gap.
double Between(const VectorXd& values, double place) {
  if (!(place >= 0) || place > static_cast<double>(values.size() - 1)) return kUnmeasured;
  const auto i = std::min(static_cast<Index>(place), values.size() - 2);
  const double share = place - static_cast<double>(i);
  return (1 - share) * values(i) + share * values(i + 1);
}

/// At kSeriesRateHz, from the same start.
VectorXd Sampled(const Series& series) {
  VectorXd values = series.force_n;
  if (series.rate_hz > 2 * kRawCutoffHz * 1.2) {
    const VectorXd smooth = LowPass(values, series.rate_hz, kRawCutoffHz);
    values = values.array().isFinite().select(smooth, kUnmeasured);
  }
  const double ratio = series.rate_hz / kSeriesRateHz;
  const auto count = static_cast<Index>(static_cast<double>(values.size() - 1) / ratio) + 1;
  return VectorXd::NullaryExpr(
      count, [&](Index i) { return Between(values, static_cast<double>(i) * ratio); });
}

/// One side of the comparison at kSeriesRateHz; NaN where nothing was measured.
struct Signal {
  VectorXd raw, smooth, slope;  ///< N, N, N/s.

  explicit Signal(VectorXd values) : raw(std::move(values)) {
    smooth = Smooth(raw);
    slope = SlopeOf(smooth);
  }
  /// With the gaps of `raw`.
  VectorXd Smooth(const VectorXd& values) const {
    return raw.array().isFinite().select(LowPass(values, kSeriesRateHz, kCutoffHz), kUnmeasured);
  }
  static VectorXd SlopeOf(const VectorXd& values) {
    return VectorXd::NullaryExpr(values.size(), [&](Index i) {
      const Index from = std::max<Index>(i - 1, 0), to = std::min(i + 1, values.size() - 1);
      return (values(to) - values(from)) * kSeriesRateHz / static_cast<double>(to - from);
    });
  }
};

/// The force that cells with this play show.
VectorXd Play(const VectorXd& force, double half_width_n) {
  VectorXd shown = Filled(force);
  for (Index i = 1; i < shown.size(); ++i) {
    shown(i) = std::clamp(shown(i - 1), shown(i) - half_width_n, shown(i) + half_width_n);
  }
  return shown;
}

class Search {
 public:
  Search(const Series& ours, const Series& theirs, const OffsetOptions& options)
      : options_(options),
        ours_(Sampled(ours)),
        theirs_(Sampled(theirs)),
        standing_n_(StandingForce(ours)),
        shift_s_(ours.start_s - theirs.start_s) {}

  std::optional<TimeOffset> Run() {
    if (ours_.raw.size() < 4 || theirs_.raw.size() < 4) return std::nullopt;
    const auto best = FindPeak();
    if (!best || !Solve(static_cast<double>(*best))) return std::nullopt;
    found_.offset_s = shift_s_ + tau_ / kSeriesRateHz;
    Doubt();
    return found_;
  }

 private:
  static constexpr Index kParameters = 4;  ///< a, b, tau, H.
  using Matrix = Eigen::Matrix<double, kParameters, kParameters>;
  using Vector = Eigen::Matrix<double, kParameters, 1>;

  /// Sums over a piece of the overlap.
  struct Piece {
    Matrix A = Matrix::Zero();
    Vector g = Vector::Zero();
  };
  struct Evidence {
    double nats = 0, correlation = 0, overlap_s = 0;
  };

  /// Whether a pair says something.
  bool Counts(double ours_n, double theirs_n) const {
    if (!std::isfinite(ours_n) || !std::isfinite(theirs_n)) return false;
    return !options_.from_markers || ours_n >= kOffBoards * standing_n_ ||
           theirs_n <= kSupported * standing_n_;
  }

  /// Evidence for the offset that puts the first sample of theirs at our sample `lag`.
  Evidence At(Index lag, Index stride) const {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, vv = 0;
    const Index from = std::max<Index>(0, -lag);
    const Index to = std::min(theirs_.smooth.size(), ours_.smooth.size() - lag);
    for (Index i = (from + stride - 1) / stride * stride; i < to; i += stride) {
      const double a = theirs_.smooth(i), b = ours_.smooth(i + lag), v = theirs_.slope(i);
      if (!Counts(b, a) || !std::isfinite(v)) continue;
      n += 1;
      x += a;
      y += b;
      xx += a * a;
      yy += b * b;
      xy += a * b;
      vv += v * v;
    }
    Evidence evidence;
    evidence.overlap_s = n * static_cast<double>(stride) / kSeriesRateHz;
    if (evidence.overlap_s < kLeastOverlapS) return evidence;
    const double spread_x = xx / n - x * x / (n * n), spread_y = yy / n - y * y / (n * n);
    if (!(spread_x > 1) || !(spread_y > 1)) return evidence;  // N^2: nothing changes.
    const double r = (xy / n - x * y / (n * n)) / std::sqrt(spread_x * spread_y);
    evidence.correlation = r;
    if (r <= 0) return evidence;
    const double frequency_hz = std::sqrt(vv / n / spread_x) / (2 * M_PI);
    const double least = std::min(r, kGreatestCorrelation);
    evidence.nats = -frequency_hz * evidence.overlap_s * std::log(1 - least * least);
    return evidence;
  }

  /// The lag with the most evidence, and the next one elsewhere.
  std::optional<Index> FindPeak() {
    const Index least = static_cast<Index>(kLeastOverlapS * kSeriesRateHz);
    const Index first = -(theirs_.raw.size() - least), last = ours_.raw.size() - least;
    std::vector<double> nats;
    for (Index lag = first; lag <= last; lag += kStride) nats.push_back(At(lag, kStride).nats);
    if (nats.empty()) return std::nullopt;
    const auto top = std::max_element(nats.begin(), nats.end()) - nats.begin();
    if (nats[static_cast<std::size_t>(top)] <= 0) return std::nullopt;
    const auto at = [&](Index i) { return nats[static_cast<std::size_t>(i)]; };
    Index low = top, high = top;  // The peak goes down to there.
    while (low > 0 && at(low - 1) <= at(low)) --low;
    while (high + 1 < std::ssize(nats) && at(high + 1) <= at(high)) ++high;
    for (Index i = 0; i < std::ssize(nats); ++i) {
      if ((i >= low && i <= high) || at(i) <= found_.runner_up_evidence) continue;
      found_.runner_up_evidence = at(i);
      found_.runner_up_s = shift_s_ + static_cast<double>(first + i * kStride) / kSeriesRateHz;
    }
    Index best = first + top * kStride;
    Evidence most = At(best, 1);
    for (Index lag = best - 2 * kStride, end = best + 2 * kStride; lag <= end; ++lag) {
      const Evidence evidence = At(lag, 1);
      if (evidence.nats <= most.nats) continue;
      most = evidence;
      best = lag;
    }
    found_.evidence = most.nats;
    return best;
  }

  /// Cubic between our smooth samples.
  double Ours(double place) const {
    const auto k = static_cast<Index>(std::floor(place));
    if (k < 1 || k + 2 >= ours_.smooth.size()) return kUnmeasured;
    const double f = place - static_cast<double>(k);
    const double a = ours_.smooth(k - 1), b = ours_.smooth(k), c = ours_.smooth(k + 1),
                 d = ours_.smooth(k + 2);
    return b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)));
  }

  /// The equations of one pass: J = (1, P - mean, -P', dP/dH) for each pair.
  std::vector<Piece> Equations(const VectorXd& shown, const VectorXd& by_play) {
    const VectorXd slope = Signal::SlopeOf(shown) / kSeriesRateHz;
    std::vector<std::pair<Index, double>> rows;
    double mean = 0;
    for (Index i = 0; i < shown.size(); ++i) {
      const double y = Ours(static_cast<double>(i) + tau_);
      if (!Counts(y, theirs_.smooth(i)) || !std::isfinite(slope(i))) continue;
      rows.emplace_back(i, y);
      mean += shown(i);
    }
    const auto count = static_cast<double>(rows.size());
    mean /= std::max(count, 1.0);
    const auto pieces =
        std::clamp(static_cast<int>(count / (kPieceS * kSeriesRateHz)), kFewestPieces, kMostPieces);
    std::vector<Piece> equations(static_cast<std::size_t>(pieces));
    sum_yy_ = sum_y_ = 0;
    for (std::size_t q = 0; q < rows.size(); ++q) {
      const auto& [i, y] = rows[q];
      const Vector J(1, shown(i) - mean, -slope(i), by_play(i));
      Piece& piece = equations[q * equations.size() / rows.size()];
      piece.A += J * J.transpose();
      piece.g += J * y;
      sum_y_ += y;
      sum_yy_ += y * y;
    }
    pairs_ = count;
    return equations;
  }

  /// Solves for a, b, tau and H from this lag on; false where there is too little to solve.
  bool Solve(double lag) {
    tau_ = lag;
    double play_n = 10, variance = 400;
    for (int pass = 0; pass < kPasses; ++pass) {
      const double less_n = std::max(play_n - 2, 0.0), more_n = play_n + 2;
      const auto shown = [&](double n) { return theirs_.Smooth(Play(theirs_.raw, n)); };
      const auto equations =
          Equations(shown(play_n), (shown(more_n) - shown(less_n)) / (more_n - less_n));
      if (pairs_ < kLeastOverlapS * kSeriesRateHz / 2) return false;
      Piece sum;
      for (const Piece& piece : equations) {
        sum.A += piece.A;
        sum.g += piece.g;
      }
      const Piece data = sum;
      // Prior of the play, with a mean of 0. Neighbouring samples repeat each other.
      const double repeated = kSeriesRateHz / (2 * kCutoffHz);
      const double known = variance * repeated / (kPlaySdN * kPlaySdN);
      sum.A(3, 3) += known;
      sum.g(3) -= known * play_n;
      const Eigen::LDLT<Matrix> solver(sum.A);
      const Vector s = solver.solve(sum.g);
      if (!s.allFinite() || std::abs(s(1)) < 1e-9) return false;
      const double left = sum_yy_ - 2 * s.dot(data.g) + s.dot(data.A * s);
      variance = std::max(left / pairs_, 1e-6);
      const double step = std::clamp(s(2) / s(1), -3.0, 3.0);
      const double wider_n =
          std::clamp(play_n + std::clamp(s(3) / s(1), -8.0, 8.0), 0.0, kMostPlayN);
      const bool settled = std::abs(step) < 0.01 && std::abs(wider_n - play_n) < 0.3;
      tau_ += step;
      play_n = wider_n;
      if (!settled && pass + 1 < kPasses) continue;
      Report(equations, sum, s, variance, repeated);
      found_.play_n = play_n;
      return true;
    }
    return false;
  }

  void Report(const std::vector<Piece>& equations, const Piece& sum, const Vector& s,
              double variance, double repeated) {
    std::vector<double> without;  // The offset without one of the pieces.
    double mean = 0;
    for (const Piece& piece : equations) {
      const Vector t = (sum.A - piece.A).ldlt().solve(sum.g - piece.g);
      without.push_back(std::abs(t(1)) > 1e-9 ? t(2) / t(1) : 0);
      mean += without.back() / static_cast<double>(equations.size());
    }
    double jackknife = 0;
    for (const double one : without) jackknife += (one - mean) * (one - mean);
    const auto count = static_cast<double>(equations.size());
    const Vector by_play = sum.A.ldlt().solve(Vector::Unit(3));
    const double play_sd_n =
        std::hypot(std::sqrt(std::max(0.0, variance * repeated * by_play(3))) / s(1),
                   options_.from_markers ? kMarkersPlaySdN : kForcePlaySdN);
    const double of_play = play_sd_n * by_play(2) / by_play(3);
    const double of_method = options_.from_markers ? kMarkersSdS : kForceSdS;
    found_.sd_s = std::hypot(std::sqrt(jackknife * (count - 1) / count) / kSeriesRateHz,
                             of_play / kSeriesRateHz, of_method);
    if (!std::isfinite(found_.sd_s)) found_.sd_s = 1e3;
    const double spread = sum_yy_ / pairs_ - sum_y_ * sum_y_ / (pairs_ * pairs_);
    found_.correlation = std::sqrt(std::clamp(1 - variance / std::max(spread, 1e-9), 0.0, 1.0));
    found_.misfit_n = std::sqrt(variance);
    found_.gain = s(1);
    found_.overlap_s = pairs_ / kSeriesRateHz;
  }

  /// Says why the result is not sure.
  void Doubt() {
    const double least_correlation =
        options_.from_markers ? kLeastMarkersCorrelation : kLeastForceCorrelation;
    const bool is_elsewhere = found_.evidence - found_.runner_up_evidence < kLeastLead;
    std::string& doubt = found_.doubt;
    if (found_.evidence < kLeastEvidence || found_.correlation < least_correlation) {
      doubt =
          "the forces do not go together for long enough; let both record a jump or three "
          "stamps";
    } else if (is_elsewhere && found_.runner_up_s) {
      doubt = "an offset of " + text::Fixed(*found_.runner_up_s, 2) +
              " s fits almost as well; let both record more, or something that does not repeat";
    } else if (found_.gain < kLeastGain || found_.gain > kMostGain) {
      doubt = "the boards measured " + text::Fixed(found_.gain, 3) +
              " times the force of the file: its unit is wrong, or it is another person";
    } else if (!options_.from_markers && found_.misfit_n > kMostMisfit * standing_n_) {
      doubt = "the forces differ by " + text::Fixed(found_.misfit_n, 0) +
              " N: it may be another trial of the same kind";
    } else if (found_.sd_s > options_.most_sd_s) {
      doubt = "the standard deviation of " + text::Fixed(1e3 * found_.sd_s, 1) + " ms is over " +
              text::Fixed(1e3 * options_.most_sd_s, 1) + " ms; a jump or a stamp is more certain";
    }
    found_.sure = doubt.empty();
  }

  const OffsetOptions options_;
  const Signal ours_, theirs_;
  const double standing_n_;
  const double shift_s_;  ///< Between the first samples' times.
  double tau_ = 0;        ///< Samples.
  double pairs_ = 0, sum_y_ = 0, sum_yy_ = 0;
  TimeOffset found_;
};

}  // namespace

double StandingForce(const Series& force) {
  std::vector<double> loaded;
  for (const double value : force.force_n) {
    if (value > kStandsN) loaded.push_back(value);
  }
  if (loaded.empty()) return 0;
  const auto middle = loaded.begin() + std::ssize(loaded) / 2;
  std::nth_element(loaded.begin(), middle, loaded.end());
  return *middle;
}

std::optional<TimeOffset> FindOffset(const Series& ours, const Series& theirs,
                                     const OffsetOptions& options) {
  return Search(ours, theirs, options).Run();
}

}  // namespace footing::log_client

#include "daemon/offline/learning/time_alignment.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "common/base/quantile.h"

namespace footing::learning {
namespace {

constexpr double kCutoffHz = 6;     // Both are as smooth as Follow makes a motion's.
constexpr double kIntervalS = 0.1;  // By which stomps may be off: 50 ms each.
constexpr double kMatchS = 0.05;    // In the end.
constexpr double kLeastOverlapS = 5;
constexpr std::size_t kMostCandidates = 400;
constexpr int kCoarseStride = 4;          // Of the rate, in the search.
constexpr double kPieceS = 8, kHopS = 4;  // Of what is moved until it correlates best.
constexpr double kLagS = 0.12;            // At most, and in such steps:
constexpr double kLagStepS = 0.01;
constexpr double kPieceCorrelation = 0.6;
constexpr double kPieceSpread = 0.02;  // Of the weight: less means nothing.
constexpr int kPasses = 3;
constexpr double kOutlier = 3.5;  // Of the pieces' usual distance from the line.
constexpr double kLeastSdS = 5e-4;

struct Signal {
  Eigen::VectorXd total;
  const ForceTrace& trace;

  explicit Signal(const ForceTrace& from) : total(from.Total(kCutoffHz)), trace(from) {}

  /// Nothing outside, and where nothing was measured.
  std::optional<double> At(double time_s) const {
    const double place = time_s * trace.rate_hz;
    if (!(place >= 0) || place >= static_cast<double>(total.size() - 1)) return std::nullopt;
    const auto i = static_cast<Eigen::Index>(place);
    const auto k = static_cast<std::size_t>(i);
    if (!trace.valid[k] || !trace.valid[k + 1]) return std::nullopt;
    const double share = place - static_cast<double>(i);
    return (1 - share) * total(i) + share * total(i + 1);
  }
};

/// Sums for a correlation of pairs.
struct Pairs {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void Add(double a, double b) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  double spread() const { return std::sqrt(std::max(0.0, xx / n - x * x / (n * n))); }
  double correlation() const {
    const double a = n * xx - x * x, b = n * yy - y * y;
    return a > 1e-12 && b > 1e-12 ? (n * xy - x * y) / std::sqrt(a * b) : 0;
  }
};

/// Over a span of the motion's time; the recording is `lag_s` later than `at` says.
Pairs Compare(const Signal& recorded, const Signal& moved, const TimeAlignment& at, double lag_s,
              Eigen::Index from, Eigen::Index to, int stride = 1) {
  Pairs pairs;
  for (Eigen::Index i = from; i < to; i += stride) {
    if (!moved.trace.valid[static_cast<std::size_t>(i)]) continue;
    const double time_s = static_cast<double>(i) / moved.trace.rate_hz;
    if (const auto y = recorded.At(at.ToRecording(time_s) + lag_s)) pairs.Add(moved.total(i), *y);
  }
  return pairs;
}

Pairs CompareAll(const Signal& recorded, const Signal& moved, const TimeAlignment& at, int stride) {
  return Compare(recorded, moved, at, 0, 0, moved.total.size(), stride);
}

int Both(const std::vector<Stomp>& recorded, const std::vector<Stomp>& moved,
         const TimeAlignment& at, double within_s) {
  int both = 0;
  std::size_t k = 0;
  for (const Stomp& stomp : moved) {
    const double expected_s = at.ToRecording(stomp.time_s);
    while (k < recorded.size() && recorded[k].time_s < expected_s - within_s) ++k;
    if (k == recorded.size()) break;
    if (recorded[k].time_s > expected_s + within_s) continue;
    ++both;
    ++k;
  }
  return both;
}

/// Offsets at which three stomps and more go together; of very many, those with most of them.
std::vector<double> Candidates(const std::vector<Stomp>& recorded,
                               const std::vector<Stomp>& moved) {
  struct Candidate {
    double offset_s;
    int both;
  };
  std::vector<double> offsets;
  std::vector<Candidate> candidates;
  for (const Stomp& a : recorded) {
    for (const Stomp& b : moved) offsets.push_back(a.time_s - b.time_s);
  }
  std::sort(offsets.begin(), offsets.end());
  double last_s = -1e300;
  for (const double offset_s : offsets) {
    if (offset_s - last_s < 0.2 * kIntervalS) continue;
    TimeAlignment at;
    at.offset_s = offset_s;
    const int both = Both(recorded, moved, at, kIntervalS);
    if (both < kFewestStomps) continue;
    candidates.push_back({offset_s, both});
    last_s = offset_s;
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.both > b.both; });
  if (candidates.size() > kMostCandidates) candidates.resize(kMostCandidates, {});
  offsets.clear();
  for (const Candidate& candidate : candidates) offsets.push_back(candidate.offset_s);
  return offsets;
}

/// Evidence of a correlation over this time: Fisher's z in parts of its deviation.
double Evidence(const Pairs& pairs, double rate_hz) {
  const double seconds = pairs.n / rate_hz;
  if (seconds < kLeastOverlapS) return 0;
  return std::atanh(std::clamp(pairs.correlation(), 0.0, 0.999)) * std::sqrt(seconds);
}

std::optional<TimeAlignment> Search(const Signal& recorded, const Signal& moved,
                                    const std::vector<double>& candidates) {
  std::optional<TimeAlignment> best;
  double most = 0;
  for (const double candidate_s : candidates) {
    for (double lag_s = -kIntervalS; lag_s <= kIntervalS; lag_s += 2 * kLagStepS) {
      TimeAlignment at;
      at.offset_s = candidate_s + lag_s;
      const Pairs pairs = CompareAll(recorded, moved, at, kCoarseStride);
      const double evidence = Evidence(pairs, moved.trace.rate_hz / kCoarseStride);
      if (evidence <= most) continue;
      most = evidence;
      best = at;
    }
  }
  return best;
}

struct Piece {
  double time_s, lag_s, weight;  // Weight: of information, one over a variance but for a factor.
};

std::optional<Piece> Place(const Signal& recorded, const Signal& moved, const TimeAlignment& at,
                           Eigen::Index from, Eigen::Index to) {
  constexpr int kSteps = static_cast<int>(kLagS / kLagStepS + 0.5);
  std::vector<double> correlation;
  Pairs middle;
  for (int k = -kSteps; k <= kSteps; ++k) {
    const Pairs pairs = Compare(recorded, moved, at, k * kLagStepS, from, to);
    if (pairs.n < 0.8 * static_cast<double>(to - from)) return std::nullopt;
    correlation.push_back(pairs.correlation());
    if (k == 0) middle = pairs;
  }
  const auto top = std::max_element(correlation.begin(), correlation.end());
  const auto k = top - correlation.begin();
  if (*top < kPieceCorrelation || k == 0 || k + 1 == std::ssize(correlation)) return std::nullopt;
  if (middle.spread() < kPieceSpread) return std::nullopt;
  const double before = *(top - 1), after = *(top + 1);
  const double curvature = 2 * *top - before - after;
  if (!(curvature > 1e-9)) return std::nullopt;
  const double part = 0.5 * (after - before) / curvature;
  return Piece{static_cast<double>(from + to) / 2 / moved.trace.rate_hz,
               (static_cast<double>(k - kSteps) + part) * kLagStepS, curvature / (1.001 - *top)};
}

std::vector<Piece> PlacePieces(const Signal& recorded, const Signal& moved,
                               const TimeAlignment& at) {
  const auto length = static_cast<Eigen::Index>(kPieceS * moved.trace.rate_hz);
  const auto hop = static_cast<Eigen::Index>(kHopS * moved.trace.rate_hz);
  std::vector<Piece> pieces;
  const Eigen::Index end = moved.total.size();
  for (Eigen::Index from = 0; from + std::min(length, end) <= end; from += hop) {
    const auto piece = Place(recorded, moved, at, from, from + std::min(length, end));
    if (piece) pieces.push_back(*piece);
  }
  return pieces;
}

struct Line {
  double middle_s = 0, lag_s = 0, drift = 0, sd_s = 0;
  int pieces = 0;
  double At(double time_s) const { return lag_s + drift * (time_s - middle_s); }
};

/// Least squares with the weights and the drift's prior.
Line Fit(const std::vector<Piece>& pieces, double sd_s) {
  Line line;
  double weight = 0, mean = 0;
  for (const Piece& piece : pieces) {
    weight += piece.weight;
    line.middle_s += piece.weight * piece.time_s;
    line.lag_s += piece.weight * piece.lag_s;
  }
  line.middle_s /= weight;
  line.lag_s /= weight;
  mean = weight / static_cast<double>(pieces.size());
  double tt = sd_s * sd_s * mean / (kDriftSd * kDriftSd), tl = 0;
  for (const Piece& piece : pieces) {
    const double t_s = piece.time_s - line.middle_s;
    tt += piece.weight * t_s * t_s;
    tl += piece.weight * t_s * (piece.lag_s - line.lag_s);
  }
  line.drift = tl / tt;
  double squares = 0;
  for (const Piece& piece : pieces) {
    const double off_s = piece.lag_s - line.At(piece.time_s);
    squares += piece.weight * off_s * off_s;
  }
  line.sd_s = std::sqrt(squares / weight);
  line.pieces = static_cast<int>(pieces.size());
  return line;
}

/// Without the pieces that are far from the line of the others.
Line FitRobustly(std::vector<Piece> pieces) {
  Line line = Fit(pieces, 5e-3);
  for (int round = 0; round < 5; ++round) {
    std::vector<double> off_s;
    for (const Piece& p : pieces) off_s.push_back(std::abs(p.lag_s - line.At(p.time_s)));
    const double limit_s = kOutlier * std::max(1.5 * text::Median(std::move(off_s)), kLeastSdS);
    const auto end = std::remove_if(pieces.begin(), pieces.end(), [&](const Piece& p) {
      return std::abs(p.lag_s - line.At(p.time_s)) > limit_s;
    });
    const bool same = end == pieces.end();
    pieces.erase(end, pieces.end());
    line = Fit(pieces, std::max(line.sd_s, kLeastSdS));
    if (same && round > 0) break;
  }
  return line;
}

Error TooFewStomps(const ForceTrace& trace, std::size_t found) {
  std::ostringstream text;
  text.precision(3);
  text << trace.name << ": " << found << " stomps found in " << trace.duration_s()
       << " s of vertical force, and three are needed: pushes of " << 100 * kStompOver
       << " % over the weight within " << kUnloadedS
       << " s of a foot off the ground; stomp hard three times at uneven intervals, on the boards "
          "and in sight of the motion capture";
  return InvalidData(text.str());
}

Error NotTogether(const ForceTrace& recorded, const ForceTrace& moved, double correlation) {
  std::ostringstream text;
  text.precision(2);
  text << recorded.name << " and " << moved.name
       << ": the forces do not go together at any offset where three stomps do (best correlation "
       << correlation << "): was this recording made beside that motion?";
  return InvalidData(text.str());
}

}  // namespace

Result<TimeAlignment> AlignInTime(const ForceTrace& recorded, const ForceTrace& moved) {
  const std::vector<Stomp> stomps = FindStomps(recorded), of_motion = FindStomps(moved);
  if (stomps.size() < kFewestStomps) return TooFewStomps(recorded, stomps.size());
  if (of_motion.size() < kFewestStomps) return TooFewStomps(moved, of_motion.size());
  const Signal measured(recorded), derived(moved);
  auto found = Search(measured, derived, Candidates(stomps, of_motion));
  if (!found) return NotTogether(recorded, moved, 0);
  TimeAlignment at = *found;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::vector<Piece> pieces = PlacePieces(measured, derived, at);
    if (pieces.empty()) return NotTogether(recorded, moved, 0);
    const Line line = FitRobustly(pieces);
    at.offset_s += line.At(0);
    at.drift += line.drift;
    at.residual_s = line.sd_s;
    at.pieces = line.pieces;
  }
  const Pairs pairs = CompareAll(measured, derived, at, 1);
  at.correlation = pairs.correlation();
  at.overlap_s = pairs.n / moved.rate_hz;
  if (at.correlation < kLeastCorrelation) return NotTogether(recorded, moved, at.correlation);
  at.stomps_recording = static_cast<int>(stomps.size());
  at.stomps_motion = static_cast<int>(of_motion.size());
  at.stomps_both = Both(stomps, of_motion, at, kMatchS);
  return at;
}

}  // namespace footing::learning

#include "daemon/offline/learning/time_alignment.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "common/base/low_pass.h"
#include "common/base/result.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/kinematics.h"

namespace footing::learning {
namespace {

constexpr double kApartS = 0.25;

/// How long the push around `peak` is over half of what it is there.
double WidthS(const Eigen::VectorXd& total, Eigen::Index peak, double rate_hz) {
  const double half = 1 + 0.5 * (total(peak) - 1);
  Eigen::Index from = peak, to = peak;
  while (from > 0 && total(from - 1) > half) --from;
  while (to + 1 < total.size() && total(to + 1) > half) ++to;
  return static_cast<double>(to - from + 1) / rate_hz;
}

/// A foot that carries nothing shortly before, and where something is measured from then on.
bool ComesDown(const ForceTrace& trace, Eigen::Index peak) {
  const auto before = static_cast<Eigen::Index>(kUnloadedS * trace.rate_hz);
  bool unloaded = false;
  for (Eigen::Index i = std::max<Eigen::Index>(0, peak - before); i <= peak; ++i) {
    if (!trace.valid[static_cast<std::size_t>(i)]) return false;
    unloaded = unloaded || trace.load_n.col(i).minCoeff() < kUnloadedShare * trace.weight_n;
  }
  return unloaded;
}

}  // namespace

Eigen::VectorXd ForceTrace::Total(double cutoff_hz) const {
  FOOTING_CHECK(weight_n > 0);
  const Eigen::MatrixXd total = load_n.colwise().sum() / weight_n;
  return LowPass(total, rate_hz, cutoff_hz).row(0);
}

std::vector<Stomp> FindStomps(const ForceTrace& trace) {
  std::vector<Stomp> stomps;
  if (trace.load_n.cols() < 3) return stomps;
  const Eigen::VectorXd total = trace.Total(kStompCutoffHz);
  for (Eigen::Index i = 1; i + 1 < total.size(); ++i) {
    const bool peak = total(i) > total(i - 1) && total(i) >= total(i + 1);
    if (!peak || total(i) < 1 + kStompOver || !ComesDown(trace, i)) continue;
    if (WidthS(total, i, trace.rate_hz) > kStompLongestS) continue;
    const Stomp stomp{static_cast<double>(i) / trace.rate_hz, total(i) - 1};
    if (!stomps.empty() && stomp.time_s - stomps.back().time_s < kApartS) {
      if (stomp.over > stomps.back().over) stomps.back() = stomp;
    } else {
      stomps.push_back(stomp);
    }
  }
  return stomps;
}

namespace {

constexpr double kCutoffHz = 6;     // Both are as smooth as Follow makes a motion's.
constexpr double kIntervalS = 0.1;  // Between matching stomps in the search: 50 ms each.
constexpr double kMatchS = 0.05;    // Between matching stomps in the result.
constexpr double kLeastOverlapS = 5;
constexpr std::size_t kMostCandidates = 400;
constexpr int kCoarseStride = 4;          // Samples skipped in the search.
constexpr double kPieceS = 8, kHopS = 4;  // Pieces that are moved until they correlate best.
constexpr double kLagS = 0.12;            // At most, and in such steps:
constexpr double kLagStepS = 0.01;
constexpr double kPieceCorrelation = 0.6;
constexpr double kPieceSpread = 0.02;  // In parts of the weight: less means nothing.
constexpr int kPasses = 3;
constexpr double kOutlier = 3.5;  // In multiples of the pieces' usual distance from the line.
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

namespace {

using body::Landmark;

constexpr double kToeAboveFloorM = 0.015;
constexpr double kPartBelowFloor = 0.02;

void Unwrap(const body::Skeleton& skeleton, Eigen::MatrixXd& q) {
  for (int row = 3; row < skeleton.dof; ++row) {
    for (Eigen::Index t = 1; t < q.cols(); ++t) {
      q(row, t) = NearestTurn(q(row, t), q(row, t - 1));
    }
  }
}

}  // namespace

double Quantile(const Eigen::VectorXd& values, double share) {
  FOOTING_CHECK(values.size() > 0);
  return text::Quantile(std::vector<double>(values.data(), values.data() + values.size()), share);
}

motion::Motion Aligned(const motion::Motion& motion, const body::Landmarks& landmarks) {
  FOOTING_CHECK(motion.frames() > 0);
  const body::Skeleton& skeleton = motion.skeleton;
  body::Kinematics at(skeleton);
  Eigen::Matrix2Xd left_W(2, motion.frames()), feet_W_m(2, motion.frames());
  Eigen::VectorXd lowest_m(motion.frames());
  const auto toe = [&](Landmark end, Landmark ankle) {
    return landmarks[end] >= 0 ? landmarks[end] : landmarks[ankle];
  };
  const int left_toe = toe(Landmark::kLeftToe, Landmark::kLeftAnkle);
  const int right_toe = toe(Landmark::kRightToe, Landmark::kRightAnkle);
  const auto place = [&](int joint) { return at.p_WJ[static_cast<std::size_t>(joint)]; };
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    ComputeKinematics(skeleton, motion.q.col(t), at);
    left_W.col(t) =
        (place(landmarks[Landmark::kLeftHip]) - place(landmarks[Landmark::kRightHip])).head<2>();
    feet_W_m.col(t) = (place(landmarks[Landmark::kLeftAnkle]) + place(left_toe) +
                       place(landmarks[Landmark::kRightAnkle]) + place(right_toe))
                          .head<2>() /
                      4;
    lowest_m(t) = std::min(place(left_toe).z(), place(right_toe).z());
  }
  const Eigen::Vector2d left_mean_W = left_W.rowwise().mean();
  const double yaw_rad = std::atan2(-left_mean_W.x(), left_mean_W.y());  // Yaw of the facing.
  const Eigen::Matrix3d R = body::AxisRotation(body::Axis::kZ, -yaw_rad);
  const Eigen::Matrix2Xd feet_m = R.topLeftCorner<2, 2>() * feet_W_m;
  const Eigen::Vector3d origin_m(Quantile(feet_m.row(0), 0.5), Quantile(feet_m.row(1), 0.5),
                                 Quantile(lowest_m, kPartBelowFloor) - kToeAboveFloorM);

  motion::Motion aligned = motion;
  const body::Joint& root = skeleton.joint(0);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const Eigen::Matrix3d R_WJ = JointRotation(root, motion.q.col(t));
    if (t > 0) {  // The triple of angles nearest to the frame before.
      const auto turning = static_cast<Eigen::Index>(root.rotations.size());
      aligned.q.col(t).segment(root.first_dof, turning) =
          aligned.q.col(t - 1).segment(root.first_dof, turning);
    }
    SetJointRotation(root, R * R_WJ, aligned.q.col(t));
    aligned.q.col(t).head<3>() = R * motion.q.col(t).head<3>() - origin_m;
  }
  Unwrap(skeleton, aligned.q);
  return aligned;
}

namespace {

constexpr double kTPoseRateHz = 60;

/// The readings around a time, and how far it is from the first to the second; nothing when they
/// are further apart than `silence_s`.
template <typename Reading>
struct Around {
  const Reading* before = nullptr;
  const Reading* after = nullptr;
  double share = 0;
};

template <typename Reading>
std::optional<Around<Reading>> Find(const std::vector<Reading>& readings, double time_s,
                                    double silence_s) {
  const auto after =
      std::lower_bound(readings.begin(), readings.end(), time_s,
                       [](const Reading& reading, double at_s) { return reading.time_s < at_s; });
  if (after == readings.end()) return std::nullopt;
  if (after->time_s == time_s) return Around<Reading>{&*after, &*after, 0};
  if (after == readings.begin()) return std::nullopt;
  const auto before = after - 1;
  const double step_s = after->time_s - before->time_s;
  if (step_s > silence_s) return std::nullopt;
  return Around<Reading>{&*before, &*after, (time_s - before->time_s) / step_s};
}

}  // namespace

momentum::ContactLoads LoadsAt(const RecordedSession& session, double time_s) {
  momentum::ContactLoads loads;
  loads.time_s = time_s;
  for (std::size_t side = 0; side < momentum::kFeet; ++side) {
    momentum::FootLoads& foot = loads.feet[side];
    const auto& cells_W_m = session.cells_W_m[side];
    foot.count = cells_W_m.size();
    for (std::size_t k = 0; k < foot.count; ++k) {
      foot.cells[k].p_WS_m = {cells_W_m[k].x(), cells_W_m[k].y(), 0};
    }
    const auto around = Find(session.boards[side], time_s, kBoardSilenceS);
    if (!around) continue;
    foot.valid = true;
    for (std::size_t k = 0; k < foot.count; ++k) {
      foot.cells[k].load_n = (1 - around->share) * around->before->corners_n[k] +
                             around->share * around->after->corners_n[k];
    }
  }
  return loads;
}

std::optional<HandReading> HandAt(const RecordedSession& session, std::size_t side, double time_s) {
  const auto around = Find(session.hands[side], time_s, kHandSilenceS);
  if (!around) return std::nullopt;
  return HandReading{
      time_s, (1 - around->share) * around->before->p_W_m + around->share * around->after->p_W_m,
      (1 - around->share) * around->before->sd_m + around->share * around->after->sd_m};
}

std::optional<momentum::TPose> FindTPose(const RecordedSession& session) {
  momentum::TPoseCalibration calibration;
  const auto frames = static_cast<std::size_t>(session.duration_s * kTPoseRateHz);
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / kTPoseRateHz;
    if (calibration.Advance(LoadsAt(session, time_s), 1 / kTPoseRateHz))
      return calibration.result();
  }
  return std::nullopt;
}

ForceTrace TraceOf(const RecordedSession& session, double weight_n) {
  ForceTrace trace;
  trace.name = session.name;
  trace.weight_n = weight_n;
  const auto columns = static_cast<Eigen::Index>(session.duration_s * trace.rate_hz) + 1;
  trace.load_n.setZero(2, columns);
  trace.valid.assign(static_cast<std::size_t>(columns), false);
  for (Eigen::Index i = 0; i < columns; ++i) {
    const auto loads = LoadsAt(session, static_cast<double>(i) / trace.rate_hz);
    const bool valid = loads.feet[0].valid && loads.feet[1].valid;
    trace.valid[static_cast<std::size_t>(i)] = valid;
    if (i > 0) trace.load_n.col(i) = trace.load_n.col(i - 1);
    if (!valid) continue;
    for (std::size_t side = 0; side < momentum::kFeet; ++side) {
      trace.load_n(static_cast<Eigen::Index>(side), i) =
          momentum::PressureOf(loads.feet[side], 1).total_n;
    }
  }
  return trace;
}

}  // namespace footing::learning

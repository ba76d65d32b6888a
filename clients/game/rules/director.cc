#include "clients/game/rules/director.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/body/centre_line.h"

namespace footing::game {
namespace {

constexpr double kMostSlopeRad = 5 * kPi / 180;   // Section 8.2.
constexpr double kMostCurveRad = 15 * kPi / 180;  // Section 8.2.
constexpr double kMostStepM = 0.10;               // Section 8.2.
constexpr double kLeastLengthM = 2, kMostLengthM = 4;
constexpr double kPieceS = 1;
constexpr double kLeastPitM = 0.3, kMostPitM = 1.5;
constexpr double kMostHeadingRad = kPi / 2;

/// -1 to 1; 0 within the dead zone.
double ShareOf(double inclination_rad) {
  const double beyond_rad = std::fabs(inclination_rad) - kDeadZoneRad;
  if (!(beyond_rad > 0)) return 0;
  const double share = std::min(1.0, beyond_rad / (kFullRad - kDeadZoneRad));
  return std::copysign(share, inclination_rad);
}

/// The curve, cut so that the track goes on within 90 degrees of where it began.
double Bounded(double curve_rad, const stream::Track& track) {
  const double heading_rad = track.segments.back().heading_rad;
  return std::clamp(curve_rad, std::min(0.0, -kMostHeadingRad - heading_rad),
                    std::max(0.0, kMostHeadingRad - heading_rad));
}

}  // namespace

Piece Held(const Hand& hand, const stream::Track& track, double speed_mps, bool pits) {
  Piece piece;
  piece.length_m = std::clamp(kPieceS * speed_mps, kLeastLengthM, kMostLengthM);
  if (!hand.known) return piece;
  const bool after_pit = track.segments.back().pit;
  const double up = ShareOf(hand.pitch_rad);
  if (pits && hand.b && !after_pit) {
    piece.pit = true;
    piece.length_m = kLeastPitM + (kMostPitM - kLeastPitM) * std::max(0.0, up);
    return piece;
  }
  if (!after_pit) piece.curve_rad = Bounded(-kMostCurveRad * ShareOf(hand.roll_rad), track);
  (hand.a ? piece.step_m : piece.slope_rad) = up * (hand.a ? kMostStepM : kMostSlopeRad);
  return piece;
}

namespace {

constexpr double kAheadS = 3;
constexpr double kLeastAheadM = 6, kMostAheadM = 12;
/// A piece that does not show within this is lost: the next one goes out.
constexpr double kAnswerS = 1;

}  // namespace

double LookAheadM(double speed_mps) {
  return std::clamp(kAheadS * speed_mps, kLeastAheadM, kMostAheadM);
}

std::optional<Piece> Builder::Advance(const Sight& sight, const Hand& hand) {
  ghost_ = Held(plain_ ? Hand{} : hand, sight.track, sight.speed_mps, pits_);
  if (sent_s_) {
    const bool shown = sight.track.revision != sent_revision_;
    if (!shown && sight.time_s - *sent_s_ < kAnswerS) return std::nullopt;
    if (shown) plain_ = false;
    sent_s_.reset();
    ghost_ = Held(plain_ ? Hand{} : hand, sight.track, sight.speed_mps, pits_);
  }
  if (track::LengthOf(sight.track) - sight.distance_m >= LookAheadM(sight.speed_mps))
    return std::nullopt;
  sent_s_ = sight.time_s;
  sent_revision_ = sight.track.revision;
  return ghost_;
}

void Builder::OnRefused() {
  ++refused_;
  plain_ = true;
  sent_s_.reset();
}

void Builder::Restart() {
  sent_s_.reset();
  plain_ = false;
}

namespace {

/// A game has at most 20 rounds; more trials than this are not kept.
constexpr std::size_t kMostTrials = 64;
constexpr std::size_t kMostFaults = 1000;
constexpr double kSlackM = 1e-6;

/// The segments behind `end_m`.
void AddNew(const stream::Track& track, RoundFacts& facts) {
  double from_m = track.first_m;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    if (i > 0 && from_m > facts.end_m - kSlackM) {
      const stream::TrackSegment& before = track.segments[i - 1];
      facts.laid.push_back({from_m, segment.length_m, segment.slope_rad,
                            WrapAngle(segment.heading_rad - before.heading_rad),
                            segment.start_m.z() - stream::Following(before).start_m.z(),
                            segment.pit});
      facts.end_m = from_m + segment.length_m;
    }
    from_m += segment.length_m;
  }
}

}  // namespace

void Collector::OnFault(const Fault& fault) {
  const auto found = facts_.find(fault.trial);
  if (found == facts_.end()) return;
  auto& faults = found->second.faults;
  // One that is known may be withdrawn or restored at any time.
  const bool more = found->second.phase != stream::TrialPhase::kStopped;
  if (faults.contains(fault.number) || (more && faults.size() < kMostFaults)) {
    faults[fault.number] = fault;
  }
}

void Collector::OnTrial(const stream::TrialState& trial) {
  if (trial.trial.empty() || track_.segments.empty()) return;
  if (facts_.size() >= kMostTrials && !facts_.contains(trial.trial)) facts_.clear();
  RoundFacts& facts = facts_[trial.trial];
  if (facts.trial_number != trial.number || facts.end_m == 0) {
    facts = {};
    facts.trial_number = trial.number;
    facts.start_m = track_.start_m;
    facts.end_m = track::LengthOf(track_);
  }
  if (facts.phase == stream::TrialPhase::kStopped) return;
  AddNew(track_, facts);
  facts.phase = trial.progress.phase;
  facts.time_s = trial.progress.time_s;
  facts.farthest_m = std::max(facts.farthest_m, trial.progress.distance_m);
}

const RoundFacts* Collector::Find(const std::string& trial) const {
  const auto found = facts_.find(trial);
  return found == facts_.end() ? nullptr : &found->second;
}

namespace {

using stream::GamePhase;

constexpr double kPublishS = 0.1;
/// A command to footing-sim that has no effect within this is repeated or given up.
constexpr double kEffectS = 2;

std::string WaitsFor(const Frame& frame, const Hand& hand) {
  if (!hand.known) return "waiting for the builder's Wiimote, role editor";
  if (!frame.commanded) return "waiting for the runner's controllers";
  return "";
}

/// For a round that goes on.
std::string SilenceOf(const Frame& frame, const Hand& hand) {
  std::string note = hand.known ? "" : "the builder's Wiimote is silent: level ground";
  if (frame.commanded && !frame.runner_silent) return note;
  return note + (note.empty() ? "" : "; ") + "the runner's controllers are silent";
}

}  // namespace

Director::Director(GameOptions options) : options_(std::move(options)), builder_(options_.pits) {
  game_.host = options_.host;
  game_.phase = GamePhase::kWaiting;
  for (const std::string& name : options_.players) game_.players.push_back({name, 0});
  game_.rounds = static_cast<std::uint32_t>(options_.rounds);
  game_.pits = options_.pits;
}

void Director::Enter(GamePhase phase, double time_s, double lasts_s) {
  game_.phase = phase;
  game_.note.clear();
  game_.ghost.reset();
  entered_s_ = time_s;
  until_s_ = time_s + lasts_s;
  game_.left_s = lasts_s;
  published_s_ = -1e9;
}

void Director::Wait(const Frame& frame, const Hand& hand) {
  game_.note = WaitsFor(frame, hand);
  if (game_.note.empty()) Enter(GamePhase::kCountdown, frame.time_s, options_.countdown_s);
}

void Director::Begin(const Frame& frame, Orders& orders) {
  stream::GameRound round;
  round.runner = static_cast<std::uint32_t>(game_.results.size() % 2);
  round.trial = options_.id + "-" + std::to_string(++attempts_);
  orders.start_trial = round.trial;
  game_.results.push_back(std::move(round));
  trial_seen_ = false;
  asked_s_ = -1e9;
  builder_.Restart();
  Enter(GamePhase::kRound, frame.time_s, options_.round_s);
}

/// The round's trial has been stopped.
void Director::Finish(const Frame& frame, Orders& orders) {
  if (game_.results.size() < game_.rounds) {
    builder_.Restart();
    Enter(GamePhase::kPause, frame.time_s, options_.pause_s);
    return;
  }
  orders.start_trial = "after-" + game_.results.back().trial;
  orders.track = "endless";
  Enter(GamePhase::kOver, frame.time_s, 0);
}

/// The present round does not count; it is played again.
void Director::Void(const Frame& frame) {
  if (game_.phase == GamePhase::kRound) game_.results.pop_back();
  if (game_.phase != GamePhase::kOver) Enter(GamePhase::kWaiting, frame.time_s, 0);
}

void Director::Play(const Frame& frame, const Collector& seen, const Hand& hand, Orders& orders) {
  const std::string& trial = game_.results.back().trial;
  if (frame.trial.trial != trial) {
    if (trial_seen_ || frame.time_s - entered_s_ > kEffectS) Void(frame);
    return;
  }
  if (!std::exchange(trial_seen_, true)) Enter(GamePhase::kRound, frame.time_s, options_.round_s);
  if (frame.trial.progress.phase == stream::TrialPhase::kStopped) {
    // The game's connection was lost, and footing-sim took it for over.
    if (asked_s_ < entered_s_) return Void(frame);
    Finish(frame, orders);
    return;
  }
  if (game_.left_s <= 0) {
    game_.ghost.reset();
    if (frame.time_s - asked_s_ > kEffectS) {
      asked_s_ = frame.time_s;
      orders.stop_trial = trial;
    }
    return;
  }
  game_.note = SilenceOf(frame, hand);
  orders.append = builder_.Advance({frame.time_s, frame.trial.progress.distance_m,
                                    std::max(0.0, frame.commanded_speed_mps), seen.track()},
                                   hand);
  game_.ghost = track::Placed(builder_.ghost(), seen.track().segments.back());
  game_.ghost_curve_rad = builder_.ghost().curve_rad;
  game_.ghost_step_m = builder_.ghost().step_m;
}

/// All rounds again: a failure may be withdrawn after its round.
void Director::Count(const Collector& seen) {
  for (stream::GameRound& round : game_.results) {
    const RoundFacts* const facts = seen.Find(round.trial);
    if (facts == nullptr) continue;
    stream::GameRound counted = Score(*facts);
    counted.runner = round.runner;
    counted.trial = round.trial;
    round = std::move(counted);
  }
  AddUp(game_);
}

Orders Director::Advance(const Frame& frame, const Collector& seen, const Hand& hand) {
  Orders orders;
  // footing-sim has been started again.
  if (frame.time_s < time_s_) Void(frame);
  time_s_ = frame.time_s;
  game_.left_s = std::max(0.0, until_s_ - frame.time_s);
  const GamePhase before = game_.phase;
  switch (game_.phase) {
    case GamePhase::kWaiting:
      Wait(frame, hand);
      break;
    case GamePhase::kCountdown:
      if (!WaitsFor(frame, hand).empty()) {
        Enter(GamePhase::kWaiting, frame.time_s, 0);
      } else if (game_.left_s <= 0) {
        Begin(frame, orders);
      }
      break;
    case GamePhase::kRound:
      Play(frame, seen, hand, orders);
      break;
    case GamePhase::kPause:
      if (game_.left_s <= 0) Enter(GamePhase::kWaiting, frame.time_s, 0);
      break;
    case GamePhase::kOver:
    case GamePhase::kLeft:
    case GamePhase::kUnspecified:
      break;
  }
  const bool between = game_.phase == GamePhase::kWaiting || game_.phase == GamePhase::kCountdown ||
                       game_.phase == GamePhase::kPause;
  if (between && seen.track().extendable) {
    orders.append = builder_.Advance({frame.time_s, frame.trial.progress.distance_m,
                                      std::max(0.0, frame.commanded_speed_mps), seen.track()},
                                     {});
  }
  game_.refused = builder_.refused();
  orders.publish = game_.phase != before || frame.time_s - published_s_ >= kPublishS;
  if (orders.publish) {
    published_s_ = frame.time_s;
    Count(seen);
  }
  return orders;
}

namespace {

double BuilderPoints(stream::FailureCause cause) {
  switch (cause) {
    case stream::FailureCause::kSimulation:
    case stream::FailureCause::kTransition:
      return kPointsPerFall;
    case stream::FailureCause::kCurve:
    case stream::FailureCause::kStraightness:
      return kPointsPerExit;
    case stream::FailureCause::kJump:
      return kPointsPerPit;
    case stream::FailureCause::kUnspecified:
      return 0;
  }
  return 0;
}

/// Index of the laid segment at a distance; -1 before the first one.
int StretchAt(const RoundFacts& facts, double distance_m) {
  int found = -1;
  for (const Stretch& stretch : facts.laid) {
    if (stretch.from_m > distance_m) break;
    ++found;
  }
  return found;
}

}  // namespace

double DifficultyOf(const Stretch& stretch) {
  if (stretch.pit) return 1 + stretch.length_m / 1.5;
  return std::fabs(stretch.slope_rad) / DegreesToRadians(5) +
         std::fabs(stretch.curve_rad) / DegreesToRadians(15) + std::fabs(stretch.step_m) / 0.10;
}

stream::GameRound Score(const RoundFacts& facts) {
  stream::GameRound round;
  round.time_s = facts.time_s;
  round.distance_m = std::max(0.0, facts.farthest_m - facts.start_m);
  round.segments_laid = static_cast<std::uint32_t>(facts.laid.size());
  std::map<int, int> failures;  // By index of the segment; -1: the start, which nobody laid.
  int counted = 0;
  for (const auto& [number, fault] : facts.faults) {
    if (fault.withdrawn) continue;
    if (std::uint64_t* const count = stream::MutableCountOf(fault.cause, round.failures)) ++*count;
    const int index = StretchAt(facts, fault.distance_m);
    const int before = failures[index]++;
    if (before >= kMostFailuresThatCount) continue;
    ++counted;
    if (index >= 0) {
      round.builder_points += BuilderPoints(fault.cause) * (before == 0 ? 1 : kSecondShare);
    }
  }
  for (std::size_t i = 0; i < facts.laid.size(); ++i) {
    const Stretch& stretch = facts.laid[i];
    const bool behind = stretch.from_m + stretch.length_m <= facts.farthest_m;
    if (!behind || failures.contains(static_cast<int>(i))) continue;
    ++round.segments_passed;
    round.difficulty += DifficultyOf(stretch);
  }
  const double points = kPointsPerM * round.distance_m + kPointsPerFailure * counted +
                        kPointsPerDifficulty * round.difficulty;
  round.runner_points = std::round(std::max(0.0, points));
  round.builder_points = std::round(round.builder_points);
  return round;
}

void AddUp(stream::GameState& game) {
  for (std::size_t i = 0; i < game.players.size(); ++i) {
    game.players[i].points = 0;
    for (const stream::GameRound& round : game.results) {
      game.players[i].points += round.runner == i ? round.runner_points : round.builder_points;
    }
  }
}

}  // namespace footing::game

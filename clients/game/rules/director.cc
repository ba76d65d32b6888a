#include "clients/game/rules/director.h"

#include <algorithm>
#include <utility>

#include "clients/game/rules/scoring.h"

namespace footing::game {
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

}  // namespace footing::game

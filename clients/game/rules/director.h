#pragma once

#include <array>
#include <optional>
#include <string>

#include "clients/game/rules/builder.h"
#include "clients/game/rules/facts.h"
#include "common/stream/game.h"

namespace footing::game {

struct GameOptions {
  std::string host = "footing-game";
  std::string id = "game";                           ///< Prefix of the trials' ids.
  std::array<std::string, 2> players{"Ann", "Ben"};  ///< The first one runs first.
  int rounds = 2;
  double round_s = 60;
  double countdown_s = 5;
  double pause_s = 8;  ///< To change the controllers over.
  bool pits = false;
};

/// One frame of footing-sim.
struct Frame {
  double time_s = 0;  ///< Simulation time.
  double commanded_speed_mps = 0;
  bool commanded = false;      ///< The runner's features arrive.
  bool runner_silent = false;  ///< A device that the runner's interface needs sends nothing.
  stream::TrialState trial;
};

/// What is to be sent to footing-sim.
struct Orders {
  std::string start_trial;      ///< Id; empty: none.
  std::string track = "build";  ///< Of start_trial.
  std::string stop_trial;
  std::optional<Piece> append;
  bool publish = false;  ///< game() has changed enough to be shown.
};

/// Leads a game from its first round to its last: waits for both players, counts down, starts the
/// round's trial on the track "build", lays what the builder holds, stops the trial when the time
/// is over, lets the players change parts. Between the rounds it lays level ground, and at the end
/// it puts the character on the track "endless", so that nobody runs into the void. Time is
/// simulation time.
class Director {
 public:
  explicit Director(GameOptions options);

  /// Moves on to the next frame, which `seen` has taken in.
  Orders Advance(const Frame& frame, const Collector& seen, const Hand& hand);
  /// footing-sim refused a segment, or the track did not take it.
  void OnRefused() { builder_.OnRefused(); }

  const stream::GameState& game() const { return game_; }

 private:
  void Enter(stream::GamePhase phase, double time_s, double lasts_s);
  void Wait(const Frame& frame, const Hand& hand);
  void Begin(const Frame& frame, Orders& orders);
  void Play(const Frame& frame, const Collector& seen, const Hand& hand, Orders& orders);
  void Void(const Frame& frame);
  void Finish(const Frame& frame, Orders& orders);
  void Count(const Collector& seen);

  GameOptions options_;
  Builder builder_;
  stream::GameState game_;
  int attempts_ = 0;      ///< Trials started so far.
  double entered_s_ = 0;  ///< The phase.
  double until_s_ = 0;    ///< Its end.
  bool trial_seen_ = false;
  double asked_s_ = -1e9;  ///< When the trial's end was asked for.
  double time_s_ = 0;      ///< Of the last frame.
  double published_s_ = -1e9;
};

}  // namespace footing::game

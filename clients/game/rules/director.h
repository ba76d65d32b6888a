#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/body/centre_line.h"
#include "common/stream/game.h"
#include "common/stream/track.h"
#include "common/stream/trial.h"

/// The terrain editor (gait paper, section 8.2 and figure 13): "create a slope by inclining the
/// Wiimote vertically, a curve by inclining the Wiimote sideways, and a step by pushing button A
/// and inclining the Wiimote vertically"; the terrain is 4 m wide, slopes are within 5 degrees,
/// curves within 15 degrees, steps within 10 cm. How the inclination is scaled to these limits, and
/// how long a segment is, the paper does not say.
namespace footing::game {

/// Input of the builder: the device of the role editor.
struct Hand {
  bool known = false;    ///< False: nothing has come from it for a while; the ground stays level.
  double roll_rad = 0;   ///< Left side higher is positive: inclined to the right.
  double pitch_rad = 0;  ///< Front higher is positive.
  bool a = false;        ///< Button A is held: a step in place of a slope.
  bool b = false;        ///< Button B is held: a pit, where pits are allowed.
};

using track::Piece;

/// Inclinations within this are level, rad: nobody holds a hand quite still.
inline constexpr double kDeadZoneRad = 0.105;  // 6 degrees.
/// Inclination from which on a property is at its limit, rad; below, it grows evenly.
inline constexpr double kFullRad = 0.785;  // 45 degrees: the wrist goes no further at ease.

/// The piece that the hand asks for at the track's end: within the paper's limits, and one that an
/// extendable track takes. Curves do not turn the track by more than 90 degrees from its start's
/// direction, so that it never runs into itself; after a pit come neither a pit nor a curve. Its
/// length is the way of about 1 s at `speed_mps`, within 2 and 4 m. `track` is not empty.
Piece Held(const Hand& hand, const stream::Track& track, double speed_mps, bool pits);

/// Decides when a piece is laid: as soon as less track lies ahead of the runner than three seconds
/// of running (6 to 12 m), so that ground always lies ahead and the builder still decides late.
/// The piece that the hand holds then is laid, as the ghost showed it.
class Builder {
 public:
  /// State of the runner and the track at one instant.
  struct Sight {
    double time_s = 0;      ///< Simulation time.
    double distance_m = 0;  ///< Runner's distance along the track.
    double speed_mps = 0;
    const stream::Track& track;  ///< As published last; not empty.
  };

  explicit Builder(bool pits) : pits_(pits) {}

  /// The piece to append now; nothing while enough lies ahead, or while one is on its way.
  std::optional<Piece> Advance(const Sight& sight, const Hand& hand);
  /// The track did not take the last piece: a plain one follows, whatever the hand holds.
  void OnRefused();
  /// A new track: what was on its way is void.
  void Restart();

  /// Segment that would be laid now.
  const Piece& ghost() const { return ghost_; }
  std::uint32_t refused() const { return refused_; }

 private:
  bool pits_;
  Piece ghost_;
  std::optional<double> sent_s_;     ///< When a piece went out that has not shown yet.
  std::uint64_t sent_revision_ = 0;  ///< Revision of the track at that time.
  bool plain_ = false;
  std::uint32_t refused_ = 0;
};

/// How much track is kept ahead of a runner of that speed, m.
double LookAheadM(double speed_mps);

/// Failure as its event reports it. This and the following facts of a round are published by
/// footing-sim; scores depend on nothing else, and a recording holds the same.
struct Fault {
  std::uint64_t number = 0;
  stream::FailureCause cause = stream::FailureCause::kUnspecified;
  std::string trial;
  double distance_m = 0;  ///< Along the track.
  bool withdrawn = false;
};

/// A segment that the builder laid.
struct Stretch {
  double from_m = 0;  ///< Along the track.
  double length_m = 0;
  double slope_rad = 0;
  double curve_rad = 0;
  double step_m = 0;
  bool pit = false;
};

/// One trial of a track that grows.
struct RoundFacts {
  std::uint64_t trial_number = 0;
  stream::TrialPhase phase = stream::TrialPhase::kUnspecified;
  double start_m = 0;     ///< Position of the start line.
  double end_m = 0;       ///< End of the track, so far.
  double farthest_m = 0;  ///< Along the track.
  double time_s = 0;
  std::vector<Stretch> laid;
  std::map<std::uint64_t, Fault> faults;  ///< By number, as they count now.
};

/// Collects the facts of every trial that has an id, from ticks in their order. The track of a new
/// trial comes with the tick of its first state, or before it. What happens after a trial was
/// stopped belongs to no round, but for corrections of its failures.
class Collector {
 public:
  void OnTrack(const stream::Track& track) { track_ = track; }
  void OnFault(const Fault& fault);
  /// After the track and the faults of its tick.
  void OnTrial(const stream::TrialState& trial);

  const stream::Track& track() const { return track_; }
  /// Null for a trial that has not been seen.
  const RoundFacts* Find(const std::string& trial) const;

 private:
  stream::Track track_;
  std::map<std::string, RoundFacts> facts_;  ///< By id of the trial.
};

/// Options of a terrain game. The players change parts after every round.
struct GameOptions {
  std::string host = "footing-game";
  std::string id = "game";                           ///< Prefix of the trials' ids.
  std::array<std::string, 2> players{"Ann", "Ben"};  ///< The first one runs first.
  int rounds = 2;
  double round_s = 60;
  double countdown_s = 5;
  double pause_s = 8;  ///< Pause in which the players swap controllers.
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

/// Commands to send to footing-sim.
struct Orders {
  std::string start_trial;      ///< Id; empty: none.
  std::string track = "build";  ///< Track of start_trial.
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
  double time_s_ = 0;      ///< Simulation time of the last frame.
  double published_s_ = -1e9;
};

// Points, from published facts alone. The paper had no score; docs/game.md has the rules.

/// Points of the runner.
inline constexpr double kPointsPerM = 1;
inline constexpr double kPointsPerFailure = -5;
inline constexpr double kPointsPerDifficulty = 3;
/// Points of the builder for the first failure on one of their segments: a fall, and leaving the
/// ribbon. Pits are not part of the paper's game, and easier to lay than to clear.
inline constexpr double kPointsPerFall = 10;
inline constexpr double kPointsPerExit = 8;
inline constexpr double kPointsPerPit = 5;
/// A second failure on one segment counts half for the builder; one more counts for nobody, since
/// what fails three times cannot be passed.
inline constexpr double kSecondShare = 0.5;
inline constexpr int kMostFailuresThatCount = 2;

/// 0 for level straight ground; each of slope, curve and step adds 1 at its limit, a pit adds 1
/// and its length over 1.5 m.
double DifficultyOf(const Stretch& stretch);

/// The round's points, in whole numbers, and what they come from. The runner has at least 0.
stream::GameRound Score(const RoundFacts& facts);

/// Adds up the players' points over the results.
void AddUp(stream::GameState& game);

}  // namespace footing::game

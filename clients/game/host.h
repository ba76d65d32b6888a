#pragma once

#include <string>

#include "clients/game/rules/director.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/recording/recorded_session.h"
#include "common/stream/game.h"
#include "footing/v1/command.pb.h"
#include "footing/v1/session.pb.h"

/// The terrain game as this program leads it, its report, and the conversion between the game's
/// rules and the messages of the protocol.
namespace footing::game {

/// Takes in what a tick of footing-sim reports of trials.
void Take(const v1::Tick& tick, Collector& collector);

/// The tick's last word on the device of the role editor, of the first rig by name whose editor
/// sends samples; `hand` stays where the tick says nothing. True when the tick knows how it is
/// inclined.
bool Take(const v1::Tick& tick, std::uint32_t& device, Hand& hand);

/// State of the character in a tick of footing-sim.
Frame FrameOf(const v1::Tick& tick);

/// Command that appends the piece to the track.
v1::Command ToCommand(const Piece& piece);

/// Result of a game so far.
struct Report {
  stream::GameState game;
  std::uint64_t slopes = 0, curves = 0, steps = 0, pits = 0;  ///< Segments laid that have one.
  double seconds = 0;
};

/// Counts the segments of the game's rounds by what they are.
Report MakeReport(const stream::GameState& game, const Collector& seen, double seconds);

/// Report as one JSON object.
std::string ToJson(const Report& report);

/// The game in one line: "round 1 of 2  12 s left  Ann runs 23.4 m ...".
std::string ToLine(const stream::GameState& game);

/// Each round and the winner, a line each.
std::string ToText(const Report& report);

/// The last game of a recording, as published, and with its scores counted again from what
/// footing-sim published beside them.
struct Recount {
  Report published;
  Report counted;
  bool equal = false;  ///< Those of all rounds that ended are, to the last bit.
};

/// InvalidData when the recording has no game.
Result<Recount> RecountGame(const recording::RecordedSession& session);

/// Options of a terrain game that is led by this program.
struct HostOptions {
  GameOptions game;
  transport::Address sensor;      ///< footingd: the builder's device.
  transport::Address simulation;  ///< footing-sim.
  double seconds = 0;             ///< Ends by itself after this; 0: when the game is over.
  bool text = true;               ///< A line a second on standard output; else on standard error.
};

/// Leads a game to its end, Ctrl-C, or options.seconds. Fails when footing-sim refuses it (another
/// one is led there, or its track cannot be extended) or never came.
Result<Report> RunGame(const HostOptions& options);

}  // namespace footing::game

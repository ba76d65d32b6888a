#pragma once

#include "clients/game/rules/director.h"
#include "clients/game/rules/facts.h"
#include "clients/game/rules/piece.h"
#include "footing/v1/command.pb.h"
#include "footing/v1/session.pb.h"

/// Between the game's rules and the messages of the protocol.
namespace footing::game {

/// Takes in what a tick of footing-sim reports of trials.
void Take(const v1::Tick& tick, Collector& collector);

/// The tick's last word on the device of the role editor, of the first rig by name whose editor
/// sends samples; `hand` stays where the tick says nothing. True when the tick knows how it is
/// inclined.
bool Take(const v1::Tick& tick, std::uint32_t& device, Hand& hand);

/// What a tick of footing-sim with a character reports of it.
Frame FrameOf(const v1::Tick& tick);

v1::Command ToCommand(const Piece& piece);

}  // namespace footing::game

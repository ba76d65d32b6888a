#pragma once

#include <string>

#include "clients/game/report.h"
#include "clients/game/rules/director.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::game {

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

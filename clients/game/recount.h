#pragma once

#include <string>

#include "clients/game/report.h"
#include "common/recording/recorded_session.h"
#include "common/base/result.h"

namespace footing::game {

/// The last game of a recording, as published, and with its scores counted again from what
/// footing-sim published beside them.
struct Recount {
  Report published;
  Report counted;
  bool equal = false;  ///< Those of all rounds that ended are, to the last bit.
};

/// InvalidData when the recording has no game.
Result<Recount> RecountGame(const recording::RecordedSession& session);

}  // namespace footing::game

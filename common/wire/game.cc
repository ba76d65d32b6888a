#include "common/wire/fields.h"

namespace footing::wire {

template <typename Way>
void Fields(Way way, const stream::GamePlayer&) {
  FOOTING_FIELD(name);
  FOOTING_FIELD(points);
}
FOOTING_BOTH_WAYS(GamePlayer)

template <typename Way>
void Fields(Way way, const stream::GameRound&) {
  FOOTING_FIELD(runner);
  FOOTING_FIELD(trial);
  FOOTING_FIELD(time_s);
  FOOTING_FIELD(distance_m);
  FOOTING_MESSAGE(failures);
  FOOTING_FIELD(segments_laid);
  FOOTING_FIELD(segments_passed);
  FOOTING_FIELD(difficulty);
  FOOTING_FIELD(runner_points);
  FOOTING_FIELD(builder_points);
}
FOOTING_BOTH_WAYS(GameRound)

template <typename Way>
void Fields(Way way, const stream::GameState&) {
  FOOTING_FIELD(host);
  FOOTING_ENUM_AS(GameState_Phase, GamePhase, phase, phase);
  FOOTING_FIELD(left_s);
  FOOTING_REPEATED(players);
  FOOTING_FIELD(rounds);
  FOOTING_REPEATED(results);
  FOOTING_OPTIONAL(ghost);
  FOOTING_FIELD(ghost_curve_rad);
  FOOTING_FIELD(ghost_step_m);
  FOOTING_FIELD(refused);
  FOOTING_FIELD(note);
  FOOTING_FIELD(pits);
}
FOOTING_BOTH_WAYS(GameState)

}  // namespace footing::wire

#include "clients/game/recount.h"

#include <optional>

#include "clients/game/messages.h"
#include "clients/game/rules/scoring.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::game {
namespace {

bool Equal(const stream::GameRound& a, const stream::GameRound& b) {
  return a.runner_points == b.runner_points && a.builder_points == b.builder_points &&
         a.distance_m == b.distance_m && a.failures == b.failures &&
         a.segments_laid == b.segments_laid && a.segments_passed == b.segments_passed;
}

}  // namespace

Result<Recount> RecountGame(const recording::RecordedSession& session) {
  const recording::RecordedServer* const server = session.Find("footing-sim");
  if (server == nullptr) return InvalidData(session.path() + " holds no ticks of footing-sim");
  Collector seen;
  std::optional<stream::GameState> game;
  std::int64_t first_ns = 0, last_ns = 0;
  for (const recording::RecordedTick& recorded : server->ticks) {
    const auto tick = recording::ReadTick(
        recorded, {v1::Tick::kTrackFieldNumber, v1::Tick::kEventsFieldNumber,
                   v1::Tick::kCharactersFieldNumber, v1::Tick::kGameFieldNumber});
    if (!tick) return tick.error();
    Take(*tick, seen);
    if (!tick->has_game()) continue;
    stream::GameState next = wire::FromProto(tick->game());
    if (const char* why = stream::WhyNotAGame(next); why != nullptr) {
      return InvalidData(session.path() + ", game: " + why);
    }
    if (!game) first_ns = recorded.host_ns;
    last_ns = recorded.host_ns;
    game = std::move(next);
  }
  if (!game) return InvalidData(session.path() + " holds no terrain game");
  const double seconds = NanosecondsToSeconds(last_ns - first_ns);
  Recount recount;
  recount.published = MakeReport(*game, seen, seconds);
  recount.equal = true;
  for (stream::GameRound& round : game->results) {
    const RoundFacts* const facts = seen.Find(round.trial);
    // Of a round that was broken off, what is published is a moment old.
    if (facts != nullptr && facts->phase != stream::TrialPhase::kStopped) continue;
    stream::GameRound counted = facts == nullptr ? stream::GameRound() : Score(*facts);
    counted.runner = round.runner;
    counted.trial = round.trial;
    recount.equal = recount.equal && Equal(counted, round);
    round = std::move(counted);
  }
  AddUp(*game);
  recount.counted = MakeReport(*game, seen, seconds);
  return recount;
}

}  // namespace footing::game

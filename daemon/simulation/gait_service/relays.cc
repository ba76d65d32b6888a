#include "daemon/simulation/gait_service/relays.h"

#include <cmath>
#include <utility>

#include "common/wire/wire.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

using serving::Answer;

constexpr std::size_t kMostTextBytes = 400;

}  // namespace

v1::CommandResult StudyRelay::OnSetStudy(const transport::SessionInfo& who,
                                         const v1::SetStudy& message) {
  stream::StudyState study = wire::FromProto(message.study());
  for (const std::string* text : {&study.study, &study.participant, &study.interface, &study.phase,
                                  &study.doing, &study.next, &study.keys}) {
    if (text->size() > kMostTextBytes) {
      return Answer(false, "set_study: a text has more than 400 bytes");
    }
  }
  if (!std::isfinite(study.left_s) || !std::isfinite(study.active_s)) {
    return Answer(false, "set_study: every number must be finite");
  }
  session_ = who.session;
  study_ = std::move(study);
  changed_ = true;
  return Answer(true, "");
}

void StudyRelay::OnSessionEnd(const transport::SessionInfo& who) {
  if (session_ == 0 || session_ != who.session) return;
  session_ = 0;
  study_ = {};
  changed_ = true;
}

std::optional<stream::StudyState> StudyRelay::TakeChange() {
  if (!std::exchange(changed_, false)) return std::nullopt;
  return study_;
}

v1::CommandResult GameRelay::OnSetGame(const transport::SessionInfo& who,
                                       const v1::SetGame& message) {
  if (leader_ != 0 && leader_ != who.session) {
    return Answer(false, "set_game: " + game_.host +
                             " leads a terrain game; watch it with footing-view, or end that one");
  }
  if (message.leave()) {
    if (leader_ == who.session) Leave();
    return Answer(true, "");
  }
  stream::GameState game = wire::FromProto(message.game());
  if (game.host.empty()) game.host = who.client_name;
  if (const char* why = stream::WhyNotAGame(game); why != nullptr) {
    return Answer(false, std::string("set_game: ") + why);
  }
  leader_ = who.session;
  game_ = std::move(game);
  changed_ = true;
  return Answer(true, "");
}

void GameRelay::OnSessionEnd(const transport::SessionInfo& who) {
  if (leader_ != 0 && leader_ == who.session) Leave();
}

/// A game that was played to its end stays as it is.
void GameRelay::Leave() {
  leader_ = 0;
  if (game_.phase != stream::GamePhase::kOver) {
    game_.phase = stream::GamePhase::kLeft;
    left_ = true;
  }
  game_.ghost.reset();
  game_.left_s = 0;
  changed_ = true;
}

std::optional<v1::CommandResult> GameRelay::Refuse(const transport::SessionInfo& who,
                                                   const v1::Command& command) const {
  if (leader_ == 0 || leader_ == who.session) return std::nullopt;
  if (!command.has_append_segment() && !command.has_start_trial() && !command.has_stop_trial()) {
    return std::nullopt;
  }
  return Answer(false,
                game_.host + " leads a terrain game: only it changes the track; end it first");
}

bool GameRelay::TakeLeft() { return std::exchange(left_, false); }

std::optional<stream::GameState> GameRelay::TakeChange() {
  if (!std::exchange(changed_, false)) return std::nullopt;
  return game_;
}

}  // namespace footing::gait_service

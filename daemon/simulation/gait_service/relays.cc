#include "daemon/simulation/gait_service/relays.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/wire/wire.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

using serving::Answer;

constexpr std::size_t kMostTextBytes = 400;
constexpr std::int64_t kCountEveryNs = 1'000'000'000;
/// Rest of a countdown that has ended: 0 would be none at all, and screens show its end.
constexpr double kEndedS = 0.001;

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

std::optional<stream::StudyState> StudyRelay::TakeChange(std::int64_t now_ns) {
  if (std::exchange(changed_, false)) {
    begun_ns_ = sent_ns_ = now_ns;
    return study_;
  }
  const bool counts = NanosecondsToSeconds(sent_ns_ - begun_ns_) < study_.left_s;
  if (!counts || now_ns - sent_ns_ < kCountEveryNs) return std::nullopt;
  sent_ns_ = now_ns;
  stream::StudyState now = study_;
  now.left_s = std::max(study_.left_s - NanosecondsToSeconds(now_ns - begun_ns_), kEndedS);
  return now;
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

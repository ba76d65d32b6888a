#include "daemon/simulation/gait_service/study_relay.h"

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

}  // namespace footing::gait_service

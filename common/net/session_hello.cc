#include <unistd.h>

#include <utility>

#include "common/runtime/clock.h"
#include "common/net/session.h"

/// The part of Session that lets a client in.
namespace footing::transport {

void Session::OnHello(const v1::Hello& hello) {
  const Caller caller{peer_, connection_.secured(), connection_.peer_fingerprint()};
  auto admission = Admit(shared_.options, {geteuid(), getegid()}, caller, hello, shared_.NowNs(),
                         shared_.admission);
  if (const auto* why = std::get_if<NotAdmitted>(&admission)) {
    if (why->lack != Lack::kNone) shared_.SayDenied(peer_.host, why->lack, why->lack_text);
    if (!why->waits) return Refused(why->answer.reason(), why->answer.message());
    phase_ = Phase::kGuessed;
    guess_answer_ = why->answer.message();
    return ArmTimer(shared_.options.wrong_token_wait_s);
  }
  admitted_ = std::get<Admitted>(std::move(admission));
  info_.client_name = admitted_.client_name;
  info_.role = admitted_.role;
  phase_ = Phase::kWelcomed;
  v1::Envelope message;
  *message.mutable_welcome() = MakeWelcome(shared_.options, shared_.epoch, info_.role);
  message.mutable_welcome()->set_host_ns(shared_.NowNs());
  message.mutable_welcome()->set_wall_time_ns(clock::WallNs());
  Send(message);
  ArmTimer(shared_.options.ping_interval_s);
}

void Session::GiveWay(const std::string& message) {
  if (guessing()) return AnswerGuess();
  Refused(v1::Refused::REASON_TOO_MANY_SESSIONS, message);
}

void Session::AnswerGuess() { Refused(v1::Refused::REASON_TOKEN, guess_answer_); }

}  // namespace footing::transport

#include <unistd.h>

#include <utility>

#include "common/clock/clock.h"
#include "common/transport/session.h"

/// The part of Session that lets a client in.
namespace footing::transport {

void Session::OnHello(const v1::Hello& hello) {
  const Caller caller{peer_, connection_.secured(), connection_.peer_fingerprint()};
  auto admission = Admit(shared_.options, {geteuid(), getegid()}, caller, hello, shared_.NowNs(),
                         shared_.admission);
  if (const auto* why = std::get_if<NotAdmitted>(&admission)) {
    if (!why->proof.empty()) shared_.SayDenied(peer_.host, why->proof);
    return Refused(why->answer.reason(), why->answer.message());
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

}  // namespace footing::transport

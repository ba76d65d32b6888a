#include "clients/study/session/held_lease.h"

#include <chrono>
#include <utility>

#include "footing/v1/command.pb.h"

namespace footing::study {
namespace {

// Five renewals fit into a lease: none is lost by one slow answer.
constexpr std::uint32_t kLeaseMs = 5000;
constexpr auto kAskAgain = std::chrono::milliseconds(1000);

}  // namespace

HeldLease::HeldLease(boost::asio::io_context& io, transport::Client& client, std::string holder)
    : timer_(io), client_(client), holder_(std::move(holder)) {}

void HeldLease::OnState(transport::LinkState state) {
  const bool connected =
      state == transport::LinkState::kLive || (connected_ && state == transport::LinkState::kStale);
  if (connected == connected_) return;
  connected_ = connected;
  // A new connection is another session, perhaps of a server that was restarted. Answers that
  // the lost connection has failed are forgotten here, too.
  state_ = State::kNone;
  refusal_.clear();
  timer_.cancel();
  if (connected_ && wanted_) Ask();
}

void HeldLease::Hold() {
  if (wanted_) return;
  wanted_ = true;
  ++hold_;
  if (connected_) Ask();
}

void HeldLease::Ask() {
  if (lost()) return;
  v1::Command command;
  command.set_deadline_ms(kLeaseMs);
  v1::TakeLease& take = *command.mutable_take_lease();
  take.set_holder(holder_);
  take.set_seconds(kLeaseMs * 1e-3);
  take.set_renew_only(held());
  client_.Send(std::move(command),
               [weak = weak_from_this(), hold = hold_](const v1::CommandResult& answer) {
                 if (const auto self = weak.lock()) self->OnAnswer(hold, answer);
               });
  AskLater();
}

void HeldLease::AskLater() {
  timer_.expires_after(kAskAgain);
  timer_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
    const auto self = weak.lock();
    if (!error && self && self->connected_) self->Ask();
  });
}

void HeldLease::OnAnswer(std::uint64_t hold, const v1::CommandResult& answer) {
  if (!wanted_ || hold != hold_) return;
  if (answer.ok()) {
    state_ = State::kHeld;
  } else {
    state_ = held() || lost() ? State::kLost : State::kRefused;
  }
  refusal_ = answer.message();
}

void HeldLease::Release(std::function<void()> done) {
  timer_.cancel();
  wanted_ = false;
  state_ = State::kNone;
  refusal_.clear();
  v1::Command command;
  command.mutable_release_lease();
  client_.Send(std::move(command), [done = std::move(done)](const v1::CommandResult&) { done(); });
}

}  // namespace footing::study

#include "clients/study/session/server_link.h"

#include <chrono>
#include <optional>
#include <utility>

#include "common/base/units.h"
#include "common/runtime/clock.h"
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
  timer_.After(kAskAgain, [this] {
    const auto self = shared_from_this();  // A handler may let the lease go.
    if (connected_) Ask();
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

namespace {

constexpr std::uint32_t kQueueTicks = 1024;
// A client dials again within 1 s; a server that is not there by then has a fault of its own.
constexpr double kBackWithinS = 4;

transport::ClientOptions ClientOf(const ServerLinkOptions& options) {
  transport::ClientOptions client;
  client.address = options.address;
  client.client_name = "footing-study";
  client.role = v1::ROLE_CONTROL;
  client.channels = options.channels;
  // Reliable: a failure that is missed would not be counted.
  client.policy = v1::QUEUE_POLICY_RELIABLE;
  client.queue_ticks = kQueueTicks;
  return client;
}

}  // namespace

class ServerLink::Implementation {
 public:
  Implementation(Console& console, ServerLinkOptions options, ServerLinkHandlers handlers)
      : console_(console),
        name_(options.server + " at " + options.address.Text()),
        handlers_(std::move(handlers)),
        client_(console.io(), ClientOf(options), Handlers()),
        lease_(std::make_shared<HeldLease>(console.io(), client_, options.holder)) {
    client_.Start();
  }
  ~Implementation() { client_.Stop(); }

  transport::ClientHandlers Handlers() {
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { handlers_.on_tick(tick); };
    handlers.on_gap = [this](const v1::Gap& gap) {
      ticks_lost_ = ticks_lost_ || gap.reason() == v1::Gap::REASON_RING_PASSED;
    };
    handlers.on_welcome = [this](const v1::Welcome& welcome) {
      restarted_ = restarted_ || (epoch_ && *epoch_ != welcome.epoch());
      epoch_ = welcome.epoch();
    };
    handlers.on_state = [this](transport::LinkState state, const std::string& why) {
      OnState(state, why);
    };
    handlers.on_notice = [this](const v1::Notice& notice) {
      console_.Print("Notice of " + name_ + ": " + notice.text());
    };
    return handlers;
  }

  void OnState(transport::LinkState state, const std::string& why) {
    const bool was_live = std::exchange(state_, state) == transport::LinkState::kLive;
    why_ = why;
    const bool live = state == transport::LinkState::kLive;
    if (was_live && !live) {
      down_ns_ = clock::MonotonicNs();
      ++breaks_;
      handlers_.on_down();
    }
    if (live && breaks_ > 0 && down_ns_) {
      console_.Print(name_ + ": connected again");
      down_ns_.reset();
    }
    lease_->OnState(state);
  }

  bool up() const {
    return state_ == transport::LinkState::kLive && (!lease_->wanted() || lease_->held());
  }

  bool broken() const {
    if (restarted_ || ticks_lost_ || lease_->lost()) return true;
    return down_ns_ && NanosecondsToSeconds(clock::MonotonicNs() - *down_ns_) > kBackWithinS;
  }

  Console& console_;
  std::string name_;
  ServerLinkHandlers handlers_;
  transport::LinkState state_ = transport::LinkState::kConnecting;
  std::string why_ = "not connected";
  std::optional<std::int64_t> down_ns_;  ///< Since when it is down, once it was up.
  std::optional<std::uint64_t> epoch_;
  bool restarted_ = false;
  bool ticks_lost_ = false;
  std::uint64_t breaks_ = 0;
  transport::Client client_;
  std::shared_ptr<HeldLease> lease_;
};

ServerLink::ServerLink(Console& console, ServerLinkOptions options, ServerLinkHandlers handlers)
    : implementation_(
          std::make_unique<Implementation>(console, std::move(options), std::move(handlers))) {}
ServerLink::~ServerLink() = default;

transport::Client& ServerLink::client() { return implementation_->client_; }
HeldLease& ServerLink::lease() { return *implementation_->lease_; }
const HeldLease& ServerLink::lease() const { return *implementation_->lease_; }
const std::string& ServerLink::name() const { return implementation_->name_; }

std::string ServerLink::Text() const {
  const Implementation& own = *implementation_;
  const std::string& refusal = own.lease_->refusal();
  return own.name_ + ": " + own.why_ + (own.restarted_ ? ", it was started again" : "") +
         (own.ticks_lost_ ? ", ticks are missing" : "") + (refusal.empty() ? "" : "; " + refusal);
}

bool ServerLink::refused() const {
  return implementation_->state_ == transport::LinkState::kRefused;
}

bool ServerLink::up() const { return implementation_->up(); }
bool ServerLink::broken() const { return implementation_->broken(); }
std::uint64_t ServerLink::breaks() const { return implementation_->breaks_; }

}  // namespace footing::study

#include "clients/ctl/connection.h"

#include <boost/asio/io_context.hpp>
#include <optional>
#include <utility>

#include "clients/ctl/report/device_table.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/runtime/clock.h"
#include "common/runtime/service_manager.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

constexpr std::uint32_t kQueueTicks = 512;

/// Remedy when no footingd answers; `link` says why.
std::string Remedy(const std::string& link) {
  // Something answers: a server that is started would not help, and the link says what would.
  if (link.find("does not speak TLS") != std::string::npos) return "";
  return transport::RemedyFor(link,
                              "start it (sudo systemctl start footingd, or footingd in a "
                              "terminal), or name its address with --connect");
}

}  // namespace

class Connection::Implementation {
 public:
  explicit Implementation(ConnectionOptions options) {
    dialled_.address = options.address;
    dialled_.client_name = "footing-ctl";
    dialled_.role = options.role;
    dialled_.channels = std::move(options.channels);
    dialled_.max_hz = options.max_hz;
    dialled_.queue_ticks = kQueueTicks;
    Connect();
  }

  void Connect() {
    transport::ClientHandlers handlers;
    handlers.on_welcome = [this](const v1::Welcome& welcome) { welcome_ = welcome; };
    handlers.on_tick = [this](const v1::Tick& tick) { OnTick(tick); };
    handlers.on_state = [this](transport::LinkState state, const std::string& why) {
      live_ = state == transport::LinkState::kLive;
      refused_ = state == transport::LinkState::kRefused;
      link_ = why;
    };
    handlers.on_notice = [this](const v1::Notice& notice) { notice_ = notice.text(); };
    handlers.on_refused = [this](const v1::Refused& refused) {
      if (refused.reason() == v1::Refused::REASON_ROLE) ViewOnly();
    };
    client_.emplace(io_, dialled_, std::move(handlers));
    client_->Start();
  }

  /// Over TCP a token or a certificate gives control. Who has neither may look; a command is then
  /// refused, with the reason.
  void ViewOnly() {
    if (!dialled_.address.OverTcp() || dialled_.role != v1::ROLE_CONTROL) return;
    dialled_.role = v1::ROLE_VIEW;
    Connect();
  }

  Result<void> WaitForSnapshot(double within_s) {
    const Waited waited = RunUntil([this] { return ticks_ > 0 || refused_; }, within_s);
    if (waited == Waited::kInterrupted) return Failure("stopped");
    if (waited == Waited::kDone && !refused_) return {};
    if (refused_) return Failure(link_);
    return NoDevice("no footingd: " + link_ + Remedy(link_));
  }

  Result<v1::CommandResult> Call(v1::Command command, double within_s) {
    std::optional<v1::CommandResult> answer;
    command.set_deadline_ms(static_cast<std::uint32_t>(within_s * 1e3));
    client_->Send(std::move(command), [&](const v1::CommandResult& result) { answer = result; });
    // The client answers by its own deadline; what comes later must not find `answer` gone.
    while (!answer && !io_.stopped()) io_.run_one();
    if (!answer) return Failure("the connection has ended");
    if (!answer->ok()) return Failure(answer->message());
    return *answer;
  }

  Waited RunUntil(const std::function<bool()>& condition, double within_s) {
    return timer::RunUntil(io_, condition, within_s, [this] { return end_.asked(); });
  }

  void OnTick(const v1::Tick& tick) {
    ++ticks_;
    server_ns_ = tick.host_ns();
    const rig::Tick sensors = wire::SensorTick(tick);
    sensors_.Take(sensors);
    if (tick.has_stats()) stats_ = wire::FromProto(tick.stats());
    if (on_tick_) on_tick_(tick, sensors);
  }

  transport::ClientOptions dialled_;
  boost::asio::io_context io_{1};
  service_manager::ProgramEnd end_{io_};
  std::optional<transport::Client> client_;
  v1::Welcome welcome_;
  rig::Follower sensors_;
  std::optional<stream::ServerStats> stats_;
  Connection::OnTick on_tick_;
  std::string link_ = "not connected";
  std::string notice_;
  std::uint64_t ticks_ = 0;
  std::int64_t server_ns_ = 0;
  bool live_ = false;
  bool refused_ = false;
};

Connection::Connection(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Connection::~Connection() = default;

Result<std::unique_ptr<Connection>> Connection::Open(ConnectionOptions options) {
  const double within_s = options.connect_within_s;
  auto implementation = std::make_unique<Implementation>(std::move(options));
  if (const auto there = implementation->WaitForSnapshot(within_s); !there) return there.error();
  return std::unique_ptr<Connection>(new Connection(std::move(implementation)));
}

const std::vector<stream::DeviceStatus>& Connection::status() const {
  return implementation_->sensors_.devices();
}
const std::vector<stream::RigSetup>& Connection::setup() const {
  return implementation_->sensors_.setup();
}
const std::optional<stream::ServerStats>& Connection::stats() const {
  return implementation_->stats_;
}
const v1::Welcome& Connection::welcome() const { return implementation_->welcome_; }
std::int64_t Connection::server_ns() const { return implementation_->server_ns_; }
std::int64_t Connection::OnServersClock(std::int64_t our_ns) const {
  return transport::OnServersClock(implementation_->dialled_.address,
                                   implementation_->client_->clock(), our_ns);
}
bool Connection::live() const { return implementation_->live_; }
const std::string& Connection::link() const { return implementation_->link_; }
std::string Connection::TakeNotice() { return std::exchange(implementation_->notice_, {}); }

void Connection::set_on_tick(OnTick on_tick) { implementation_->on_tick_ = std::move(on_tick); }

Result<v1::CommandResult> Connection::Call(v1::Command command, double within_s) {
  return implementation_->Call(std::move(command), within_s);
}

Waited Connection::RunFor(double duration_s) { return implementation_->RunUntil({}, duration_s); }

Waited Connection::RunUntil(const std::function<bool()>& condition, double within_s) {
  return implementation_->RunUntil(condition, within_s);
}

Result<stream::DeviceStatus> Connection::Find(const std::string& name) const {
  return display::FindDevice(status(), name);
}

}  // namespace footing::ctl

#include "clients/relay/edge.h"

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "clients/relay/channels.h"
#include "common/base/units.h"
#include "common/net/server.h"
#include "common/net/socket.h"
#include "common/net/tick.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"

namespace footing::relay {
namespace {

constexpr auto kPulse = std::chrono::milliseconds(250);
constexpr double kAskAgainS = 0.9;
constexpr double kPingViewersS = 3;

std::string NewInbox() {
  std::random_device random;
  std::string inbox = "_INBOX.footing";
  for (int i = 0; i < 4; ++i) inbox += std::to_string(random());
  return inbox;
}

/// At most that many bytes of a text in UTF-8, and whole letters.
std::string Beginning(const std::string& text, std::size_t most) {
  std::size_t end = std::min(text.size(), most);
  const auto continues = [&](std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80;
  };
  while (end > 0 && continues(end)) --end;
  return text.substr(0, end);
}

v1::CommandResult RefuseCommand(const transport::SessionInfo&, const v1::Command& command) {
  v1::CommandResult result;
  result.set_id(command.id());
  result.set_message("this is a relay; send commands to the server itself");
  return result;
}

}  // namespace

Edge::Edge(boost::asio::io_context& io, EdgeOptions options,
           std::function<void(const Error&)> on_broken)
    : io_(io),
      options_(std::move(options)),
      on_broken_(std::move(on_broken)),
      inbox_(NewInbox()),
      nats_(io, options_.nats,
            {[this] {
               Say("connected to " + options_.nats.address.Text());
               Ask(probes_.Next(clock::MonotonicNs()));
             },
             [this](const std::string& why) { Say("NATS: " + why); },
             [this](const nats::Message& message) { OnMessage(message); }}),
      pulse_(io) {
  nats_.Subscribe(TickSubject(options_.site, options_.server));
  nats_.Subscribe(inbox_);
}

void Edge::Start() {
  nats_.Start();
  ArmPulse();
}

void Edge::Stop() {
  pulse_.cancel();
  nats_.Stop();
  Count(report_);
  server_.reset();
  former_.reset();
}

void Edge::Drain(const std::string& reason, std::function<void()> done) {
  pulse_.cancel();
  nats_.Stop();
  if (!server_) return done();
  server_->Drain(reason, std::move(done));
}

EdgeReport Edge::report() const {
  EdgeReport report = report_;
  Count(report);
  report.serving = server_ != nullptr;
  if (server_) report.sessions = server_->statistics().sessions;
  report.nats_up = nats_.up();
  return report;
}

void Edge::OnMessage(const nats::Message& message) {
  v1::Envelope envelope;
  const bool parsed =
      envelope.ParseFromArray(message.payload.data(), static_cast<int>(message.payload.size()));
  if (message.subject != inbox_) {
    if (parsed && envelope.has_tick()) OnTick(envelope.tick());
    return;
  }
  if (message.no_responders && !server_) {
    Say("waiting: nobody publishes " + options_.server + " of " + options_.site);
  }
  if (!parsed) return;
  if (envelope.has_pong()) {
    OnPong(envelope.pong());
  } else if (envelope.has_welcome()) {
    OnWelcome(envelope.welcome());
  } else if (envelope.has_tick() && envelope.tick().snapshot()) {
    OnSnapshot(envelope.tick());
  }
}

void Edge::OnPong(const v1::Pong& pong) {
  const bool settled = probes_.settled();
  probes_.Take(pong, clock::MonotonicNs());
  if (!settled) probes_.settled() ? AskForSnapshot() : Ask(probes_.Next(clock::MonotonicNs()));
}

void Edge::OnWelcome(const v1::Welcome& welcome) {
  const bool other = welcome_.epoch() != 0 && welcome.epoch() != welcome_.epoch();
  welcome_ = welcome;
  if (!other) return;
  if (server_) End(options_.server + " was started again");
  // Perhaps on another host, or behind a start of this one: its clock comes first.
  probes_.OnWelcome(true);
  asked_ns_ = 0;
  Ask(probes_.Next(clock::MonotonicNs()));
}

void Edge::Ask(const v1::Envelope& question) {
  nats_.Publish(AskSubject(options_.site, options_.server), question.SerializeAsString(), inbox_);
}

void Edge::AskForSnapshot() {
  const std::int64_t now_ns = clock::MonotonicNs();
  if (asked_ns_ != 0 && NanosecondsToSeconds(now_ns - asked_ns_) < kAskAgainS) return;
  asked_ns_ = now_ns;
  v1::Envelope question;
  question.mutable_hello()->set_client_name("footing-relay");
  Ask(question);
}

void Edge::OnTick(const v1::Tick& tick) {
  if (!server_) return;  // The snapshot comes first.
  if (tick.epoch() != server_->epoch()) return AskForSnapshot();
  ++report_.ticks;
  const std::uint64_t last = thinner_->last_sequence();
  auto thinned = thinner_->Take({tick.sequence(), tick.host_ns()}, transport::ChannelsOf(tick));
  if (thinner_->last_sequence() == last) return;  // Not a new one.
  heard_ns_ = clock::MonotonicNs();
  if (tick.sequence() > last + 1) {
    wanted_ = tick.sequence();
    AskForSnapshot();
  }
  if (thinned) server_->Relay(thinned->number, std::move(thinned->channels));
}

void Edge::OnSnapshot(const v1::Tick& tick) {
  if (welcome_.epoch() == 0 || tick.epoch() != welcome_.epoch() || !probes_.settled()) return;
  if (!IsSound({tick.sequence(), tick.host_ns()})) return;
  if (tick.sequence() >= wanted_) wanted_ = 0;
  if (!server_) return Begin(tick);
  thinner_->TakeRetained(tick.sequence(), transport::ChannelsOf(tick));
}

transport::ServerOptions Edge::OptionsOf(const v1::Welcome& welcome) const {
  transport::ServerOptions options;
  options.server_id = options_.server;
  constexpr std::size_t kLongestVersion = 64;
  options.version = Beginning(welcome.version(), kLongestVersion) + " relayed";
  options.channels = ChannelsNamed(welcome.channels());
  options.tick_rate_hz = transport::TickRateOf(welcome, options.tick_rate_hz);
  if (options_.rate_hz > 0) options.tick_rate_hz = std::min(options.tick_rate_hz, options_.rate_hz);
  options.epoch = welcome.epoch();
  options.sessions = options_.sessions;
  options.ping_interval_s = kPingViewersS;
  options.capabilities = {"relay"};
  options.now_ns = [this] { return clock::MonotonicNs() + probes_.offset().offset_ns; };
  return options;
}

void Edge::Begin(const v1::Tick& snapshot) {
  transport::ServerOptions options = OptionsOf(welcome_);
  if (const auto applied = options_.access.Apply(options); !applied) {
    return on_broken_(applied.error());
  }
  transport::ServerHandlers handlers;
  handlers.on_command = RefuseCommand;
  handlers.on_overload = [](const transport::OverloadLine& line) {
    log::Write(log::Level::kWarning, line.text, {"", line.session, line.channel});
  };
  // Ticks lost in the silence before: viewers who resume get them as a Gap.
  const bool again = former_ && former_->epoch() == options.epoch;
  if (again && snapshot.sequence() > thinner_->last_sequence())
    report_.missing += snapshot.sequence() - thinner_->last_sequence();
  server_ = std::make_unique<transport::Server>(io_, options, handlers);
  thinner_.emplace(options_.rate_hz, transport::TickRateOf(welcome_, options.tick_rate_hz),
                   snapshot.sequence());
  server_->BeginAt({snapshot.sequence(), snapshot.host_ns()}, transport::ChannelsOf(snapshot));
  heard_ns_ = clock::MonotonicNs();
  std::string places;
  for (std::size_t i = 0; i < options_.listen.size(); ++i) {
    if (const auto listening = server_->Listen(options_.listen[i]); !listening) {
      return on_broken_(listening.error());
    }
    places += " " + server_->ListeningOn(i).Text();
  }
  Say("serving " + options_.server + " of " + options_.site + " on" + places);
  if (!server_->fingerprint().empty()) log::Info("certificate " + server_->fingerprint());
}

/// Its numbers are added to the report.
void Edge::Count(EdgeReport& report) const {
  if (!server_) return;
  const transport::ServerStatistics statistics = server_->statistics();
  report.dropped += statistics.ticks_dropped;
  report.accepted += statistics.accepted;
  report.missing += thinner_->missing();
  report.left_out += thinner_->left_out();
}

void Edge::End(const std::string& reason) {
  Count(report_);
  server_->Stop(reason);
  wanted_ = 0;
  former_ = std::move(server_);
  Say(reason);
}

void Edge::ArmPulse() {
  pulse_.After(kPulse, [this] {
    OnPulse();
    ArmPulse();
  });
}

void Edge::OnPulse() {
  const std::int64_t now_ns = clock::MonotonicNs();
  if (transport::WasLate(pulse_)) heard_ns_ = now_ns;  // It was us who stood still.
  if (server_ && NanosecondsToSeconds(now_ns - heard_ns_) > options_.silent_after_s) {
    End("nothing comes from " + options_.server + " of " + options_.site + " any more");
  }
  if (!nats_.up()) return;
  Ask(probes_.Next(now_ns));
  if ((!server_ && probes_.settled()) || wanted_ != 0) AskForSnapshot();
}

void Edge::Say(const std::string& state) {
  if (state == state_) return;
  state_ = state;
  log::Info(state);
}

}  // namespace footing::relay

#include "clients/relay/publisher.h"

#include <algorithm>
#include <utility>

#include <google/protobuf/descriptor.h>

#include "clients/relay/channels.h"
#include "clients/relay/nats_protocol.h"
#include "common/net/address.h"
#include "common/net/server.h"
#include "common/net/tick.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"

namespace footing::relay {
namespace {

constexpr std::uint32_t kQueueTicks = 1024;

transport::ClientOptions OptionsFor(const transport::Address& address,
                                    const std::vector<std::string>& channels) {
  transport::ClientOptions options;
  options.address = address;
  options.client_name = "footing-relay";
  options.channels = channels;
  options.queue_ticks = kQueueTicks;
  return options;
}

}  // namespace

Source::Source(boost::asio::io_context& io, const transport::Address& address,
               const std::vector<std::string>& channels, Handlers handlers)
    : handlers_(std::move(handlers)),
      address_(address.Text()),
      client_(io, OptionsFor(address, channels),
              {[this](const v1::Welcome& welcome) { OnWelcome(welcome); },
               [this](const v1::Tick& tick) { OnTick(tick); },
               [this](const v1::Gap& gap) {
                 if (gap.to_sequence() >= gap.from_sequence())
                   missing_ += gap.to_sequence() - gap.from_sequence() + 1;
               },
               [this](transport::LinkState, const std::string& why) {
                 link_ = why;
                 log::Info(why);
               },
               [this](const v1::Notice& notice) { log::Warning(notice.text()); }}) {}

double Source::tick_rate_hz() const {
  return transport::TickRateOf(welcome_, transport::ServerOptions().tick_rate_hz);
}

std::optional<std::int64_t> Source::ServerNs() const {
  const transport::ClockOffset clock = client_.clock();
  if (!clock.valid || !live()) return std::nullopt;
  return clock::MonotonicNs() + clock.offset_ns;
}

void Source::OnWelcome(const v1::Welcome& welcome) {
  if (!nats::IsPart(welcome.server_id())) {
    log::Warning(address_ +
                 ": the server's name cannot be part of a subject: " + welcome.server_id());
    return;
  }
  if (welcome.epoch() != welcome_.epoch()) snapshot_.Clear();
  const bool renamed = name_ != welcome.server_id();
  welcome_ = welcome;
  name_ = welcome.server_id();
  if (renamed) handlers_.on_named(*this);
}

void Source::OnTick(const v1::Tick& tick) {
  if (name_.empty() || tick.epoch() != welcome_.epoch()) return;
  if (!tick.snapshot()) ++ticks_;
  const google::protobuf::Reflection& fields = *tick.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> present;
  fields.ListFields(tick, &present);
  for (const google::protobuf::FieldDescriptor* field : present) {
    if (KindOf(static_cast<std::uint32_t>(field->number())) != ChannelKind::kRetained) continue;
    fields.MutableMessage(&snapshot_, field)->CopyFrom(fields.GetMessage(tick, field));
  }
  snapshot_.set_epoch(tick.epoch());
  snapshot_.set_sequence(std::max(snapshot_.sequence(), tick.sequence()));
  snapshot_.set_host_ns(std::max(snapshot_.host_ns(), tick.host_ns()));
  snapshot_.set_snapshot(true);
  handlers_.on_tick(*this, tick);
}

namespace {

/// A second, and at once; an edge asks 6 times when it starts, and four times a second then.
constexpr double kAnswersPerS = 500, kAnswersAtOnce = 1000;

}  // namespace

Publisher::Publisher(boost::asio::io_context& io, PublisherOptions options)
    : options_(std::move(options)), answers_(kAnswersPerS, kAnswersAtOnce) {
  if (options_.nats) {
    nats_.emplace(
        io, *options_.nats,
        NatsLinkHandlers{
            [this] { Say("publishing in NATS at " + options_.nats->address.Text(), nats_state_); },
            [this](const std::string& why) { Say("NATS: " + why, nats_state_); },
            [this](const nats::Message& message) { OnAsked(message); }});
  }
  if (options_.mqtt) {
    mqtt_.emplace(
        io, *options_.mqtt,
        MqttLinkHandlers{[this] {
                           Say("publishing in MQTT at " + options_.mqtt->host, mqtt_state_);
                           RepeatRetained();
                         },
                         [this](const std::string& why) { Say("MQTT: " + why, mqtt_state_); }});
  }
  for (const transport::Address& address : options_.servers) {
    sources_.push_back(std::make_unique<Source>(
        io, address, options_.channels,
        Source::Handlers{[this](Source& source) { OnNamed(source); },
                         [this](Source& source, const v1::Tick& tick) { OnTick(source, tick); }}));
  }
}

Result<void> Publisher::Start() {
  if (mqtt_) {
    if (auto started = mqtt_->Start(); !started) return started;
  }
  if (nats_) nats_->Start();
  for (const auto& source : sources_) source->Start();
  return {};
}

void Publisher::Stop() {
  for (const auto& source : sources_) source->Stop();
  if (nats_) nats_->Stop();
  if (mqtt_) mqtt_->Stop();
}

/// Once, however often it is tried.
void Publisher::Say(const std::string& line, std::string& state) {
  if (std::exchange(state, line) != line) log::Info(line);
}

PublisherReport Publisher::report() const {
  PublisherReport report;
  for (const auto& source : sources_) {
    report.ticks += source->ticks();
    report.missing += source->missing();
    report.sources.push_back({source->address(), source->name(), source->live()});
  }
  if (nats_) report.nats_up = nats_->up();
  if (mqtt_) report.mqtt_up = mqtt_->up();
  report.published = published_;
  report.dropped = (nats_ ? nats_->dropped() : 0) + (mqtt_ ? mqtt_->dropped() : 0);
  return report;
}

Result<void> Publisher::CheckUseful() const {
  std::string why;
  for (const auto& source : sources_) {
    if (!source->name().empty()) {
      why.clear();
      break;
    }
    why += (why.empty() ? "" : "; ") + source->link();
  }
  if (!why.empty())
    return NoDevice("no server to publish: " + why +
                    transport::RemedyFor(why, "start it, or name it with --connect"));
  if (published_ > 0) return {};
  return Failure("nothing was published: " + nats_state_ + (nats_ && mqtt_ ? "; " : "") +
                 mqtt_state_);
}

void Publisher::OnNamed(Source& source) {
  if (nats_) nats_->Subscribe(AskSubject(options_.site, source.name()));
}

void Publisher::OnTick(const Source& source, const v1::Tick& tick) {
  if (nats_ && !tick.snapshot()) {
    v1::Envelope message;
    *message.mutable_tick() = tick;
    message.mutable_tick()->clear_refilled();  // That says something of our session only.
    if (nats_->Publish(TickSubject(options_.site, source.name()), message.SerializeAsString()))
      ++published_;
  }
  if (mqtt_) PublishChannels(source, tick);
}

void Publisher::PublishChannels(const Source& source, const v1::Tick& tick) {
  auto found = thinners_.find(tick.epoch());
  if (found == thinners_.end()) {
    if (thinners_.size() > options_.servers.size()) thinners_.clear();  // Drops former epochs.
    const std::uint64_t before = tick.snapshot() ? tick.sequence() : tick.sequence() - 1;
    const Thinner fresh(options_.mqtt_rate_hz, source.tick_rate_hz(), before);
    found = thinners_.emplace(tick.epoch(), fresh).first;
  }
  Thinner& thinner = found->second;
  if (tick.snapshot()) return thinner.TakeRetained(tick.sequence(), transport::ChannelsOf(tick));
  const auto thinned = thinner.Take({tick.sequence(), tick.host_ns()}, transport::ChannelsOf(tick));
  if (!thinned) return;
  for (const transport::ChannelBytes& channel : thinned->channels) {
    const bool retain = KindOf(channel.field) == ChannelKind::kRetained;
    const std::string topic =
        ChannelTopic(options_.site, source.name(), ChannelName(channel.field));
    if (mqtt_->Publish(topic, TickMessage(tick.epoch(), thinned->number, {channel}), retain)) {
      ++published_;
    } else if (retain) {
      thinner.TakeRetained(tick.sequence(), {channel});  // With the next tick, then.
    }
  }
}

/// The broker may have been started again, and have lost them.
void Publisher::RepeatRetained() {
  for (const auto& source : sources_) {
    const auto thinner = thinners_.find(source->epoch());
    if (thinner == thinners_.end()) continue;
    const v1::Tick& snapshot = source->snapshot();
    thinner->second.TakeRetained(snapshot.sequence(), transport::ChannelsOf(snapshot));
  }
}

const Source* Publisher::Asked(std::string_view subject) const {
  const auto found = std::find_if(sources_.begin(), sources_.end(), [&](const auto& source) {
    return !source->name().empty() && AskSubject(options_.site, source->name()) == subject;
  });
  return found == sources_.end() ? nullptr : found->get();
}

void Publisher::OnAsked(const nats::Message& message) {
  const std::int64_t arrived_ns = clock::MonotonicNs();
  const Source* const source = Asked(message.subject);
  v1::Envelope question;
  const bool parsed =
      question.ParseFromArray(message.payload.data(), static_cast<int>(message.payload.size()));
  if (source == nullptr || message.reply.empty() || !parsed || !answers_.Spend(arrived_ns)) return;
  const std::string reply(message.reply);
  const auto server_ns = source->ServerNs();
  if (!server_ns) return;  // It has nothing to say of a server that is not there.
  v1::Envelope answer;
  if (question.has_ping()) {
    answer.mutable_pong()->set_id(question.ping().id());
    answer.mutable_pong()->set_t0_ns(question.ping().t0_ns());
    answer.mutable_pong()->set_t1_ns(*server_ns);
    answer.mutable_pong()->set_t2_ns(*source->ServerNs());
    nats_->Publish(reply, answer.SerializeAsString());
  } else if (question.has_hello()) {
    *answer.mutable_welcome() = source->welcome();
    nats_->Publish(reply, answer.SerializeAsString());
    *answer.mutable_tick() = source->snapshot();
    nats_->Publish(reply, answer.SerializeAsString());
  }
}

}  // namespace footing::relay

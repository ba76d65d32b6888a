#include "clients/relay/source.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <utility>

#include "clients/relay/requests.h"
#include "clients/relay/channels.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/net/tick_rate.h"

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

}  // namespace footing::relay

#include "common/recording/stream_recorder.h"

#include <utility>

#include <google/protobuf/descriptor.h>

#include "common/runtime/clock.h"

namespace footing::recording {
namespace {

/// Fields of a tick from here on are channels.
constexpr int kFirstChannelField = 16;

const char* Name(transport::LinkState state) {
  switch (state) {
    case transport::LinkState::kConnecting:
      return "connecting";
    case transport::LinkState::kLive:
      return "live";
    case transport::LinkState::kStale:
      return "stale";
    case transport::LinkState::kRefused:
      return "refused";
  }
  return "unknown";
}

}  // namespace

StreamRecorder::StreamRecorder(RecordingWriter& writer, std::string address,
                               std::function<std::string(const std::string&)> name_of)
    : writer_(writer), address_(std::move(address)), name_of_(std::move(name_of)) {}

Result<void> StreamRecorder::OnWelcome(const v1::Welcome& welcome, std::int64_t now_ns) {
  server_ = name_of_(welcome.server_id());
  // Metadata goes into the file at once: what came before it has to stand before it.
  if (const Result<void> flushed = writer_.Flush(); !flushed) return flushed;
  return writer_.AddMetadata("session",
                             {{"server", server_},
                              {"server_id", welcome.server_id()},
                              {"server_version", welcome.version()},
                              {"address", address_},
                              {"epoch", std::to_string(welcome.epoch())},
                              {"protocol", std::to_string(welcome.protocol_major()) + "." +
                                               std::to_string(welcome.protocol_minor())},
                              {"granted_role", v1::Role_Name(welcome.granted_role())},
                              {"tick_rate_hz", std::to_string(welcome.limits().tick_rate_hz())},
                              {"server_host_ns", std::to_string(welcome.host_ns())},
                              {"server_wall_time_ns", std::to_string(welcome.wall_time_ns())},
                              {"recorder_host_ns", std::to_string(now_ns)}});
}

Result<void> StreamRecorder::OnTick(const v1::Tick& tick, std::int64_t now_ns) {
  if (server_.empty()) return {};
  const google::protobuf::Descriptor& type = *tick.GetDescriptor();
  const google::protobuf::Reflection& fields = *tick.GetReflection();
  const Stamp stamp{tick.host_ns(), now_ns, static_cast<std::uint32_t>(tick.sequence())};
  for (int i = 0; i < type.field_count(); ++i) {
    const google::protobuf::FieldDescriptor* field = type.field(i);
    if (field->number() < kFirstChannelField || field->message_type() == nullptr ||
        field->is_repeated() || !fields.HasField(tick, field)) {
      continue;
    }
    const Result<void> written =
        writer_.Write("/" + server_ + "/" + field->name(), fields.GetMessage(tick, field), stamp);
    if (!written) return written;
  }
  last_host_ns_ = tick.host_ns();
  last_sequence_ = tick.sequence();
  ++ticks_;
  return {};
}

Result<void> StreamRecorder::OnGap(const v1::Gap& gap, std::int64_t now_ns) {
  if (server_.empty()) return {};
  if (gap.to_sequence() >= gap.from_sequence()) {
    missing_ticks_ += gap.to_sequence() - gap.from_sequence() + 1;
  }
  const Stamp stamp{last_host_ns_, now_ns, static_cast<std::uint32_t>(last_sequence_)};
  return writer_.Write("/" + server_ + "/gaps", gap, stamp);
}

Result<void> StreamRecorder::OnState(transport::LinkState state, const std::string& why,
                                     std::int64_t now_ns) {
  link_ = std::string(Name(state)) + (why.empty() ? "" : ": " + why);
  reached_ = reached_ || state != transport::LinkState::kConnecting;
  return writer_.AddMetadata("link", {{"address", address_},
                                      {"server", server_},
                                      {"state", Name(state)},
                                      {"why", why},
                                      {"recorder_host_ns", std::to_string(now_ns)}});
}

Result<void> StreamRecorder::OnNotice(const v1::Notice& notice, std::int64_t now_ns) {
  notice_ = notice.text();
  return writer_.AddMetadata("notice", {{"address", address_},
                                        {"server", server_},
                                        {"kind", v1::Notice::Kind_Name(notice.kind())},
                                        {"text", notice.text()},
                                        {"count", std::to_string(notice.count())},
                                        {"recorder_host_ns", std::to_string(now_ns)}});
}

Result<void> StreamRecorder::OnEnd(const transport::ClockOffset& clock, std::int64_t now_ns) {
  return writer_.AddMetadata("clock",
                             {{"address", address_},
                              {"server", server_},
                              {"valid", clock.valid ? "true" : "false"},
                              {"server_minus_recorder_ns", std::to_string(clock.offset_ns)},
                              {"uncertainty_ns", std::to_string(clock.uncertainty_ns)},
                              {"ticks", std::to_string(ticks_)},
                              {"missing_ticks", std::to_string(missing_ticks_)},
                              {"recorder_host_ns", std::to_string(now_ns)}});
}

namespace {

constexpr std::uint32_t kQueueTicks = 1024;  // 10 s at 100 Hz; behind it stands the server's ring.

transport::ClientOptions ClientOf(const ServerRecorderOptions& options) {
  transport::ClientOptions client;
  client.address = options.address;
  client.client_name = options.client_name;
  client.role = v1::ROLE_LOG;
  client.policy = v1::QUEUE_POLICY_RELIABLE;
  client.queue_ticks = kQueueTicks;
  client.from_ring_start = options.from_ring_start;
  return client;
}

}  // namespace

Result<void> DescribeRecording(RecordingWriter& writer, const std::string& program,
                               const std::string& version,
                               const std::vector<transport::Address>& addresses) {
  std::string texts;
  for (const transport::Address& address : addresses) {
    texts += (texts.empty() ? "" : " ") + address.Text();
  }
  return writer.AddMetadata("recording",
                            {{"program", program},
                             {"version", version},
                             {"protobuf_package", "footing.v1"},
                             {"addresses", texts},
                             {"log_time", "CLOCK_MONOTONIC of the server, ns"},
                             {"publish_time", "CLOCK_MONOTONIC of the recorder, ns"},
                             {"recorder_host_ns", std::to_string(clock::MonotonicNs())},
                             {"recorder_wall_time_ns", std::to_string(clock::WallNs())}});
}

std::string ServerNames::Of(const std::string& id, const std::string& address) {
  for (int number = 1;; ++number) {
    const std::string name = number == 1 ? id : id + "_" + std::to_string(number);
    const auto [taken, fresh] = address_of_.emplace(name, address);
    if (fresh || taken->second == address) return name;
  }
}

ServerRecorder::ServerRecorder(boost::asio::io_context& io, RecordingWriter& writer,
                               ServerNames& names, ServerRecorderOptions options)
    : options_(std::move(options)),
      recorder_(writer, options_.address.Text(),
                [&names, address = options_.address.Text()](const std::string& id) {
                  return names.Of(id, address);
                }),
      client_(io, ClientOf(options_), Handlers()) {}

transport::ClientHandlers ServerRecorder::Handlers() {
  transport::ClientHandlers handlers;
  handlers.on_welcome = [this](const v1::Welcome& welcome) {
    options_.on_written(recorder_.OnWelcome(welcome, clock::MonotonicNs()));
  };
  handlers.on_tick = [this](const v1::Tick& tick) {
    const std::int64_t now_ns = clock::MonotonicNs();
    options_.on_written(recorder_.OnTick(tick, now_ns));
    if (!options_.on_tick || recorder_.server().empty()) return;
    options_.on_written(options_.on_tick(recorder_.server(), tick, now_ns));
  };
  handlers.on_gap = [this](const v1::Gap& gap) {
    options_.on_written(recorder_.OnGap(gap, clock::MonotonicNs()));
  };
  handlers.on_state = [this](transport::LinkState state, const std::string& why) {
    options_.on_written(recorder_.OnState(state, why, clock::MonotonicNs()));
    if (options_.on_link) options_.on_link(recorder_);
  };
  handlers.on_notice = [this](const v1::Notice& notice) {
    options_.on_written(recorder_.OnNotice(notice, clock::MonotonicNs()));
    if (options_.on_notice) options_.on_notice(recorder_);
  };
  return handlers;
}

bool ServerRecorder::HasAllUntil(std::int64_t our_ns) const {
  if (client_.state() != transport::LinkState::kLive) return true;
  const transport::ClockOffset clock = client_.clock();
  return clock.valid && recorder_.last_host_ns() >= our_ns + clock.offset_ns;
}

Result<void> ServerRecorder::End() {
  return recorder_.OnEnd(client_.clock(), clock::MonotonicNs());
}

}  // namespace footing::recording

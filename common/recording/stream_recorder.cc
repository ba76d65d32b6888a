#include "common/recording/stream_recorder.h"

#include <google/protobuf/descriptor.h>

#include <utility>

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
  ++notices_;
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

}  // namespace footing::recording

#include "common/recording/recording_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <google/protobuf/descriptor.h>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/net/server.h"
#include "common/runtime/clock.h"

namespace footing::playback {
namespace {

/// From the last tick to the end, so that it gets to those who listen.
constexpr auto kAfterLast = std::chrono::milliseconds(300);

}  // namespace

TickPlayer::TickPlayer(boost::asio::io_context& io, const recording::RecordedSession& session,
                       std::vector<std::string> names, Handlers handlers)
    : timer_(io), names_(std::move(names)), handlers_(std::move(handlers)) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    std::vector<const recording::RecordedTick*> ticks;
    for (const recording::RecordedServer& server : session.servers()) {
      if (server.name != names_[i]) continue;
      for (const recording::RecordedTick& tick : server.ticks) ticks.push_back(&tick);
    }
    Schedule(i, ticks);
  }
  std::stable_sort(due_.begin(), due_.end(),
                   [](const Due& a, const Due& b) { return a.time_ns < b.time_ns; });
}

/// A tick is due at its time, but never after a later one: the snapshot that a recorder begins with
/// has the time of its connection and comes first.
void TickPlayer::Schedule(std::size_t server,
                          const std::vector<const recording::RecordedTick*>& ticks) {
  const std::size_t first = due_.size();
  for (const recording::RecordedTick* tick : ticks) due_.push_back({tick->host_ns, server, tick});
  for (std::size_t i = due_.size(); i > first + 1; --i) {
    due_[i - 2].time_ns = std::min(due_[i - 2].time_ns, due_[i - 1].time_ns);
  }
}

double TickPlayer::duration_s() const {
  return due_.empty() ? 0 : 1e-9 * static_cast<double>(due_.back().time_ns - due_[0].time_ns);
}

void TickPlayer::Start() {
  start_ = timer::Now();
  if (!due_.empty()) shift_ns_ = clock::MonotonicNs() - due_.front().time_ns;
  PlayNext();
}

void TickPlayer::PlayNext() {
  if (next_ >= due_.size()) return End();
  const Due& due = due_[next_];
  timer_.At(start_ + std::chrono::nanoseconds(due.time_ns - due_.front().time_ns), [this, &due] {
    Result<v1::Tick> tick = recording::ReadTick(*due.tick);
    if (!tick) return handlers_.on_end(tick.error());
    ShiftStamps(*tick, shift_ns_);
    tick->set_host_ns(due.time_ns + shift_ns_);
    ++next_;
    handlers_.on_tick(due.server, *tick);
    PlayNext();
  });
}

void TickPlayer::End() {
  timer_.After(kAfterLast, [this] { handlers_.on_end({}); });
}

namespace {

constexpr auto kLookForSession = std::chrono::milliseconds(20);
/// From its welcome until a client has subscribed.
constexpr auto kSubscribeTime = std::chrono::milliseconds(200);

/// Channels that say how things stand: their last value is part of every snapshot.
constexpr std::array<std::string_view, 7> kRetainedChannels = {
    "status", "setup", "skeletons", "track", "game", "config", "study"};

transport::ServerOptions OptionsOf(const recording::RecordedSession& session,
                                   const std::string& name, const std::string& version) {
  transport::ServerOptions options;
  options.server_id = name;
  options.version = version;
  options.capabilities = {"recording"};
  std::set<std::uint32_t> fields;
  for (const recording::RecordedServer& server : session.servers()) {
    if (server.name != name) continue;
    options.server_id = server.server_id;
    options.tick_rate_hz = server.tick_rate_hz;
    for (const recording::RecordedTick& tick : server.ticks) {
      for (const recording::RecordedChannel& channel : tick.channels) fields.insert(channel.field);
    }
  }
  for (const std::uint32_t number : fields) {
    const std::string& channel =
        v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(number))->name();
    bool retained = false;
    for (const std::string_view one : kRetainedChannels) retained = retained || one == channel;
    options.channels.push_back({channel, number, retained});
  }
  return options;
}

v1::CommandResult RefuseCommand(const transport::SessionInfo&, const v1::Command& command) {
  v1::CommandResult result;
  result.set_id(command.id());
  result.set_message("a recording is served here; it takes no commands");
  return result;
}

}  // namespace

RecordingServer::RecordingServer(boost::asio::io_context& io,
                                 const recording::RecordedSession& session, const std::string& name,
                                 const std::string& version)
    : server_(io, OptionsOf(session, name, version), {RefuseCommand, {}}),
      player_(io, session, {name},
              {[this](std::size_t, const v1::Tick& tick) { Publish(tick); },
               [this](const Result<void>& ended) { on_end_(ended); }}),
      wait_(io) {}

void RecordingServer::Start(std::function<void(const Result<void>&)> on_end) {
  on_end_ = std::move(on_end);
  WaitForSession();
}

void RecordingServer::WaitForSession() {
  const bool found = server_.statistics().sessions > 0;
  wait_.After(found ? kSubscribeTime : kLookForSession,
              [this, found] { found ? player_.Start() : WaitForSession(); });
}

void RecordingServer::Publish(const v1::Tick& tick) {
  server_.Publish(tick.host_ns(), transport::ChannelsOf(tick));
  ++published_;
}

void RecordingServer::Stop(const std::string& reason) {
  wait_.cancel();
  player_.Stop();
  server_.Stop(reason);
}

namespace {

/// A whole number within kMostInstantNs; nothing where there is none.
std::optional<std::int64_t> WholeOf(const mcap::TextMap& values, const std::string& key) {
  const std::string word = mcap::TextOf(values, key);
  const bool negative = !word.empty() && word[0] == '-';
  const auto count = text::ToCount(std::string_view(word).substr(negative ? 1 : 0));
  if (!count || *count > static_cast<std::size_t>(kMostInstantNs)) return std::nullopt;
  return (negative ? -1 : 1) * static_cast<std::int64_t>(*count);
}

/// On one host both read the same clock: an estimate could only add its own error.
bool OnThisHost(const mcap::TextMap& values) {
  return mcap::TextOf(values, "address").rfind("unix:", 0) == 0;
}

}  // namespace

void TakeClock(const mcap::TextMap& values, RecordedServer& server) {
  if (mcap::TextOf(values, "valid") != "true" || OnThisHost(values)) return;
  const std::optional<std::int64_t> offset_ns = WholeOf(values, "server_minus_recorder_ns");
  if (!offset_ns) return;
  server.offset_ns = *offset_ns;
  server.clock_measured = true;
}

std::optional<std::int64_t> TakeSession(const mcap::TextMap& values, RecordedServer& server) {
  const std::optional<std::int64_t> server_ns = WholeOf(values, "server_host_ns");
  const std::optional<std::int64_t> recorder_ns = WholeOf(values, "recorder_host_ns");
  if (!server_ns || !recorder_ns) return std::nullopt;
  if (server.welcomes.size() < kMostSessions) server.welcomes.push_back({*server_ns, *recorder_ns});
  const bool other_host = !mcap::TextOf(values, "address").empty() && !OnThisHost(values);
  const std::int64_t offset_ns = *server_ns - *recorder_ns;
  if (other_host && !server.clock_measured && IsInstant(offset_ns)) server.offset_ns = offset_ns;
  const std::int64_t wall_ns = WholeOf(values, "server_wall_time_ns").value_or(0);
  if (wall_ns == 0) return std::nullopt;
  return wall_ns - *recorder_ns;
}

bool IsLive(const RecordedServer& server, std::int64_t host_ns, std::int64_t recorded_ns) {
  return std::none_of(server.welcomes.begin(), server.welcomes.end(), [&](const auto& welcome) {
    return host_ns < welcome.server_ns && recorded_ns >= welcome.recorder_ns;
  });
}

namespace {

namespace pb = google::protobuf;

bool IsStamp(const pb::FieldDescriptor& field) {
  const std::string& name = field.name();
  return field.cpp_type() == pb::FieldDescriptor::CPPTYPE_INT64 && !field.is_repeated() &&
         name.ends_with("_ns") && name != "age_ns" && name != "true_ns" && name != "wall_time_ns";
}

}  // namespace

void ShiftStamps(pb::Message& message, std::int64_t shift_ns) {
  const pb::Reflection& fields = *message.GetReflection();
  std::vector<const pb::FieldDescriptor*> present;
  fields.ListFields(message, &present);  // Fields of value zero are not among them.
  for (const pb::FieldDescriptor* field : present) {
    if (IsStamp(*field)) {
      const std::int64_t stamp_ns = fields.GetInt64(message, field);
      if (IsInstant(stamp_ns)) fields.SetInt64(&message, field, stamp_ns + shift_ns);
    } else if (field->message_type() == nullptr) {
      continue;
    } else if (field->is_repeated()) {
      const int count = fields.FieldSize(message, field);
      for (int i = 0; i < count; ++i) {
        ShiftStamps(*fields.MutableRepeatedMessage(&message, field, i), shift_ns);
      }
    } else {
      ShiftStamps(*fields.MutableMessage(&message, field), shift_ns);
    }
  }
}

}  // namespace footing::playback

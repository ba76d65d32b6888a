#include "common/net/server.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/stubs/logging.h>
#include <unistd.h>
#include <boost/asio/post.hpp>

#include "common/base/units.h"
#include "common/net/address.h"
#include "common/net/listener.h"
#include "common/net/session.h"
#include "common/net/tls_context.h"

namespace footing::transport {
namespace {

/// Beside those of the sessions: devices, files, listeners.
constexpr std::int64_t kOtherDescriptors = 256;

std::uint64_t NewEpoch() {
  std::random_device random;
  const std::uint64_t high = random();
  const std::uint64_t epoch = (high << 32) | random();
  return epoch == 0 ? 1 : epoch;
}

}  // namespace

class Server::Implementation {
 public:
  Implementation(boost::asio::io_context& io, ServerOptions options, ServerHandlers handlers)
      : io_(io), shared_(io.get_executor(), std::move(options), std::move(handlers)) {
    shared_.epoch = shared_.options.epoch != 0 ? shared_.options.epoch : NewEpoch();
    shared_.publication.set_epoch(shared_.epoch);
    // Protobuf would write a line to standard error for every message that a client got wrong.
    google::protobuf::SetLogHandler(nullptr);
    shared_.on_own_command = [this](const SessionInfo& who, const v1::Command& command,
                                    std::int64_t arrived_ns) {
      return command.has_marker() ? TakeMarker(who, command.marker(), arrived_ns)
                                  : sessions_.CarryOut(who, command);
    };
  }

  Result<void> Listen(const Address& address) {
    ReserveForSessions();
    ListenSecurity security;
    security.insecure_lan = shared_.options.insecure_lan && shared_.options.has_token();
    if (shared_.options.identity_file) {
      security.tls = [this, address] { return TlsContext(address); };
    }
    auto listener = Listener::Open(
        io_, address, [this](Socket socket) { OnAccept(std::move(socket)); }, security);
    if (!listener) return listener.error();
    listeners_.push_back(std::move(*listener));
    return {};
  }

  Address ListeningOn(std::size_t index) const {
    FOOTING_CHECK(index < listeners_.size());
    return listeners_[index]->address();
  }

  std::uint64_t Publish(std::int64_t host_ns, const std::vector<ChannelBytes>& channels) {
    const TickNumber number = shared_.publication.Next(host_ns);
    if (markers_.empty()) {
      Relay(number, channels);
    } else {
      std::vector<ChannelBytes> with_markers = channels;
      markers_.MoveTo(with_markers);
      Relay(number, with_markers);
    }
    return number.sequence;
  }

  void BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained) {
    shared_.publication.BeginAt(number, retained);
  }

  void Relay(const TickNumber& number, const std::vector<ChannelBytes>& channels) {
    const std::uint64_t left_out = shared_.publication.channels_left_out();
    const SharedTick tick = shared_.publication.Publish(number, channels);
    if (shared_.publication.channels_left_out() != left_out) SayLeftOut();
    const std::int64_t now_ns = shared_.NowNs();
    for (int place = 0; place <= Session::kLastPlace; ++place) {
      for (const auto& session : sessions_.all()) {
        if (session->PlaceInLine(now_ns) == place) session->Offer(tick);
      }
    }
    shared_.publication.Keep(tick);
  }

  void Answer(std::uint64_t number, const v1::CommandResult& result) {
    if (const auto session = sessions_.Find(number)) session->Answer(result);
  }

  void SendDevice(std::uint64_t number, const v1::DeviceEnvelope& message) {
    if (const auto session = sessions_.Find(number)) session->SendDevice(message);
  }

  void EndSession(std::uint64_t number, const std::string& reason) {
    if (const auto session = sessions_.Find(number)) session->End(reason);
  }

  void NoteLateTicks(std::uint64_t count) {
    shared_.statistics.late_ticks += count;
    shared_.publication.LeaveOut(count);
    if (!late_lines_.Spend(shared_.NowNs())) return;
    const std::uint64_t all = shared_.statistics.late_ticks;
    const std::string line =
        shared_.options.server_id + " is overloaded: " + std::to_string(all) +
        " ticks skipped since start, sessions: " + std::to_string(sessions_.all().size());
    if (shared_.handlers.on_overload) shared_.handlers.on_overload({line});
    for (const auto& session : sessions_.all()) {
      session->Notify(v1::Notice::KIND_TICKS_LATE, line, all);
    }
  }

  std::string fingerprint() const { return identity_ ? identity_->fingerprint() : ""; }
  std::uint64_t epoch() const { return shared_.epoch; }

  ServerStatistics statistics() const {
    ServerStatistics statistics = shared_.statistics;
    statistics.sessions = static_cast<std::size_t>(
        std::count_if(sessions_.all().begin(), sessions_.all().end(),
                      [](const auto& session) { return session->welcomed(); }));
    statistics.ring_bytes = shared_.publication.ring().bytes();
    statistics.channels_left_out = shared_.publication.channels_left_out();
    return statistics;
  }

  std::vector<stream::SessionStats> sessions() const {
    std::vector<stream::SessionStats> all;
    for (const auto& session : sessions_.all()) {
      if (session->welcomed()) all.push_back(session->Stats());
    }
    return all;
  }

  void Stop(const std::string& reason) {
    listeners_.clear();
    for (const auto& session : sessions_.all()) session->End(reason);
  }

  void Drain(const std::string& reason, std::function<void()> done) {
    listeners_.clear();
    drained_ = std::move(done);
    for (const auto& session : sessions_.all()) session->Drain(reason);
    if (sessions_.all().empty()) Drained();
  }

  void SetLimits(const SessionLimits& limits) {
    shared_.options.sessions = limits;
    ReserveForSessions();
  }

  std::size_t SetAccess(const AccessKeys& keys) { return sessions_.SetKeys(keys); }

  const ServerOptions& options() const { return shared_.options; }

 private:
  v1::CommandResult TakeMarker(const SessionInfo& who, const v1::Marker& marker,
                               std::int64_t arrived_ns) {
    v1::CommandResult result;
    if (!shared_.options.takes_markers) {
      result.set_message(shared_.options.server_id + " takes no markers");
      return result;
    }
    const Result<void> added = markers_.Add(marker, who.client_name, arrived_ns);
    result.set_ok(added.ok());
    if (!added) result.set_message("marker: " + added.error().message);
    return result;
  }

  void ReserveForSessions() const {
    const SessionLimits& limits = shared_.options.sessions;
    ReserveDescriptors(static_cast<std::size_t>(limits.max_sessions + limits.admin_places +
                                                SessionTable::kMostLingering + kOtherDescriptors));
  }

  Result<tls::Context> TlsContext(const Address& address) {
    const ServerOptions& options = shared_.options;
    if (const auto checked = CheckKeys(address, options.has_keys()); !checked) {
      return checked.error();
    }
    if (!identity_) {
      auto identity = tls::Identity::LoadOrMake(*options.identity_file, "Footing");
      if (!identity) return identity.error();
      identity_ = std::move(identity).value();
    }
    return tls::Context::ForServer(*identity_);
  }

  void SayLeftOut() {
    const auto& channels = shared_.options.channels;
    const auto channel = std::find_if(channels.begin(), channels.end(), [this](const Channel& one) {
      return one.field == shared_.publication.left_out_field();
    });
    if (channel == channels.end() || !shared_.handlers.on_overload) return;
    if (!left_out_lines_.Spend(shared_.NowNs())) return;
    shared_.handlers.on_overload(
        {"channel " + channel->name + " was left out of a tick, which has at most " +
             std::to_string(shared_.options.max_message_out_bytes) + " bytes (" +
             std::to_string(shared_.publication.channels_left_out()) + " since start)",
         0, channel->name});
  }

  void OnAccept(Socket socket) {
    ++shared_.statistics.accepted;
    const auto session = std::make_shared<Session>(std::move(socket), ++last_number_, shared_,
                                                   [this](Session& ended) { OnEnd(ended); });
    const std::string full = sessions_.WhyFull(*session);
    // Those that are being refused linger for a moment; there is an end to them too.
    if (!full.empty() && sessions_.lingering() >= SessionTable::kMostLingering) return;
    sessions_.Add(session);
    if (full.empty()) return session->Start();
    session->StartRefused(
        v1::Refused::REASON_TOO_MANY_SESSIONS,
        shared_.options.server_id + " has " + full + "; end one or try again later");
  }

  void Drained() {
    if (drained_) boost::asio::post(io_, std::exchange(drained_, nullptr));
  }

  void OnEnd(Session& ended) {
    const std::shared_ptr<Session> session = sessions_.Remove(ended);
    boost::asio::post(io_, [session] {});  // It is still being called: let it go later.
    if (sessions_.all().empty()) Drained();
    if (!session->welcomed()) return;
    Leave(session->admitted(), shared_.admission);
    if (shared_.handlers.on_session_end) shared_.handlers.on_session_end(session->info());
  }

  boost::asio::io_context& io_;
  Shared shared_;
  std::optional<tls::Identity> identity_;
  std::vector<std::unique_ptr<Listener>> listeners_;
  SessionTable sessions_{shared_};
  MarkerQueue markers_;
  std::uint64_t last_number_ = 0;
  TokenBucket late_lines_{0.1, 1};
  TokenBucket left_out_lines_{0.1, 1};
  std::function<void()> drained_;  ///< While draining.
};

Server::Server(boost::asio::io_context& io, ServerOptions options, ServerHandlers handlers)
    : implementation_(
          std::make_shared<Implementation>(io, std::move(options), std::move(handlers))) {}
Server::~Server() = default;

Result<void> Server::Listen(const Address& address) { return implementation_->Listen(address); }
Address Server::ListeningOn(std::size_t index) const { return implementation_->ListeningOn(index); }
std::uint64_t Server::Publish(std::int64_t host_ns, const std::vector<ChannelBytes>& channels) {
  return implementation_->Publish(host_ns, channels);
}
void Server::BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained) {
  implementation_->BeginAt(number, retained);
}
void Server::Relay(const TickNumber& number, const std::vector<ChannelBytes>& channels) {
  implementation_->Relay(number, channels);
}
void Server::Answer(std::uint64_t session, const v1::CommandResult& result) {
  implementation_->Answer(session, result);
}
void Server::SendDevice(std::uint64_t session, const v1::DeviceEnvelope& message) {
  implementation_->SendDevice(session, message);
}
void Server::EndSession(std::uint64_t session, const std::string& reason) {
  implementation_->EndSession(session, reason);
}
void Server::NoteLateTicks(std::uint64_t count) { implementation_->NoteLateTicks(count); }
std::string Server::fingerprint() const { return implementation_->fingerprint(); }
std::uint64_t Server::epoch() const { return implementation_->epoch(); }
ServerStatistics Server::statistics() const { return implementation_->statistics(); }
std::vector<stream::SessionStats> Server::sessions() const { return implementation_->sessions(); }
void Server::Stop(const std::string& reason) { implementation_->Stop(reason); }
void Server::Drain(const std::string& reason, std::function<void()> done) {
  implementation_->Drain(reason, std::move(done));
}
void Server::SetLimits(const SessionLimits& limits) { implementation_->SetLimits(limits); }
std::size_t Server::SetAccess(const AccessKeys& keys) { return implementation_->SetAccess(keys); }
const ServerOptions& Server::options() const { return implementation_->options(); }

Result<void> MarkerQueue::Add(const v1::Marker& marker, const std::string& client,
                              std::int64_t arrived_ns) {
  if (marker.text().empty() || marker.text().size() > kMostBytes) {
    return UsageError("its text has " + std::to_string(marker.text().size()) +
                      " bytes; it may have 1 to " + std::to_string(kMostBytes));
  }
  const std::int64_t host_ns = marker.host_ns() == 0 ? arrived_ns : marker.host_ns();
  // As numbers: the difference of two such integers may not fit into one.
  const double before_s = 1e-9 * (static_cast<double>(arrived_ns) - static_cast<double>(host_ns));
  if (before_s > kMostBeforeS || before_s < -kMostAfterS) {
    return UsageError(
        "its host_ns is more than 60 s before its arrival, or more than 1 s after it; send the "
        "server's CLOCK_MONOTONIC (your own plus the clock offset), or 0 for the arrival");
  }
  if (waiting_.events_size() >= kMostWaiting) {
    return Failure(std::to_string(kMostWaiting) +
                   " markers wait for the next tick already; send it again");
  }
  v1::Event& event = *waiting_.add_events();
  event.set_kind(v1::Event::KIND_MARKER);
  event.set_host_ns(host_ns);
  event.set_text(marker.text());
  if (marker.has_value()) event.mutable_marker()->set_value(marker.value());
  event.mutable_marker()->set_received_ns(arrived_ns);
  event.mutable_marker()->set_client(client);
  return {};
}

void MarkerQueue::MoveTo(std::vector<ChannelBytes>& channels) {
  constexpr std::uint32_t kEvents = v1::Tick::kEventsFieldNumber;
  auto channel = std::find_if(channels.begin(), channels.end(),
                              [](const ChannelBytes& one) { return one.field == kEvents; });
  if (channel == channels.end()) channel = channels.insert(channels.end(), {kEvents, ""});
  // The bytes of two Events, one behind the other, are an Events with the entries of both.
  waiting_.AppendToString(&channel->bytes);
  waiting_.Clear();
}

namespace {

std::size_t RingTicks(const ServerOptions& options) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(options.ring_s * options.tick_rate_hz)));
}

}  // namespace

Publication::Publication(const ServerOptions& options)
    : max_tick_bytes_(options.max_message_out_bytes - kMaxTickHeadBytes),
      ring_(RingTicks(options), options.ring_max_bytes) {
  for (const Channel& channel : options.channels) {
    fields_.push_back(channel.field);
    if (channel.retained) retained_.insert(channel.field);
  }
}

/// Finds the channels that a tick has space for; returns the bytes of their fields.
std::size_t Publication::Fit(const std::vector<ChannelBytes>& channels) {
  std::size_t size = 0;
  fitting_.clear();
  for (const ChannelBytes& channel : channels) {
    const std::size_t bytes = FieldBytes(channel.field, channel.bytes.size());
    const bool known = std::find(fields_.begin(), fields_.end(), channel.field) != fields_.end();
    if (size + bytes > max_tick_bytes_ || !known) {
      ++channels_left_out_;
      left_out_field_ = channel.field;
      continue;
    }
    size += bytes;
    fitting_.push_back(&channel);
  }
  return size;
}

std::shared_ptr<Tick> Publication::Serialise(const TickNumber& number,
                                             const std::vector<ChannelBytes>& channels) {
  auto tick = std::make_shared<Tick>();
  tick->sequence = number.sequence;
  tick->host_ns = number.host_ns;
  tick->missing_from = number.missing_from;
  const std::size_t size = Fit(channels);
  char head[kMaxTickHeadBytes];
  tick->head_bytes = EncodeTickHead({epoch_, number.sequence, number.host_ns}, size, head);
  tick->bytes.reserve(tick->head_bytes + size);
  tick->bytes.append(head, tick->head_bytes);
  tick->slices.reserve(fitting_.size());
  for (const ChannelBytes* channel : fitting_) AppendField(channel->field, channel->bytes, *tick);
  return tick;
}

TickNumber Publication::Next(std::int64_t host_ns) const {
  const std::uint64_t following = last_sequence_ + 1;
  return {following + left_out_next_, host_ns, left_out_next_ == 0 ? 0 : following};
}

void Publication::KeepRetained(const SharedTick& tick) {
  for (const Slice& slice : tick->slices) {
    if (retained_.count(slice.field) > 0) last_values_[slice.field] = tick;
  }
}

SharedTick Publication::Publish(const TickNumber& number,
                                const std::vector<ChannelBytes>& channels) {
  SharedTick tick = Serialise(number, channels);
  last_sequence_ = number.sequence;
  left_out_next_ = 0;
  return tick;
}

void Publication::Keep(const SharedTick& tick) {
  KeepRetained(tick);
  ring_.Push(tick);
}

void Publication::BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained) {
  last_sequence_ = number.sequence;
  KeepRetained(Serialise(number, retained));
}

SharedTick Publication::Snapshot(std::uint64_t sequence, std::int64_t host_ns) const {
  auto tick = std::make_shared<Tick>();
  tick->sequence = sequence;
  tick->host_ns = host_ns;
  for (const auto& [field, source] : last_values_) {
    const Slice& slice = *source->Find(field);
    if (tick->bytes.size() + slice.size > max_tick_bytes_) continue;
    tick->slices.push_back({field, tick->bytes.size(), slice.size});
    tick->bytes.append(source->bytes, slice.begin, slice.size);
  }
  return tick;
}

std::vector<ChannelBytes> ChannelsOf(const v1::Tick& tick) {
  std::vector<ChannelBytes> channels;
  std::vector<const google::protobuf::FieldDescriptor*> present;
  const google::protobuf::Reflection& fields = *tick.GetReflection();
  fields.ListFields(tick, &present);
  for (const google::protobuf::FieldDescriptor* field : present) {
    if (field->message_type() == nullptr) continue;
    channels.push_back({static_cast<std::uint32_t>(field->number()),
                        fields.GetMessage(tick, field).SerializeAsString()});
  }
  return channels;
}

}  // namespace footing::transport

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/limits.h"
#include "common/net/tick.h"
#include "common/stream/server_stats.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// A channel is one top-level field of v1::Tick; its name is the field's name.
struct Channel {
  std::string name;
  std::uint32_t field = 0;
  bool retained = false;  ///< Its last value is part of every snapshot.
};

/// Which tick of its source a relay hands on.
struct TickNumber {
  std::uint64_t sequence = 0;
  std::int64_t host_ns = 0;
  std::uint64_t missing_from = 0;  ///< First of those lost right in front of it; 0: none.
};

/// By what clients over TCP and TLS get their roles.
struct AccessKeys {
  std::string token;                        ///< Gives the role control; empty: none does.
  std::string view_token;                   ///< Gives the role view; empty: none does.
  std::map<std::string, v1::Role> clients;  ///< By the fingerprint of a certificate, over TLS.

  bool has_token() const { return !token.empty() || !view_token.empty(); }
  /// Somebody could come in over TLS.
  bool has_keys() const { return has_token() || !clients.empty(); }
};

/// Identity, channels and limits of a server.
struct ServerOptions : AccessKeys {
  std::string server_id;  ///< "footingd" or "footing-sim".
  std::string version;
  std::vector<Channel> channels;
  double tick_rate_hz = 100;
  double ring_s = 30;
  std::size_t ring_max_bytes = 64u << 20;
  std::uint32_t max_message_in_bytes = 64u << 10;
  std::uint32_t max_message_out_bytes = 1u << 20;
  std::uint32_t max_queue_ticks = 1024;
  std::uint64_t epoch = 0;  ///< Epoch of the source, for a relay; 0: a random one.
  SessionLimits sessions;
  /// Key and certificate for TLS, made where the file is missing when it first listens on tls:;
  /// none: there is no TLS.
  std::optional<std::string> identity_file;
  /// Listen beyond this host without encryption: anyone on the network path can read everything.
  bool insecure_lan = false;
  double hello_deadline_s = 3;
  double wrong_token_wait_s = 2;  ///< Shorter than the 3 s after which a client gives up.
  double ping_interval_s = 1;
  double dead_after_s = 10;
  std::vector<std::string> capabilities;
  /// Publishes the markers of its clients as events, on the channel `events`, which it then has.
  bool takes_markers = false;
  /// The clock of all stamps; CLOCK_MONOTONIC when none is given.
  std::function<std::int64_t()> now_ns;
};

/// One field of a tick, serialised once for all sessions: the bytes of the channel's message,
/// without tag and length.
struct ChannelBytes {
  std::uint32_t field = 0;
  std::string bytes;
};

/// Who asks.
struct SessionInfo {
  std::uint64_t session = 0;
  std::string client_name;
  v1::Role role = v1::ROLE_VIEW;
};

/// A line for the log, and what it is about: 0 and empty are none.
struct OverloadLine {
  std::string text;
  std::uint64_t session = 0;
  std::string channel = {};
};

/// Calls that a server makes to the program that it is part of.
struct ServerHandlers {
  /// A command of a session with role control or admin. Roles below, and texts and numbers that no
  /// command may have (CheckContent), are refused before this is called. The server itself carries
  /// out markers and what concerns sessions. Without a result the
  /// answer comes later, by Server::Answer().
  std::function<std::optional<v1::CommandResult>(const SessionInfo&, const v1::Command&)>
      on_command;
  /// A session is gone: end its leases.
  std::function<void(const SessionInfo&)> on_session_end;
  /// At most one line in 10 s of each kind: a session is slowed or ended, ticks are late, a channel
  /// is too long for a tick, or a client is refused, for each reason.
  std::function<void(const OverloadLine&)> on_overload = {};
  /// A message of the device socket, from a session with role control or admin, and when it came.
  /// Empty: the server takes no devices, and a session that sends one is ended.
  std::function<void(const SessionInfo&, std::int64_t received_ns, const v1::DeviceEnvelope&)>
      on_device = {};
};

/// Counts of a server since its start, and its present sessions.
struct ServerStatistics {
  std::size_t sessions = 0;
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::uint64_t denied = 0;             ///< Without a right token or a known certificate.
  std::uint64_t ticks_dropped = 0;      ///< Ticks of full session queues, all sessions together.
  std::uint64_t channels_left_out = 0;  ///< Did not fit into a tick, or are not a channel.
  std::uint64_t ring_bytes = 0;
  std::uint64_t slowed = 0;      ///< Times that a session had to wait for its budget.
  std::uint64_t late_ticks = 0;  ///< As reported by NoteLateTicks().
};

/// Markers of clients that wait for the next tick. A plain value.
class MarkerQueue {
 public:
  static constexpr int kMostBytes = 1024;  ///< Longest text.
  /// More have to come with a later tick: they would displace the channels of this one.
  static constexpr int kMostWaiting = 128;
  static constexpr double kMostBeforeS = 60;  ///< Before its arrival, for a person who is late.
  static constexpr double kMostAfterS = 1;    ///< More is another clock, not an estimate's error.

  /// Usage error: the text is empty or too long, or the time is of another clock. Failure: too many
  /// wait. Times are of the server's clock.
  Result<void> Add(const v1::Marker& marker, const std::string& client, std::int64_t arrived_ns);
  bool empty() const { return waiting_.events_size() == 0; }
  /// Adds those that wait to the channels of a tick, behind the events that it has already.
  void MoveTo(std::vector<ChannelBytes>& channels);

 private:
  v1::Events waiting_;
};

/// Publishes ticks to any number of sessions. Everything runs on the io_context's one thread.
///
/// A tick is serialised once; each session gets a gather-write of a small head of its own and the
/// shared bytes of its channels. A slow session loses ticks of its own queue (and is informed by a
/// Gap) or is ended, by the policy it chose; it never slows another. See docs/protocol.md.
class Server {
 public:
  Server(boost::asio::io_context& io, ServerOptions options, ServerHandlers handlers);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Opens one more listener. A Unix socket left over by a dead server is replaced; one in use, or
  /// a TCP port in use, is an error that says so. TCP beyond loopback is refused, unless
  /// insecure_lan is set and there is a token; TLS, unless there is a token or a client.
  Result<void> Listen(const Address& address);

  /// The bound address of the i-th listener (the real port where 0 was asked for).
  Address ListeningOn(std::size_t index) const;

  /// Publishes one tick of the given channels; returns its sequence, from 1.
  std::uint64_t Publish(std::int64_t host_ns, const std::vector<ChannelBytes>& channels);

  /// For a relay, which hands on the ticks of another server under their own numbers: where that
  /// one stands, and what its retained channels hold. Before the first session.
  void BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained);
  /// One tick of the source; its sequence is above the last one's. What is neither published nor
  /// missing in between was left out on purpose, as for max_hz.
  void Relay(const TickNumber& number, const std::vector<ChannelBytes>& channels);

  /// Answers a command that on_command left open; `result` has its id. The session may be gone.
  void Answer(std::uint64_t session, const v1::CommandResult& result);

  /// A message to the devices of a session; dropped if the session does not read, or is gone.
  void SendDevice(std::uint64_t session, const v1::DeviceEnvelope& message);
  /// Says goodbye to one session, with the reason.
  void EndSession(std::uint64_t session, const std::string& reason);

  /// The owner could not publish `count` ticks in time. The next tick's sequence leaves them out,
  /// and a Gap in front of it says so; they are counted, logged and said to every session, the last
  /// two at most once in 10 s.
  void NoteLateTicks(std::uint64_t count);

  /// Fingerprint of the certificate that it shows on tls:; empty while it listens on none.
  std::string fingerprint() const;

  std::uint64_t epoch() const;
  ServerStatistics statistics() const;
  /// Statistics of each session that was welcomed.
  std::vector<stream::SessionStats> sessions() const;

  /// Says goodbye to every session and closes; what waits for them is lost.
  void Stop(const std::string& reason);
  /// The same, but each session first gets what waits for it. No further connection is accepted,
  /// and the owner publishes no more. `done` is called once, on the loop, when the last session has
  /// ended; the owner decides how long it waits for that.
  void Drain(const std::string& reason, std::function<void()> done);
  /// For sessions that come from now on.
  void SetLimits(const SessionLimits& limits);
  /// Other keys, at once: sessions that came in by what is gone are ended with the reason. Returns
  /// how many.
  std::size_t SetAccess(const AccessKeys& keys);
  const ServerOptions& options() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// Published ticks: the ring of the last ones and the last value of every retained channel. All
/// sessions read it.
class Publication {
 public:
  explicit Publication(const ServerOptions& options);

  /// Epoch in the heads of ticks from now on.
  void set_epoch(std::uint64_t epoch) { epoch_ = epoch; }

  /// Serialises a tick once. Channels that would make it longer than max_message_out_bytes are left
  /// out, and so are fields that are not a channel. Its sequence is above the last one's. Keep() it
  /// once it is on its way.
  SharedTick Publish(const TickNumber& number, const std::vector<ChannelBytes>& channels);
  /// From now on it is part of the ring, and its retained channels of every snapshot.
  void Keep(const SharedTick& tick);

  /// The number of the next tick of the owner's rhythm; LeaveOut() makes a hole in front of it.
  TickNumber Next(std::int64_t host_ns) const;
  void LeaveOut(std::uint64_t ticks) { left_out_next_ += ticks; }

  /// See Server::BeginAt().
  void BeginAt(const TickNumber& number, const std::vector<ChannelBytes>& retained);

  /// The last values of the retained channels, as one tick with the given sequence.
  SharedTick Snapshot(std::uint64_t sequence, std::int64_t host_ns) const;

  const TickRing& ring() const { return ring_; }
  const std::set<std::uint32_t>& retained() const { return retained_; }
  std::uint64_t last_sequence() const { return last_sequence_; }
  std::uint64_t channels_left_out() const { return channels_left_out_; }
  /// The field of the newest channel that was left out.
  std::uint32_t left_out_field() const { return left_out_field_; }

 private:
  std::shared_ptr<Tick> Serialise(const TickNumber& number,
                                  const std::vector<ChannelBytes>& channels);
  std::size_t Fit(const std::vector<ChannelBytes>& channels);
  void KeepRetained(const SharedTick& tick);

  std::vector<std::uint32_t> fields_;  ///< Side by side: a tick finds a tree's nodes cold.
  std::set<std::uint32_t> retained_;
  std::vector<const ChannelBytes*> fitting_;  ///< Channels of the tick being made.
  std::size_t max_tick_bytes_;
  TickRing ring_;
  std::map<std::uint32_t, SharedTick> last_values_;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t epoch_ = 0;
  std::uint64_t left_out_next_ = 0;
  std::uint64_t channels_left_out_ = 0;
  std::uint32_t left_out_field_ = 0;
};

/// The channels of a tick, each serialised, as Server::Publish() takes them.
std::vector<ChannelBytes> ChannelsOf(const v1::Tick& tick);

}  // namespace footing::transport

#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/known_servers.h"
#include "common/net/tls_context.h"
#include "common/runtime/timer.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Address, identity and subscription of a client.
struct ClientOptions {
  Address address;
  std::string client_name;
  v1::Role role = v1::ROLE_VIEW;
  std::string token;
  std::vector<std::string> channels;  ///< Empty: all.
  double max_hz = 0;                  ///< 0: every tick.
  v1::QueuePolicy policy = v1::QUEUE_POLICY_DROP_OLDEST;
  std::uint32_t queue_ticks = 256;
  bool from_ring_start = false;  ///< First everything that the server's ring still holds.
  /// Subscribes to nothing: the session is there for SendDevice().
  bool attaches_devices = false;
  std::uint32_t max_message_bytes = 1u << 20;
  std::size_t max_queued_frames = 1024;  ///< Messages that wait while the server does not read.
  double backoff_min_s = 0.1;
  double backoff_max_s = 1;
  double refused_wait_s = 5;  ///< Between tries when the server says no, times 0.5 to 1.
  double stale_after_s = 3;
  double dead_after_s = 10;
  double ping_interval_s = 0.25;  ///< For the clock offset, and to notice that nothing comes.
  /// The clock of all stamps; CLOCK_MONOTONIC when none is given.
  std::function<std::int64_t()> now_ns;
};

/// Shown to the user as they are.
enum class LinkState {
  kConnecting,  ///< Dialling, or waiting to dial again.
  kLive,
  kStale,    ///< Nothing for 3 s.
  kRefused,  ///< The server said no; it is asked again every few seconds.
};

/// The server's clock minus ours, from the pings with the shortest round trip.
struct ClockOffset {
  bool valid = false;
  std::int64_t offset_ns = 0;       ///< Add it to a local stamp to get the server's.
  std::int64_t uncertainty_ns = 0;  ///< Half the round trip: the truth is within.
};

/// A server's clock that seems to differ by less is our own: no two hosts start so close together.
inline constexpr std::int64_t kSameClockNs = 5'000'000;

/// An instant of ours on the clock of the server at that address, such as for a marker; 0: the
/// clock's offset is not known yet. On one host it is the same clock, and an estimate of its offset
/// would only add its own error, which is milliseconds on a busy host.
inline std::int64_t OnServersClock(const Address& address, const ClockOffset& clock,
                                   std::int64_t our_ns) {
  if (address.kind == Address::Kind::kUnix) return our_ns;
  if (!clock.valid) return 0;
  const bool same = clock.offset_ns < kSameClockNs && clock.offset_ns > -kSameClockNs;
  return same ? our_ns : our_ns + clock.offset_ns;
}

/// Calls that a client makes for each message and change of its link.
struct ClientHandlers {
  std::function<void(const v1::Welcome&)> on_welcome;
  std::function<void(const v1::Tick&)> on_tick;
  std::function<void(const v1::Gap&)> on_gap;
  /// `why` is a line for a person: what it waits for, or the server's own words.
  std::function<void(LinkState, const std::string& why)> on_state;
  /// Something slows this session or the server.
  std::function<void(const v1::Notice&)> on_notice = {};
  /// The server said no, before on_state says so.
  std::function<void(const v1::Refused&)> on_refused = {};
  /// With `attaches_devices`: a message to a device.
  std::function<void(const v1::DeviceEnvelope&)> on_device = {};
};

/// Connects, keeps connected (0.1 s to 1 s between tries, with jitter) and resumes by sequence.
/// A resume asks for the ticks since the last one received; with the policy latest there is none.
/// Everything runs on the io_context's one thread; handlers are called there, never from within a
/// call to this class, but for `done` of Send() when the link is down.
class Client {
 public:
  Client(boost::asio::io_context& io, ClientOptions options, ClientHandlers handlers);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void Start();
  void Stop();
  /// Sends what is queued, then closes with this reason; does not dial again.
  void Finish(const std::string& reason);

  /// Sends a command (its id is filled in) and calls `done` with the answer, or with ok = false
  /// when the link is down or no answer comes within the deadline.
  void Send(v1::Command command, std::function<void(const v1::CommandResult&)> done);

  /// Sends a message of a device. False when it is dropped: the link is down, its queue is full,
  /// or it is longer than kMaxDeviceBytes.
  bool SendDevice(const v1::DeviceEnvelope& message);

  /// Asks for missing ticks; they arrive in on_tick flagged refilled.
  void Refill(std::uint64_t from_sequence, std::uint64_t to_sequence);

  LinkState state() const;
  ClockOffset clock() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// First message of a client. Over TCP it has the token of the environment where the options have
/// none; an error when its file cannot be used. Beyond this host a token goes over tcp:, where
/// everybody on the way can read it, only with FOOTING_INSECURE_LAN=1; an error otherwise.
Result<v1::Envelope> MakeHello(const ClientOptions& options);

/// Asks for the ticks behind `last_sequence` of `last_epoch`, or, when that is 0, for those that
/// the options say. `epoch` is that of the server that welcomed us.
v1::Envelope MakeSubscribe(const ClientOptions& options, std::uint64_t epoch,
                           std::uint64_t last_epoch, std::uint64_t last_sequence);

/// Asks for ticks that are missing, both ends included.
v1::Envelope MakeRefill(std::uint64_t from_sequence, std::uint64_t to_sequence);
v1::Envelope MakePing(std::uint64_t id, std::int64_t now_ns);
v1::Envelope MakePong(const v1::Ping& ping, std::int64_t arrived_ns, std::int64_t now_ns);

/// Text of a client that finds no server: the dial's error, and the reason that the server gave
/// when it ended the last connection, if it did.
std::string WaitingText(const std::string& dial_error, const std::string& last_reason);

/// The commands of a client that wait for their answers. Each gets exactly one call of `done`.
class PendingCommands {
 public:
  using Done = std::function<void(const v1::CommandResult&)>;

  /// Gives the command its id and waits for its answer until its deadline. Nothing, and `done` is
  /// called, when too many wait already.
  std::optional<v1::Command> Add(v1::Command command, const Done& done, std::int64_t now_ns);
  /// Refuses a command that cannot be sent.
  void Refuse(const Done& done, const std::string& why);
  void TakeAnswer(const v1::CommandResult& answer);
  /// Fails those whose deadline has passed.
  void Expire(std::int64_t now_ns);
  /// Fails all.
  void Fail(const std::string& why);

 private:
  struct Waiting {
    Done done;
    std::int64_t deadline_ns = 0;
  };

  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, Waiting> waiting_;
};

/// Deadline of a command that states none.
inline constexpr std::uint32_t kDefaultDeadlineMs = 1000;

/// The answers to a session's last commands, so that a repeated id gets its first answer again.
class Answers {
 public:
  explicit Answers(std::size_t capacity) : capacity_(capacity) {}

  /// Null when that id was not answered, or too long ago.
  const v1::CommandResult* Find(std::uint64_t id) const {
    const auto found = by_id_.find(id);
    return found == by_id_.end() ? nullptr : &found->second;
  }

  void Remember(const v1::CommandResult& answer) {
    if (!by_id_.emplace(answer.id(), answer).second) return;
    order_.push_back(answer.id());
    if (order_.size() <= capacity_) return;
    by_id_.erase(order_.front());
    order_.pop_front();
  }

 private:
  std::size_t capacity_;
  std::deque<std::uint64_t> order_;
  std::unordered_map<std::uint64_t, v1::CommandResult> by_id_;
};

/// Which certificate a client takes from a tls: server. The first one that it sees is remembered in
/// the user's file of known servers, and logged; another one later is refused, since nobody can say
/// whether the server made a new one or somebody else answers in its place.
class ServerTrust {
 public:
  static std::shared_ptr<ServerTrust> Of(const Address& address);

  ServerTrust(std::string server, tls::KnownServers known)
      : server_(std::move(server)), known_(std::move(known)) {}

  /// Why the certificate is refused; empty when it is not.
  std::string WhyRefused(const std::string& fingerprint);
  /// The server has proved that the certificate is its own: a new one is remembered. Why it is
  /// refused all the same; empty when it is not.
  std::string OnProved(const std::string& fingerprint);

 private:
  std::string server_;
  tls::KnownServers known_;
  bool is_new_ = false;
};

/// The name of a server in the file of known servers: "HOST:PORT".
std::string KnownName(const Address& address);

/// TLS context of clients: the user's own certificate where there is one, which `footing-ctl trust
/// --client` makes (see tls::ClientIdentityFile). Made once for all of a loop, since that takes as
/// long as a handshake's computations.
Result<tls::Context> ClientContext(boost::asio::io_context& io);

/// How long to wait between tries: doubled each time, from `min_s` to `max_s`, times a random
/// factor from 0.5 to 1 so that many clients do not come back at one instant. A plain value.
class Backoff {
 public:
  Backoff(double min_s, double max_s) : min_s_(min_s), max_s_(max_s), next_s_(min_s) {}

  /// `random` is uniform in [0, 1).
  double Next(double random) {
    const double wait_s = next_s_ * (0.5 + 0.5 * random);
    next_s_ = next_s_ * 2 < max_s_ ? next_s_ * 2 : max_s_;
    return wait_s;
  }
  void Reset() { next_s_ = min_s_; }

 private:
  double min_s_;
  double max_s_;
  double next_s_;
};

/// Waits between the tries of one link.
class Redial {
 public:
  Redial(boost::asio::io_context& io, double min_s, double max_s)
      : timer_(io), backoff_(min_s, max_s), random_(std::random_device()()) {}

  /// Calls `dial` on the io_context after the next wait of Backoff.
  void Later(std::function<void()> dial) { timer_.After(backoff_.Next(Random()), std::move(dial)); }
  /// The same after half this time to the whole of it; the next wait of Backoff stays as it is.
  void Within(double most_s, std::function<void()> dial) {
    timer_.After(most_s * (1 + Random()) / 2, std::move(dial));
  }
  /// The link is up: the next wait is short again.
  void Reset() { backoff_.Reset(); }
  void cancel() { timer_.cancel(); }

 private:
  double Random() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  timer::Timer timer_;
  Backoff backoff_;
  std::mt19937 random_;
};

}  // namespace footing::transport

#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/net/address.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

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
  std::uint32_t max_message_bytes = 1u << 20;
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

  /// Sends a command (its id is filled in) and calls `done` with the answer, or with ok = false
  /// when the link is down or no answer comes within the deadline.
  void Send(v1::Command command, std::function<void(const v1::CommandResult&)> done);

  /// Asks for missing ticks; they arrive in on_tick flagged refilled.
  void Refill(std::uint64_t from_sequence, std::uint64_t to_sequence);

  LinkState state() const;
  ClockOffset clock() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::transport

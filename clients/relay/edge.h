#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/relay/channels.h"
#include "clients/relay/nats_link.h"
#include "common/base/result.h"
#include "common/net/access.h"
#include "common/net/clock_offset.h"
#include "common/net/server.h"
#include "common/runtime/timer.h"

namespace footing::relay {

/// Options of an edge relay.
struct EdgeOptions {
  std::string site;
  std::string server;  ///< As the server calls itself, such as footingd.
  NatsOptions nats;
  std::vector<transport::Address> listen;
  double rate_hz = 30;  ///< Rate of each channel of samples; 0: every tick.
  transport::SessionLimits sessions;
  transport::AccessSettings access;
  double silent_after_s = 3;  ///< Viewers are sent away after this long without a tick.
};

/// State and counts of an edge relay.
struct EdgeReport {
  std::uint64_t ticks = 0;  ///< Ticks received.
  std::uint64_t missing = 0;
  std::uint64_t left_out = 0;  ///< Ticks left out to keep the rate.
  std::uint64_t dropped = 0;   ///< Ticks dropped at full queues, all viewers together.
  std::uint64_t accepted = 0;  ///< Connections accepted.
  std::uint64_t sessions = 0;  ///< Present sessions.
  bool serving = false;
  bool nats_up = false;
};

/// Serves a server's ticks out of NATS in that server's place, with its epoch, sequences and clock.
/// It listens while the server's ticks come. Everything runs on the io_context's one thread.
class Edge {
 public:
  /// `on_broken`: it cannot listen, and will not later.
  Edge(boost::asio::io_context& io, EdgeOptions options,
       std::function<void(const Error&)> on_broken);
  Edge(const Edge&) = delete;
  Edge& operator=(const Edge&) = delete;

  void Start();
  /// Says goodbye to the viewers; `done` is called when they are gone.
  void Drain(const std::string& reason, std::function<void()> done);
  void Stop();
  EdgeReport report() const;
  /// Present activity or wait, as a line for a person.
  const std::string& state() const { return state_; }

 private:
  void OnMessage(const nats::Message& message);
  void OnPong(const v1::Pong& pong);
  void OnWelcome(const v1::Welcome& welcome);
  void OnTick(const v1::Tick& tick);
  void OnSnapshot(const v1::Tick& tick);
  void Ask(const v1::Envelope& question);
  void AskForSnapshot();
  void Begin(const v1::Tick& snapshot);
  transport::ServerOptions OptionsOf(const v1::Welcome& welcome) const;
  void End(const std::string& reason);
  /// Adds what the present server has counted.
  void Count(EdgeReport& report) const;
  void OnPulse();
  void ArmPulse();
  void Say(const std::string& state);

  boost::asio::io_context& io_;
  EdgeOptions options_;
  std::function<void(const Error&)> on_broken_;
  std::string inbox_;
  NatsLink nats_;
  timer::Timer pulse_;
  transport::ClockProbes probes_;
  v1::Welcome welcome_;
  std::int64_t asked_ns_ = 0;
  std::int64_t heard_ns_ = 0;  ///< The last tick that was new.
  /// The state as of this sequence, or of a later one, must be fetched: a retained channel may have
  /// been lost in front of it. 0: nothing was.
  std::uint64_t wanted_ = 0;
  std::optional<Thinner> thinner_;
  std::unique_ptr<transport::Server> server_;
  std::unique_ptr<transport::Server> former_;  ///< Former server, until its viewers have seen why.
  std::string state_;
  EdgeReport report_;
};

}  // namespace footing::relay

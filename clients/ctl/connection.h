#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/rig/follower.h"
#include "common/runtime/timer.h"
#include "common/stream/device.h"
#include "common/stream/server_stats.h"
#include "common/stream/setup.h"
#include "footing/v1/session.pb.h"

namespace footing::ctl {

/// Options of a session with footingd.
struct ConnectionOptions {
  transport::Address address;
  std::vector<std::string> channels = {"status", "setup"};  ///< "motion", "boards", ... as needed.
  double max_hz = 0;                                        ///< 0: every tick.
  double connect_within_s = 3;
  v1::Role role = v1::ROLE_CONTROL;
};

/// kInterrupted: SIGINT or SIGTERM; every later wait ends at once, too.
using timer::Waited;

/// A connection to footingd as a console program wants it: every call waits, and ticks are handled
/// while it waits. One thread. While it exists SIGINT and SIGTERM end waits, not the program.
class Connection {
 public:
  /// Connects with the role of the options; where that is control, over TCP with the role view if
  /// the server does not give control. Takes the first snapshot. NoDevice (exit 3) when footingd is
  /// not there within the time, Failure with its words when it refuses.
  static Result<std::unique_ptr<Connection>> Open(ConnectionOptions options);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The newest list, in the order of footingd; empty before the first device.
  const std::vector<stream::DeviceStatus>& status() const;
  /// The newest set-up of every rig.
  const std::vector<stream::RigSetup>& setup() const;
  /// How the server fares, at most about a second ago; none before the first, or of an older
  /// server.
  const std::optional<stream::ServerStats>& stats() const;
  const v1::Welcome& welcome() const;
  /// Newest host_ns of footingd's ticks: its CLOCK_MONOTONIC; 0 before the first one.
  std::int64_t server_ns() const;
  /// An instant of this host's CLOCK_MONOTONIC on that of footingd; 0: not known yet.
  std::int64_t OnServersClock(std::int64_t our_ns) const;
  bool live() const;
  /// A line for a person on how the connection stands.
  const std::string& link() const;

  /// Server's notice since the last call on a cause that slows it or this session; empty: none.
  std::string TakeNotice();

  /// A tick of the channels asked for, and the same as a follower of rigs reads it.
  using OnTick = std::function<void(const v1::Tick& tick, const rig::Tick& sensors)>;
  /// Called for every tick while a call waits.
  void set_on_tick(OnTick on_tick);

  /// Sends a command and waits for the answer. A refusal is an error with footingd's message.
  Result<v1::CommandResult> Call(v1::Command command, double within_s = 3);

  /// Handles ticks for that time. `condition` is asked after every tick.
  Waited RunFor(double duration_s);
  Waited RunUntil(const std::function<bool()>& condition, double within_s);

  /// The device of a serial, a number within the epoch, or RIG/ROLE or ROLE ("left_hand").
  /// NoDevice with a list of what there is otherwise.
  Result<stream::DeviceStatus> Find(const std::string& name) const;

 private:
  class Implementation;
  explicit Connection(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::ctl

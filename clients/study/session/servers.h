#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "clients/study/session/console.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/stream/device.h"
#include "common/stream/gait.h"
#include "common/stream/study.h"
#include "common/stream/track.h"
#include "common/stream/trial.h"
#include "common/stream/user_interface.h"
#include "footing/v1/session.pb.h"

namespace footing::study {

/// Time in motion of a participant: the time during which footingd reports that a controller on the
/// body moves. Thumbs on a joystick and weight on boards do not count.
class ActiveTime {
 public:
  /// Takes each tick; `host_ns` is the server's clock. Time across a gap in the stream, or before
  /// the first tick, is not counted.
  void Add(std::int64_t host_ns, bool moving);
  double seconds() const { return seconds_; }

 private:
  std::int64_t last_ns_ = 0;
  double seconds_ = 0;
};

/// State of a frame's first character, as far as a session needs it.
struct SimulationFrame {
  std::int64_t host_ns = 0;  ///< Time of its tick on the clock of footing-sim.
  stream::TrialState trial;  ///< Without an id before the first trial.
  stream::Gait commanded_gait = stream::Gait::kUnspecified;
  stream::Gait gait = stream::Gait::kUnspecified;  ///< The character's own.
  stream::InterfaceState interface;
};

/// Connections to footingd, for the health of the devices, and to footing-sim, for trials.
class Servers {
 public:
  /// Addresses of the servers and the holder of their leases.
  struct Options {
    transport::Address sensor;
    transport::Address simulation;
    std::string holder;  ///< Holder of both leases: who leads the session, for others.
  };

  /// Takes the leases of both, which are released in the destructor. NoDevice when one of them is
  /// not there within a few seconds; a failure with its holder's name when another program has a
  /// lease. `active` goes on counting as long as the connection lasts.
  static Result<std::unique_ptr<Servers>> Open(Console& console, const Options& options,
                                               ActiveTime& active);
  ~Servers();
  Servers(const Servers&) = delete;
  Servers& operator=(const Servers&) = delete;

  const std::vector<stream::DeviceStatus>& devices() const;
  /// The newest frame.
  const SimulationFrame& frame() const;
  const stream::Track& track() const;
  /// Both connections stand, and the leases are held, but for a footingd that others may use.
  bool live() const;
  /// True once an activity with the servers cannot go on. A connection that is back within seconds
  /// breaks nothing: its ticks come after all.
  bool broken() const;
  /// Times that a connection was down.
  std::uint64_t breaks() const;
  /// Fails once somebody has taken a lease over: this session no longer controls that server.
  Result<void> CheckLeases() const;
  /// Gives footingd's lease back, so that others may set devices up, until KeepDevices().
  void LendDevices();
  /// Asks for it again. WhyNoDevices() says why this session does not have it yet; empty: it has.
  void KeepDevices();
  std::string WhyNoDevices() const;
  /// State of the connections that are not live, for a person; empty: both are live.
  std::string WhyNotLive() const;

  /// Called while the console waits.
  void set_on_frame(std::function<void(const SimulationFrame&)> on_frame);
  void set_on_event(std::function<void(const v1::Event&)> on_event);

  /// Makes an interface the one in force, with what turns and the text of its mapping table (empty:
  /// the built-in one): the only place where a study changes it. A trial that goes on, such as
  /// practice or what a crash has left, is stopped. Returns when the frames show it.
  Result<void> UseInterface(const std::string& interface, const std::string& turn_by,
                            const std::string& table);

  /// Publishes the session's state for all screens; not waited for.
  void Show(const stream::StudyState& state);

  /// Sends a command to footing-sim and waits for the answer; a refusal is a failure with its text.
  Result<void> Call(v1::Command command);

 private:
  class Implementation;
  explicit Servers(std::unique_ptr<Implementation> implementation);
  Result<void> StopTrial();

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::study

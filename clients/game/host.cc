#include "clients/game/host.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <iostream>
#include <optional>

#include "clients/game/messages.h"
#include "common/runtime/clock.h"
#include "common/net/client.h"
#include "common/net/run_folder.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::game {
namespace {

namespace asio = boost::asio;

/// Inclinations older than this are not the builder's any more.
constexpr double kHandS = 0.5;
constexpr std::uint32_t kQueueTicks = 1024;
constexpr auto kLine = std::chrono::seconds(1);
/// What was ordered last is still sent, and its answer awaited, for this long at the end.
constexpr auto kLeaveWithin = std::chrono::milliseconds(500);

class Host {
 public:
  explicit Host(const HostOptions& options)
      : options_(options),
        director_(options.game),
        signals_(io_, SIGINT, SIGTERM),
        line_(io_),
        end_(io_),
        started_ns_(clock::MonotonicNs()),
        sensor_(io_, SensorOptions(), SensorHandlers()),
        simulation_(io_, SimulationOptions(), SimulationHandlers()) {}

  Result<Report> Run() {
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) End();
    });
    sensor_.Start();
    simulation_.Start();
    LineLater();
    io_.run();
    if (failed_) return *failed_;
    if (seen_.track().segments.empty()) return WhyNoTrack();
    if (!sensed_) {
      return NoDevice("no footingd: " + sensor_link_ +
                      transport::RemedyFor(sensor_link_,
                                           "start it with: footingd, or name its address with "
                                           "--sensor"));
    }
    return MakeReport(director_.game(), seen_, PassedS());
  }

 private:
  transport::ClientOptions SensorOptions() const {
    transport::ClientOptions client;
    client.address = options_.sensor;
    client.client_name = options_.game.host;
    client.channels = {"features", "motion"};
    return client;
  }

  transport::ClientHandlers SensorHandlers() {
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) {
      if (Take(tick, device_, hand_)) inclined_ns_ = clock::MonotonicNs();
    };
    handlers.on_state = [this](transport::LinkState, const std::string& why) {
      sensor_link_ = why;
    };
    handlers.on_welcome = [this](const v1::Welcome&) { sensed_ = true; };
    return handlers;
  }

  // Every tick of footing-sim counts: scores are those that a recording gives.
  transport::ClientOptions SimulationOptions() const {
    transport::ClientOptions client;
    client.address = options_.simulation;
    client.client_name = options_.game.host;
    client.role = v1::ROLE_CONTROL;
    client.channels = {"characters", "events", "track"};
    client.policy = v1::QUEUE_POLICY_RELIABLE;
    client.queue_ticks = kQueueTicks;
    return client;
  }

  transport::ClientHandlers SimulationHandlers() {
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { OnTick(tick); };
    handlers.on_state = [this](transport::LinkState, const std::string& why) { link_ = why; };
    handlers.on_welcome = [this](const v1::Welcome&) { welcomed_ = true; };
    return handlers;
  }

  /// Why there was nothing to play on until the end.
  Error WhyNoTrack() const {
    if (welcomed_) {
      return Failure(options_.simulation.Text() +
                     " has no track: the game needs the gait engine; start it with: footing-sim");
    }
    return NoDevice("no footing-sim: " + link_ +
                    transport::RemedyFor(link_,
                                         "start it with: footing-sim, or name its address with "
                                         "--simulation"));
  }

  double PassedS() const { return NanosecondsToSeconds(clock::MonotonicNs() - started_ns_); }

  void OnTick(const v1::Tick& tick) {
    for (const v1::Event& event : tick.events().events()) {
      if (event.segment_refused()) director_.OnRefused();
    }
    Take(tick, seen_);
    if (ending_ || tick.characters().characters_size() == 0) return;
    hand_.known =
        NanosecondsToSeconds(clock::MonotonicNs() - inclined_ns_) < kHandS && inclined_ns_ != 0;
    if (seen_.track().segments.empty()) return;
    Send(director_.Advance(FrameOf(tick), seen_, hand_));
    if (director_.game().phase == stream::GamePhase::kOver) End();
  }

  /// The state goes first: nobody else starts a trial from then on.
  void Send(const Orders& orders) {
    if (orders.publish) {
      v1::Command command;
      *command.mutable_set_game()->mutable_game() = wire::ToProto(director_.game());
      Send(std::move(command), true);
    }
    if (!orders.start_trial.empty()) {
      v1::Command command;
      command.mutable_start_trial()->set_trial(orders.start_trial);
      command.mutable_start_trial()->set_track(orders.track);
      Send(std::move(command), true);
    }
    if (!orders.stop_trial.empty()) {
      v1::Command command;
      command.mutable_stop_trial()->set_trial(orders.stop_trial);
      Send(std::move(command), false);
    }
    if (orders.append) Send(ToCommand(*orders.append), false);
  }

  void Send(v1::Command command, bool vital) {
    const bool append = command.has_append_segment();
    simulation_.Send(std::move(command), [this, vital, append](const v1::CommandResult& result) {
      if (result.ok() || ending_) return;
      if (append) director_.OnRefused();
      // Without the link there is no game to lose: it goes on when footing-sim is back.
      if (!vital || simulation_.state() != transport::LinkState::kLive) return;
      failed_ = Failure("the game cannot go on: " + result.message());
      End();
    });
  }

  std::string Line() const {
    if (seen_.track().segments.empty()) return "waiting for footing-sim: " + link_;
    if (sensor_.state() != transport::LinkState::kLive)
      return "waiting for footingd: " + sensor_link_;
    return ToLine(director_.game());
  }

  void LineLater() {
    line_.expires_after(kLine);
    line_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      std::ostream& out = options_.text ? std::cout : std::cerr;
      out << Line() << std::endl;
      if (options_.seconds > 0 && PassedS() >= options_.seconds) return End();
      LineLater();
    });
  }

  void End() {
    if (std::exchange(ending_, true)) return;
    line_.cancel();
    signals_.cancel();
    sensor_.Stop();
    v1::Command leave;
    leave.mutable_set_game()->set_leave(true);
    simulation_.Send(std::move(leave), [this](const v1::CommandResult&) { end_.cancel(); });
    end_.expires_after(kLeaveWithin);
    end_.async_wait([this](const boost::system::error_code&) {
      simulation_.Stop();
      io_.stop();
    });
  }

  const HostOptions& options_;
  Director director_;
  Collector seen_;
  Hand hand_;
  std::uint32_t device_ = 0;
  std::int64_t inclined_ns_ = 0;
  asio::io_context io_{1};
  asio::signal_set signals_;
  asio::steady_timer line_, end_;
  std::int64_t started_ns_;
  std::string link_ = "not connected", sensor_link_ = link_;
  bool welcomed_ = false, sensed_ = false;  ///< By footing-sim; by footingd.
  bool ending_ = false;
  std::optional<Error> failed_;
  transport::Client sensor_, simulation_;
};

}  // namespace

Result<Report> RunGame(const HostOptions& options) { return Host(options).Run(); }

}  // namespace footing::game

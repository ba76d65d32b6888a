#pragma once

#include <cerrno>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/eventfd.h>
#include <unistd.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/net/access.h"
#include "common/net/address.h"
#include "common/net/client.h"
#include "common/net/discovery.h"
#include "common/net/limits.h"
#include "common/net/monitoring.h"
#include "common/net/server.h"
#include "common/runtime/clock.h"
#include "common/runtime/config.h"
#include "common/runtime/exchange.h"
#include "common/runtime/log.h"
#include "common/runtime/service_manager.h"
#include "common/runtime/timer.h"

namespace footing::serving {

/// Settings that every engine's service has; Bind gives ranges and documentation.
struct Config {
  std::string sensor;               ///< Address of footingd; empty: the default one.
  std::vector<std::string> listen;  ///< Empty: the default one.
  std::string rig;                  ///< Rig whose motion commands; empty: the first that can.
  std::string data_folder;          ///< In place of the installed data.
  std::string metrics;              ///< Where metrics are served (MetricsEndpoint); empty: nowhere.
  transport::SessionLimits sessions;
  transport::AccessSettings access;
  std::string version;  ///< Version of the program; not a setting.

  void Bind(config::Binder& binder);
};

/// An engine with its two hand-overs, as SimulationThread runs it (GaitRun, PoseRun). A Frame
/// counts overruns and the frames that were left out.
template <typename T>
concept EngineRun = requires(T run, exchange::Latest<typename T::Inputs>& inputs,
                             typename T::Frame& frame) {
  run.StepOnSimThread(inputs, frame);  // Advances by one step.
  run.FillOnSimThread(frame);          // Before the frame is handed over.
  run.TakenOnSimThread(frame);         // After it was; not when the queue was full.
  requires std::same_as<decltype(frame.overruns), std::uint64_t>;
  requires std::same_as<decltype(frame.left_out), std::uint64_t>;
};

template <EngineRun Run>
class SimulationThread;

/// An engine on its thread with its channels and commands, as Serving serves it (GaitLine,
/// PoseLine).
template <typename T>
concept EngineLine = EngineRun<typename T::Run> &&
    requires(T line, const T& constant, const v1::Tick& tick, std::int64_t now_ns,
             const transport::SessionInfo& who, const v1::Command& command,
             const typename T::Run::Frame& frame) {
  { T::Channels() } -> std::same_as<std::vector<transport::Channel>>;
  { T::SensorChannels() } -> std::same_as<std::vector<std::string>>;  // Those of footingd.
  { T::kSensorPolicy } -> std::convertible_to<v1::QueuePolicy>;
  { constant.Capabilities() } -> std::same_as<std::vector<std::string>>;
  { constant.frame_rate_hz() } -> std::same_as<double>;
  { constant.Retained() } -> std::same_as<std::vector<transport::ChannelBytes>>;
  { line.thread() } -> std::same_as<SimulationThread<typename T::Run>&>;
  { line.OnFrame(frame, now_ns) } -> std::same_as<std::vector<transport::ChannelBytes>>;
  { line.OnCommand(who, command) } -> std::same_as<v1::CommandResult>;
  line.OnTick(tick, now_ns);
  line.OnSessionEnd(who);
};

/// Sockets around one engine's line: ticks of footingd to it, its frames to the clients.
template <EngineLine Line>
class Serving : public std::enable_shared_from_this<Serving<Line>> {
 public:
  Serving(boost::asio::io_context& io, std::unique_ptr<Line> line, const Config& config,
          int wake_descriptor, const transport::ServerOptions& with_access)
      : line_(std::move(line)),
        wake_(io, wake_descriptor),
        server_(io, MakeServerOptions(*line_, config, with_access),
                {[this](const transport::SessionInfo& who, const v1::Command& command) {
                   return line_->OnCommand(who, command);
                 },
                 [this](const transport::SessionInfo& who) { line_->OnSessionEnd(who); },
                 [](const transport::OverloadLine& said) {
                   log::Write(log::Level::kWarning, said.text, {"", said.session, said.channel});
                 }}),
        monitor_(server_, line_->frame_rate_hz(), {"footing-sim", config.version}) {}

  /// Opens the sockets, the metrics and the sensor client; an error names the address.
  Result<void> Open(boost::asio::io_context& io, const Config& config) {
    auto addresses = config.listen;
    if (addresses.empty()) {
      const bool passed = service_manager::PassedSocket("simulation") >= 0;
      addresses.push_back(passed ? "fd:simulation"
                                 : transport::DefaultAddress("simulation", true).Text());
    }
    for (const std::string& text : addresses) {
      const auto address = transport::ParseAddress(text);
      if (!address) return address.error();
      if (const auto listening = server_.Listen(*address); !listening) return listening;
      const transport::Address bound = server_.ListeningOn(listening_++);
      const bool tls = bound.kind == transport::Address::Kind::kTls;
      log::Info("listening on " + bound.Text() +
                (tls ? ", certificate " + server_.fingerprint() : ""));
    }
    if (config.access.insecure_lan) lan_warning_ = transport::WarnOfInsecureLan(io);
    const std::string& name = config.access.advertise;
    advertiser_.emplace(io, discovery::ServicesOf(server_, listening_, name, "footing-sim"));
    if (const auto served = monitor_.Serve(io, config.metrics); !served) return served;
    transport::ClientOptions options;
    const auto sensor = transport::AddressOrDefault(config.sensor, "sensor");
    if (!sensor) return sensor.error();
    options.address = *sensor;
    options.client_name = "footing-sim";
    options.channels = line_->SensorChannels();
    options.policy = Line::kSensorPolicy;
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) { line_->OnTick(tick, clock::MonotonicNs()); };
    handlers.on_state = [](transport::LinkState, const std::string& why) {
      log::Info("sensor stream: " + why);
    };
    handlers.on_notice = [](const v1::Notice& notice) {
      log::Warning("sensor stream: " + notice.text());
    };
    client_ = std::make_unique<transport::Client>(io, options, std::move(handlers));
    return {};
  }

  void Start() {
    server_.Publish(clock::MonotonicNs(), line_->Retained());
    client_->Start();
    line_->thread().Start();
    WaitForFrame();
  }

  /// Takes over limits and access from a changed config; returns the settings whose files changed.
  Result<std::vector<std::string>> Reload(const Config& wanted) {
    auto changed_files = wanted.access.Reapply(server_);
    if (changed_files) server_.SetLimits(wanted.sessions);
    return changed_files;
  }

  /// Name of the thread that is stuck; empty: none.
  std::string Stuck() const { return line_->thread().Stuck() ? "the simulation thread" : ""; }

  /// Addresses on which it listens.
  std::vector<std::string> listening_on() const {
    std::vector<std::string> addresses;
    for (std::size_t i = 0; i < listening_; ++i) addresses.push_back(server_.ListeningOn(i).Text());
    return addresses;
  }

  /// Ends all sessions with this reason, then calls `done`.
  void Stop(const std::string& reason, std::function<void()> done) {
    client_->Stop();
    line_->thread().Stop();
    boost::system::error_code ignored;
    wake_.close(ignored);
    lan_warning_.reset();
    monitor_.Stop();
    advertiser_.reset();
    server_.Drain(reason, std::move(done));
  }

 private:
  static transport::ServerOptions MakeServerOptions(const Line& line, const Config& config,
                                                    const transport::ServerOptions& with_access) {
    transport::ServerOptions options = with_access;
    options.server_id = "footing-sim";
    options.version = config.version;
    options.channels = Line::Channels();
    options.channels.push_back(monitoring::StatsChannel());
    options.tick_rate_hz = line.frame_rate_hz();
    options.sessions = config.sessions;
    options.capabilities = line.Capabilities();
    options.capabilities.push_back("markers");
    options.takes_markers = true;
    return options;
  }

  void WaitForFrame() {
    wake_.async_read_some(
        boost::asio::buffer(&wakes_, sizeof(wakes_)),
        [self = this->shared_from_this()](boost::system::error_code error, std::size_t) {
          if (error) return;
          self->PublishFrames();
          self->WaitForFrame();
        });
  }

  void PublishFrames() {
    while (line_->thread().frames().Pop(frame_)) {
      const std::int64_t now_ns = clock::MonotonicNs();
      std::vector<transport::ChannelBytes> channels = line_->OnFrame(frame_, now_ns);
      monitor_.OnTick({now_ns, std::nullopt, frame_.overruns}, channels);
      if (const auto more = frame_.left_out - std::exchange(left_out_, frame_.left_out); more > 0) {
        server_.NoteLateTicks(more);
      }
      server_.Publish(now_ns, channels);
    }
  }

  std::unique_ptr<Line> line_;
  boost::asio::posix::stream_descriptor wake_;
  std::uint64_t wakes_ = 0;
  typename Line::Run::Frame frame_;
  std::uint64_t left_out_ = 0;  ///< Frames, as the server knows.
  transport::Server server_;
  std::size_t listening_ = 0;
  std::shared_ptr<timer::Timer> lan_warning_;  ///< With insecure_lan.
  monitoring::Monitor monitor_;
  std::optional<discovery::Advertiser> advertiser_;
  std::unique_ptr<transport::Client> client_;
};

/// A service that runs.
struct Served {
  /// Stops the simulation thread; each client gets what waits for it, and goodbye with the reason.
  /// `done` is called when the last one has ended.
  std::function<void(const std::string& reason, std::function<void()> done)> stop;
  /// Takes limits of another config, for sessions that come, and its access, for all: the settings
  /// whose files have another content. An error changes nothing.
  std::function<Result<std::vector<std::string>>(const Config& wanted)> reload;
  /// The thread that is stuck; empty: none.
  std::function<std::string()> stuck;
  std::vector<std::string> listening_on;  ///< Addresses for clients.
};

/// Makes the line with `make_line(wake_descriptor)` and starts it.
template <EngineLine Line, typename MakeLine>
Result<Served> StartServing(boost::asio::io_context& io, const Config& config,
                            const MakeLine& make_line) {
  const int wake_descriptor = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (wake_descriptor < 0) return Failure(std::string("eventfd: ") + std::strerror(errno));
  transport::ServerOptions with_access;
  if (const auto access = config.access.Apply(with_access); !access) return access.error();
  Result<std::unique_ptr<Line>> line = make_line(wake_descriptor);
  if (!line) return line.error();
  auto serving = std::make_shared<Serving<Line>>(io, std::move(line).value(), config,
                                                 wake_descriptor, with_access);
  if (const auto open = serving->Open(io, config); !open) return open.error();
  serving->Start();
  return Served{[serving](const std::string& reason, std::function<void()> done) {
                  serving->Stop(reason, std::move(done));
                },
                [serving](const Config& wanted) { return serving->Reload(wanted); },
                [serving] { return serving->Stuck(); }, serving->listening_on()};
}

/// Checks of StartServing besides the config itself, without its sockets and its thread.
template <EngineLine Line, typename MakeLine>
Result<void> CheckServing(const Config& config, const MakeLine& make_line) {
  if (auto access = config.access.CheckStart(config.listen); !access) return access;
  constexpr int kNobodyToWake = -1;
  const Result<std::unique_ptr<Line>> line = make_line(kNobodyToWake);
  return line ? Result<void>() : line.error();
}

/// Settings that every engine publishes on the channel "config": program, version, its name and all
/// settings.
template <typename EngineConfig>
nlohmann::ordered_json EffectiveSettings(Config common, const char* engine, EngineConfig config) {
  config::Binder binder;
  common.Bind(binder);
  config.Bind(binder);
  return {{"program", "footing-sim"},
          {"version", common.version},
          {"engine", engine},
          {"settings", nlohmann::ordered_json::parse(binder.Print())}};
}

/// Runs one engine in real time on a thread of its own. After Start the thread allocates, locks and
/// logs nothing. It meets the io thread at `inputs`, `frames`, and one write to `wake_descriptor`
/// (an eventfd) per frame, and where the run itself has a queue.
template <EngineRun Run>
class SimulationThread {
 public:
  using Inputs = typename Run::Inputs;
  using Frame = typename Run::Frame;

  /// `steps_per_frame` steps make a frame; `wake_descriptor` stays the caller's.
  SimulationThread(Run run, double step_s, int steps_per_frame, int wake_descriptor)
      : run_(std::move(run)),
        step_ns_(std::llround(step_s * 1e9)),
        steps_per_frame_(steps_per_frame),
        wake_descriptor_(wake_descriptor),
        frames_(kFrameQueue) {}
  ~SimulationThread() { Stop(); }
  SimulationThread(const SimulationThread&) = delete;
  SimulationThread& operator=(const SimulationThread&) = delete;

  void Start() {
    thread_ = std::thread([this, follower = clock::NewFollower()]() mutable {
      clock::Follow(std::move(follower));
      RunOnSimThread();
    });
  }
  void Stop() {
    stop_.Raise();
    if (!thread_.joinable()) return;
    // The thread looks once a frame, and on simulated time in its own turns only.
    if (clock::OwnFollower() != nullptr) {
      clock::SleepUntil(clock::MonotonicNs() + (steps_per_frame_ + 1) * step_ns_);
    }
    thread_.join();
  }

  /// It has not come round for longer than any step takes.
  bool Stuck() const { return heartbeat_.StuckFor(kLongestTurnNs, clock::MonotonicNs()); }

  exchange::Latest<Inputs>& inputs() { return inputs_; }
  exchange::BoundedQueue<Frame>& frames() { return frames_; }
  /// Run of the engine; the simulation thread's once that has started.
  const Run& run() const { return run_; }

 private:
  static constexpr std::size_t kFrameQueue = 64;
  /// Behind by more than this, the thread gives up catching up and restarts from the present.
  static constexpr std::int64_t kGiveUpNs = 100'000'000;
  static constexpr std::int64_t kLongestTurnNs = 5'000'000'000;

  void RunOnSimThread() {
    std::int64_t due_ns = clock::MonotonicNs();
    heartbeat_.Beat(due_ns);
    while (!stop_.raised()) {
      for (int i = 0; i < steps_per_frame_; ++i) {
        due_ns += step_ns_;
        const std::int64_t behind_ns = clock::MonotonicNs() - due_ns;
        if (behind_ns < 0) {
          clock::SleepUntil(due_ns);
        } else if (behind_ns > step_ns_) {
          ++frame_.overruns;
          if (behind_ns > kGiveUpNs) GiveUpOnSimThread(behind_ns, due_ns);
        }
        run_.StepOnSimThread(inputs_, frame_);
      }
      heartbeat_.Beat(clock::MonotonicNs());  // Before its frame is seen.
      HandOverOnSimThread();
    }
  }

  /// Restarts from the present: the frames that were due until now are left out.
  void GiveUpOnSimThread(std::int64_t behind_ns, std::int64_t& due_ns) {
    due_ns += behind_ns;
    frame_.left_out += static_cast<std::uint64_t>(behind_ns / (step_ns_ * steps_per_frame_));
  }

  void HandOverOnSimThread() {
    run_.FillOnSimThread(frame_);
    // A full queue keeps events and inputs for the next frame: only a pose is lost.
    if (!frames_.Push(frame_)) {
      ++frame_.left_out;
      return;
    }
    run_.TakenOnSimThread(frame_);
    clock::Act();
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = write(wake_descriptor_, &one, sizeof(one));
  }

  Run run_;
  const std::int64_t step_ns_;
  const int steps_per_frame_;
  const int wake_descriptor_;
  exchange::Latest<Inputs> inputs_;
  exchange::BoundedQueue<Frame> frames_;
  exchange::Flag stop_;
  exchange::Heartbeat heartbeat_;
  Frame frame_;  ///< Being filled, on the simulation thread.
  std::thread thread_;
};

}  // namespace footing::serving

#include "daemon/offline/bench/waiting.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <utility>

#include <unistd.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "common/base/text.h"
#include "common/net/framing.h"
#include "common/net/server.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "common/wire/wire.h"
#include "daemon/offline/bench/broker_link.h"
#include "daemon/offline/bench/pairs.h"
#include "footing/v1/session.pb.h"

namespace footing::bench {

Result<void> BareFanOut::Listen(const transport::Address& address) {
  auto listener = transport::Listener::Open(io_, address, [this](transport::Socket socket) {
    boost::system::error_code ignored;  // A Unix socket has no such option.
    socket.plain().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    sockets_.push_back(std::make_shared<transport::Socket>(std::move(socket)));
  });
  if (!listener) return listener.error();
  listener_ = std::move(*listener);
  return {};
}

void BareFanOut::Publish(const std::shared_ptr<const std::string>& frame) {
  for (const auto& socket : sockets_) {
    boost::asio::async_write(socket->plain(), boost::asio::buffer(*frame),
                             [socket, frame](const boost::system::error_code&, std::size_t) {});
  }
}

namespace {

constexpr int kFanOutPairs = 9;
constexpr std::size_t kViewers = 100;
constexpr int kFanOutTicks = 100;
constexpr std::int64_t kFanOutIntervalNs = 10'000'000;

using Viewers = std::vector<std::unique_ptr<Viewer>>;

bool ConnectViewers(LoopThread& thread, const transport::Address& address,
                    Viewer::Greeting greeting, Viewers& viewers) {
  thread.Do([&] {
    for (std::size_t i = 0; i < kViewers; ++i) {
      viewers.push_back(std::make_unique<Viewer>(thread.io(), address, greeting, true, nullptr));
    }
  });
  return WaitUntil(thread, [&] {
    for (const auto& viewer : viewers) {
      if (!viewer->connected()) return false;
    }
    return true;
  });
}

/// CPU time of the server's thread per second of streaming, in percent of one core.
double CpuPercent(LoopThread& server_thread, const std::function<void()>& publish) {
  std::int64_t before_ns = 0;
  std::int64_t after_ns = 0;
  server_thread.Do([&] { before_ns = clock::ThreadCpuNs(); });
  server_thread.Pace(kFanOutTicks, kFanOutIntervalNs, publish);
  server_thread.Do([&] { after_ns = clock::ThreadCpuNs(); });
  return 100.0 * static_cast<double>(after_ns - before_ns) / (kFanOutTicks * kFanOutIntervalNs);
}

/// One string with what our server sends for a tick, made again for every tick as ours is.
std::shared_ptr<const std::string> BareFrame(const std::vector<transport::ChannelBytes>& channels) {
  std::string payload(32, '\0');  // As long as a tick's own head.
  for (const auto& channel : channels) payload += channel.bytes;
  return std::make_shared<const std::string>(transport::Frame(payload));
}

}  // namespace

Result<Rows> FanOutCpu() {
  const auto channels = ExampleTick();
  LoopThread server_thread;
  LoopThread client_thread;
  transport::Server server(server_thread.io(), ServerOptionsFor(100, 30), {});
  BareFanOut bare(server_thread.io());
  const StopsAtEnd stops_server({&server_thread});
  Result<void> listening;
  server_thread.Do([&] {
    listening = server.Listen(TcpAddress());
    if (listening) listening = bare.Listen(TcpAddress());
  });
  if (!listening) return listening.error();

  Viewers ours;
  Viewers others;
  const StopsAtEnd stops_viewers({&client_thread});
  const bool connected =
      ConnectViewers(client_thread, server.ListeningOn(0), Viewer::Greeting::kSubscribe, ours) &&
      ConnectViewers(client_thread, bare.address(), Viewer::Greeting::kNone, others) &&
      WaitUntil(server_thread, [&] {
        return server.statistics().sessions == kViewers && bare.sessions() == kViewers;
      });
  if (!connected) return Failure("fan_out_cpu: the viewers did not connect; see ulimit -n");

  const Row row = RunPairs(
      "fan_out_cpu", "percent of a core", kFanOutPairs,
      [&] {
        return CpuPercent(server_thread, [&] { server.Publish(clock::MonotonicNs(), channels); });
      },
      [&] { return CpuPercent(server_thread, [&] { bare.Publish(BareFrame(channels)); }); });
  const auto dropped = server.statistics().ticks_dropped;
  client_thread.Do([&] {
    ours.clear();
    others.clear();
  });
  server_thread.Do([&] { server.Stop("done"); });
  if (dropped > 0) return Failure("fan_out_cpu: viewers lost ticks; the figures do not count");
  return Rows{row};
}

namespace {

constexpr std::size_t kContestViewers = 1000;
constexpr std::size_t kAtOnce = 50;  // Viewers that connect.
constexpr int kContestTicks = 150;
constexpr int kContestRounds = 5;
constexpr std::int64_t kContestIntervalNs = 10'000'000;
constexpr std::size_t kLeastTickBytes = 400;  // The greeting of a viewer is shorter.

/// One way to bring a frame to all viewers, and what of it the server costs.
struct FanOutWay {
  std::string name;
  std::function<void()> publish;  ///< On the server's thread.
  std::function<double()> cpu_s;  ///< CPU time of the server so far, s.
  std::uint64_t received = 0;     ///< Ticks, all viewers together; of the viewers' thread.
  std::vector<double> us_per_tick = {};
};

/// Everything that takes part, and the order in which it ends: loops first.
class Contest {
 public:
  Contest() : server_(server_thread_.io(), Options(), {}), bare_(server_thread_.io()) {}
  ~Contest() {
    server_thread_.Do([this] { server_.Stop("done"); });
    viewer_thread_.Do([this] {
      viewers_.clear();
      subscribers_.clear();
      publishers_.clear();
    });
    viewer_thread_.Stop();
    server_thread_.Stop();
  }
  Contest(const Contest&) = delete;
  Contest& operator=(const Contest&) = delete;

  Result<void> Begin() {
    Result<void> listening;
    server_thread_.Do([&] {
      listening = server_.Listen(TcpAddress());
      if (listening) listening = bare_.Listen(TcpAddress());
    });
    if (!listening) return listening;
    ways_.reserve(4);  // Viewers have their addresses.
    const auto own_cpu_s = [this] {
      std::int64_t cpu_ns = 0;
      server_thread_.Do([&] { cpu_ns = clock::ThreadCpuNs(); });
      return 1e-9 * static_cast<double>(cpu_ns);
    };
    ways_.push_back(
        {"ours", [this] { server_.Publish(clock::MonotonicNs(), channels_); }, own_cpu_s});
    ways_.push_back({"", [this] { bare_.Publish(Frame()); }, own_cpu_s});
    const auto greeting = Viewer::Greeting::kSubscribe;
    if (!Connect(server_.ListeningOn(0), greeting, ways_[0]) ||
        !Connect(bare_.address(), Viewer::Greeting::kNone, ways_[1])) {
      return Failure("fan_out_1000: the viewers did not connect; see ulimit -n");
    }
    for (const BrokerKind kind : {BrokerKind::kMosquitto, BrokerKind::kNats}) {
      auto broker = Broker::Start(kind);
      if (broker && !Subscribe(std::move(broker))) {
        return Failure(std::string("fan_out_1000: not taken in by ") + NameOf(kind));
      }
    }
    return {};
  }

  /// Every way in turn, forwards and backwards.
  Result<void> Run() {
    for (int round = -1; round < kContestRounds; ++round) {  // The first one warms up.
      for (std::size_t i = 0; i < ways_.size(); ++i) {
        FanOutWay& way = ways_[round % 2 == 0 ? i : ways_.size() - 1 - i];
        const auto us = Measure(way);
        if (!us) return us.error();
        if (round >= 0) way.us_per_tick.push_back(*us);
      }
    }
    if (server_.statistics().ticks_dropped > 0) return Failure("fan_out_1000: ticks were dropped");
    return {};
  }

  const std::vector<FanOutWay>& ways() const { return ways_; }

 private:
  static transport::ServerOptions Options() {
    transport::ServerOptions options = ServerOptionsFor(100, 30);
    options.sessions.max_sessions = options.sessions.max_sessions_per_user =
        options.sessions.max_sessions_per_host = 2 * kContestViewers;
    return options;
  }

  /// One string with what our server sends for a tick, made again for every tick as ours is.
  std::shared_ptr<const std::string> Frame() const {
    return std::make_shared<const std::string>(transport::Frame(Payload()));
  }
  std::string Payload() const {
    std::string payload(32, '\0');  // As long as a tick's own head.
    for (const auto& channel : channels_) payload += channel.bytes;
    return payload;
  }

  /// A busy machine takes its time.
  static bool WaitLong(LoopThread& thread, const std::function<bool()>& condition) {
    for (int i = 0; i < 10; ++i) {
      if (WaitUntil(thread, condition)) return true;
    }
    return false;
  }

  bool Connect(const transport::Address& address, Viewer::Greeting greeting, FanOutWay& way) {
    const bool ours = greeting == Viewer::Greeting::kSubscribe;
    for (std::size_t i = 0; i < kContestViewers; ++i) {
      viewer_thread_.Do([&] {
        viewers_.push_back(std::make_unique<Viewer>(
            viewer_thread_.io(), address, greeting, true, [&way](std::string_view payload) {
              way.received += payload.size() >= kLeastTickBytes;
            }));
      });
      if ((i + 1) % kAtOnce != 0) continue;
      const bool connected = WaitLong(server_thread_, [&] {
        return (ours ? server_.statistics().sessions : bare_.sessions()) == i + 1;
      });
      if (!connected) return false;
    }
    return true;
  }

  bool Subscribe(std::unique_ptr<Broker> broker) {
    brokers_.push_back(std::move(broker));
    const Broker& of = *brokers_.back();
    ways_.push_back({NameOf(of.kind()), {}, [&of] { return of.CpuSeconds(); }});
    FanOutWay& way = ways_.back();
    const std::size_t first = subscribers_.size();
    for (std::size_t i = 0; i < kContestViewers; ++i) {
      viewer_thread_.Do([&] {
        subscribers_.push_back(std::make_unique<BrokerLink>(
            viewer_thread_.io(), of, BrokerLink::Part::kSubscribes, static_cast<int>(i),
            [&way](std::string_view) { ++way.received; }));
      });
    }
    BrokerLink* publisher = nullptr;
    server_thread_.Do([&] {
      publishers_.push_back(std::make_unique<BrokerLink>(
          server_thread_.io(), of, BrokerLink::Part::kPublishes, -1, nullptr));
      publisher = publishers_.back().get();
    });
    way.publish = [this, publisher] { publisher->Publish(Payload()); };
    return WaitLong(viewer_thread_, [&] {
      return std::all_of(subscribers_.begin() + static_cast<std::ptrdiff_t>(first),
                         subscribers_.end(), [](const auto& link) { return link->ready(); });
    });
  }

  /// CPU time of the server for a tick of one viewer, until all have all of them.
  Result<double> Measure(FanOutWay& way) {
    std::uint64_t before = 0;
    viewer_thread_.Do([&] { before = way.received; });
    const double cpu_before_s = way.cpu_s();
    server_thread_.Pace(kContestTicks, kContestIntervalNs, way.publish);
    const std::uint64_t wanted = before + kContestTicks * kContestViewers;
    // A broker may be many seconds behind.
    WaitLong(viewer_thread_, [&] { return way.received >= wanted; });
    std::uint64_t received = 0;
    viewer_thread_.Do([&] { received = way.received - before; });
    if (received != kContestTicks * kContestViewers) {
      return Failure("fan_out_1000: " + std::to_string(received) + " of " +
                     std::to_string(kContestTicks * kContestViewers) + " ticks came through " +
                     (way.name.empty() ? "bare Asio" : way.name));
    }
    return 1e6 * (way.cpu_s() - cpu_before_s) / static_cast<double>(received);
  }

  const std::vector<transport::ChannelBytes> channels_ = ExampleTick();
  LoopThread server_thread_;
  LoopThread viewer_thread_;
  transport::Server server_;
  BareFanOut bare_;
  std::vector<std::unique_ptr<Broker>> brokers_;
  std::vector<FanOutWay> ways_;
  std::vector<std::unique_ptr<Viewer>> viewers_;
  std::vector<std::unique_ptr<BrokerLink>> subscribers_;
  std::vector<std::unique_ptr<BrokerLink>> publishers_;
};

}  // namespace

Result<Rows> FanOutThousand() {
  Contest contest;
  if (auto begun = contest.Begin(); !begun) return begun.error();
  if (auto run = contest.Run(); !run) return run.error();
  const FanOutWay& ours = contest.ways().front();
  Rows rows;
  for (std::size_t i = 1; i < contest.ways().size(); ++i) {
    const FanOutWay& other = contest.ways()[i];
    std::vector<double> ratios;
    for (std::size_t k = 0; k < ours.us_per_tick.size(); ++k) {
      const double baseline = other.us_per_tick[k];
      ratios.push_back(baseline > 0 ? ours.us_per_tick[k] / baseline : 0);
    }
    rows.push_back({"fan_out_1000" + (other.name.empty() ? "" : "_" + other.name),
                    text::Median(ours.us_per_tick), text::Median(other.us_per_tick),
                    text::Median(ratios), "us of CPU a tick and viewer"});
  }
  return rows;
}

namespace {

struct Pacer {
  timer::Timer timer;
  std::function<void()> tick;
  std::chrono::nanoseconds interval;
  int left;
  std::promise<void> done;
};

void Next(const std::shared_ptr<Pacer>& pacer) {
  if (pacer->left-- == 0) {
    pacer->done.set_value();
    return;
  }
  pacer->timer.At(pacer->timer.expiry() + pacer->interval, [pacer] {
    pacer->tick();
    Next(pacer);
  });
}

}  // namespace

LoopThread::LoopThread() : work_(io_.get_executor()), thread_([this] { io_.run(); }) {}

LoopThread::~LoopThread() { Stop(); }

void LoopThread::Stop() {
  work_.reset();
  io_.stop();
  if (thread_.joinable()) thread_.join();
}

void LoopThread::Do(const std::function<void()>& work) {
  std::promise<void> done;
  boost::asio::post(io_, [&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

void LoopThread::Pace(int count, std::int64_t interval_ns, const std::function<void()>& tick) {
  const std::shared_ptr<Pacer> pacer(
      new Pacer{timer::Timer(io_), tick, std::chrono::nanoseconds(interval_ns), count, {}});
  auto done = pacer->done.get_future();
  boost::asio::post(io_, [pacer] {
    pacer->timer.expires_after(std::chrono::nanoseconds(0));
    Next(pacer);
  });
  done.wait();
}

transport::Address UnixAddress(const std::string& name) {
  transport::Address address;
  address.path = "/tmp/footing-bench-" + std::to_string(getpid()) + "-" + name;
  return address;
}

transport::Address TcpAddress() {
  transport::Address address;
  address.kind = transport::Address::Kind::kTcp;
  address.host = "127.0.0.1";
  return address;
}

bool WaitUntil(LoopThread& thread, const std::function<bool()>& condition) {
  constexpr int kTries = 1000;
  constexpr std::int64_t kPauseNs = 5'000'000;
  for (int i = 0; i < kTries; ++i) {
    bool holds = false;
    thread.Do([&] { holds = condition(); });
    if (holds) return true;
    clock::SleepUntil(clock::MonotonicNs() + kPauseNs);
  }
  return false;
}

double ResidentMegabytes() {
  std::ifstream file("/proc/self/statm");
  double total_pages = 0;
  double resident_pages = 0;
  file >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

namespace {

constexpr char kPingTag = (6 << 3) | 2;  // Envelope.ping, length-delimited.
constexpr std::uint32_t kViewerQueueTicks = 1024;

std::string HelloBytes() {
  v1::Envelope message;
  message.mutable_hello()->set_protocol_major(1);
  message.mutable_hello()->set_client_name("footing-bench");
  return message.SerializeAsString();
}

std::string SubscribeBytes() {
  v1::Envelope message;
  message.mutable_subscribe()->set_policy(v1::QUEUE_POLICY_DROP_OLDEST);
  message.mutable_subscribe()->set_queue_ticks(kViewerQueueTicks);
  return message.SerializeAsString();
}

}  // namespace

Viewer::Viewer(boost::asio::io_context& io, const transport::Address& address, Greeting greeting,
               bool reads, std::function<void(std::string_view)> on_frame)
    : on_frame_(std::move(on_frame)) {
  transport::Dial(io, address, [this, greeting, reads](Result<transport::Socket> socket) {
    if (!socket) return;  // It shows as not connected.
    transport::FramedLimits limits;
    limits.max_in_bytes = 1u << 20;
    transport::FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) { OnFrame(payload); };
    connection_.emplace(std::move(*socket), limits, std::move(handlers));
    if (greeting == Greeting::kSubscribe) {
      connection_->Send(HelloBytes());
      connection_->Send(SubscribeBytes());
    }
    if (reads) connection_->Start();
  });
}

void Viewer::OnFrame(std::string_view payload) {
  if (payload.empty() || payload[0] != kPingTag) {
    if (on_frame_) on_frame_(payload);
    return;
  }
  v1::Envelope ping;
  if (!ping.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return;
  v1::Envelope message;
  message.mutable_pong()->set_id(ping.ping().id());
  message.mutable_pong()->set_t0_ns(ping.ping().t0_ns());
  connection_->Send(message.SerializeAsString());
}

namespace {

constexpr std::int64_t kSomeNs = 123'456'789'012'345;
constexpr std::uint64_t kSomeCount = 360'000;  // An hour at 100 Hz.

v1::MotionSamples Motion() {
  v1::MotionSamples message;
  for (std::uint32_t device = 1; device <= 3; ++device) {
    stream::MotionSample sample;
    sample.device = device;
    sample.report_count = kSomeCount;
    sample.received_ns = sample.sampled_ns = kSomeNs;
    sample.specific_force_mps2 = {0.1, -1.2, -9.7};
    sample.filtered_mps2 = {0.11, -1.19, -9.71};
    *message.add_samples() = wire::ToProto(sample);
  }
  return message;
}

v1::BoardSamples Boards() {
  stream::BoardSample sample;
  sample.report_count = kSomeCount;
  sample.received_ns = sample.sampled_ns = kSomeNs;
  sample.top_left_n = sample.top_right_n = sample.bottom_left_n = sample.bottom_right_n = 171.5;
  sample.total_n = 686;
  sample.cop_x_m = 0.01;
  sample.cop_y_m = -0.02;
  sample.cop_valid = sample.contact = true;
  v1::BoardSamples message;
  for (std::uint32_t device = 4; device <= 5; ++device) {
    sample.device = device;
    *message.add_samples() = wire::ToProto(sample);
  }
  return message;
}

v1::FeatureFrame Features() {
  stream::RigFeatures rig;
  rig.rig = "rig1";
  for (std::uint32_t device = 1; device <= 3; ++device) {
    stream::DeviceFeatures features;
    features.device = device;
    features.role = stream::DeviceRole::kLeftHand;
    features.moving = features.frequency_valid = features.amplitude_valid = true;
    features.inclination_valid = true;
    features.frequency_hz = 1.9;
    features.amplitude_mps2 = 12.5;
    features.roll_rad = 0.2;
    features.pitch_rad = -0.1;
    rig.devices.push_back(features);
  }
  rig.pairs.push_back({1, 2, true, 3.1});
  rig.newest_received_ns = rig.decoded_ns = rig.computed_ns = kSomeNs;
  v1::FeatureFrame message;
  *message.add_rigs() = wire::ToProto(rig);
  return message;
}

v1::RawReports Raw() {
  v1::RawReports message;
  for (std::uint32_t device = 1; device <= 5; ++device) {
    stream::RawReport report;
    report.device = device;
    report.received_ns = kSomeNs;
    report.report.assign(device >= 4 ? 22 : 6, 0x80);  // Reports 0x34 and 0x31 with their id.
    *message.add_reports() = wire::ToProto(report);
  }
  return message;
}

}  // namespace

std::vector<transport::Channel> SensorChannels() {
  return {{"status", 16, true},
          {"motion", 17, false},
          {"features", 18, false},
          {"boards", 19, false},
          {"raw", 20, false}};
}

std::vector<transport::ChannelBytes> ExampleTick() {
  return {{17, Motion().SerializeAsString()},
          {18, Features().SerializeAsString()},
          {19, Boards().SerializeAsString()},
          {20, Raw().SerializeAsString()}};
}

transport::ServerOptions ServerOptionsFor(double tick_rate_hz, double ring_s) {
  transport::ServerOptions options;
  options.server_id = "footing-bench";
  options.channels = SensorChannels();
  options.tick_rate_hz = tick_rate_hz;
  options.ring_s = ring_s;
  options.dead_after_s = 600;
  // All viewers of a benchmark come from this host.
  options.sessions.max_sessions_per_host = options.sessions.max_sessions;
  return options;
}

namespace {

constexpr int kStalledPairs = 9;
constexpr int kReaders = 20;
constexpr int kStalledTicks = 1000;
constexpr std::int64_t kStalledIntervalNs = 1'000'000;
// Short, so that ring and queues are full before the first run that counts.
constexpr double kRingS = 0.5;
constexpr std::uint32_t kStalledQueueTicks = 512;
constexpr double kMemoryBarMegabytes = 2;

transport::ServerOptions CrowdOptions() {
  transport::ServerOptions options = ServerOptionsFor(1e9 / kStalledIntervalNs, kRingS);
  options.max_queue_ticks = kStalledQueueTicks;
  return options;
}

/// A server with its healthy readers, and perhaps some that never read.
class Crowd {
 public:
  Crowd(LoopThread& server_thread, LoopThread& client_thread, const std::string& name)
      : server_(server_thread.io(), CrowdOptions(), {}),
        address_(UnixAddress(name)),
        server_thread_(server_thread),
        client_thread_(client_thread) {}

  Result<void> Open(int stalled) {
    Result<void> listening;
    server_thread_.Do([&] { listening = server_.Listen(address_); });
    if (!listening) return listening;
    client_thread_.Do([&] {
      for (int i = 0; i < kReaders + stalled; ++i) {
        viewers_.push_back(std::make_unique<Viewer>(
            client_thread_.io(), address_, Viewer::Greeting::kSubscribe, i < kReaders,
            [this](std::string_view payload) { OnFrame(payload); }));
      }
    });
    const bool all = WaitUntil(server_thread_, [&] {
      return server_.statistics().sessions == static_cast<std::size_t>(kReaders + stalled);
    });
    return all ? Result<void>() : Failure("stalled_readers: the readers did not connect");
  }

  /// 99th percentile of the delay from Publish to a healthy reader, over all of them.
  double P99Microseconds() {
    client_thread_.Do([&] { delays_us_.clear(); });
    server_thread_.Pace(kStalledTicks, kStalledIntervalNs,
                        [&] { server_.Publish(clock::MonotonicNs(), channels_); });
    double p99_us = 0;
    client_thread_.Do([&] { p99_us = text::Quantile(delays_us_, 0.99); });
    return p99_us;
  }

  std::uint64_t ticks_dropped() const { return server_.statistics().ticks_dropped; }

  void Close() {
    client_thread_.Do([&] { viewers_.clear(); });
    server_thread_.Do([&] { server_.Stop("done"); });
  }

 private:
  void OnFrame(std::string_view payload) {
    if (!message_.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return;
    if (!message_.has_tick() || message_.tick().snapshot()) return;
    delays_us_.push_back(static_cast<double>(clock::MonotonicNs() - message_.tick().host_ns()) *
                         1e-3);
  }

  transport::Server server_;
  transport::Address address_;
  LoopThread& server_thread_;
  LoopThread& client_thread_;
  std::vector<std::unique_ptr<Viewer>> viewers_;
  const std::vector<transport::ChannelBytes> channels_ = ExampleTick();
  v1::Envelope message_;
  std::vector<double> delays_us_;
};

}  // namespace

Result<Rows> StalledReaders() {
  LoopThread server_thread;
  LoopThread client_thread;
  Crowd with(server_thread, client_thread, "with");
  Crowd without(server_thread, client_thread, "without");
  const StopsAtEnd stops({&server_thread, &client_thread});
  if (auto opened = with.Open(kReaders); !opened) return opened.error();
  if (auto opened = without.Open(0); !opened) return opened.error();

  int runs = 0;
  double full_megabytes = 0;
  const Row delay = RunPairs(
      "stalled_readers", "us", kStalledPairs,
      [&] {
        if (runs++ == 1) full_megabytes = ResidentMegabytes();  // After the run not counted.
        return with.P99Microseconds();
      },
      [&] { return without.P99Microseconds(); });
  const double growth = ResidentMegabytes() - full_megabytes;
  const bool stalled = with.ticks_dropped() > 0;
  with.Close();
  without.Close();
  if (!stalled) return Failure("stalled_readers: no tick was dropped, so nobody stalled");
  return Rows{
      delay,
      {"stalled_readers_memory", growth, kMemoryBarMegabytes, growth / kMemoryBarMegabytes, "MB"}};
}

}  // namespace footing::bench

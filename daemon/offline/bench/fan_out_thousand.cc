#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "common/net/framing.h"
#include "common/net/server.h"
#include "daemon/offline/bench/bare_fan_out.h"
#include "daemon/offline/bench/broker_link.h"
#include "daemon/offline/bench/example_tick.h"
#include "daemon/offline/bench/viewer.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
namespace {

constexpr std::size_t kContestViewers = 1000;
constexpr std::size_t kAtOnce = 50;  // Viewers that connect.
constexpr int kContestTicks = 150;
constexpr int kContestRounds = 5;
constexpr std::int64_t kContestIntervalNs = 10'000'000;
constexpr std::size_t kLeastTickBytes = 400;  // What greets a viewer is shorter.

/// One way to bring a frame to all viewers, and what of it the server costs.
struct FanOutWay {
  std::string name;
  std::function<void()> publish;  ///< On the server's thread.
  std::function<double()> cpu_s;  ///< Of the server until now.
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

}  // namespace footing::bench

#include <memory>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "common/net/server.h"
#include "daemon/offline/bench/example_tick.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/viewer.h"
#include "daemon/offline/bench/waiting.h"
#include "footing/v1/session.pb.h"

namespace footing::bench {
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

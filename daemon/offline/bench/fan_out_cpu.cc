#include <memory>

#include "common/runtime/clock.h"
#include "common/net/framing.h"
#include "common/net/server.h"
#include "daemon/offline/bench/bare_fan_out.h"
#include "daemon/offline/bench/example_tick.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/viewer.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
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

}  // namespace footing::bench

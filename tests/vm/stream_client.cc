#include <boost/asio/io_context.hpp>
#include <chrono>
#include <iostream>
#include <string>

#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/net/client.h"
#include "common/runtime/clock.h"
#include "tests/vm/tally.h"

namespace footing::vm {
namespace {

struct Options {
  std::string connect;
  double seconds = 30;
  int devices = 1;
  double within_s = 20;
};

constexpr std::int64_t kUnderWayNs = 200'000'000;  // From the read of a report to this client.

/// Waits until so many devices are live, then counts for so long.
int Count(const Options& options, const transport::Address& address) {
  boost::asio::io_context io(1);
  Tally tally;
  std::int64_t end_ns = clock::MonotonicNs() + SecondsToNanoseconds(options.within_s);
  bool counting = false, done = false;
  transport::ClientOptions client;
  client.address = address;
  client.client_name = "stream_client";
  client.channels = {"status", "motion", "boards", "nunchuk"};
  client.queue_ticks = 1024;
  transport::ClientHandlers handlers;
  handlers.on_gap = [&](const v1::Gap&) { tally.TakeGap(); };
  handlers.on_tick = [&](const v1::Tick& tick) {
    const std::int64_t now_ns = clock::MonotonicNs();
    tally.TakeTick(tick, now_ns);
    if (!counting && tally.Live() >= options.devices) {
      counting = true;
      end_ns = now_ns + SecondsToNanoseconds(options.seconds);
      tally.CountBetween(now_ns, end_ns);
    }
    done = counting && tick.host_ns() > end_ns + kUnderWayNs;
  };
  transport::Client connection(io, client, handlers);
  connection.Start();
  while (!done && clock::MonotonicNs() < end_ns + SecondsToNanoseconds(2)) {
    io.run_one_for(std::chrono::milliseconds(100));
  }
  nlohmann::json summary = tally.Summary();
  summary["counted"] = done;
  std::cout << summary.dump() << std::endl;
  return 0;
}

int Run(int argc, char** argv) {
  Options options;
  auto app = cli::NewApp("stream_client", "Counts what reaches a client of footingd.",
                         "  stream_client --connect unix:/run/footing/sensor.sock --devices 2");
  app->add_option("--connect", options.connect, "footingd")->required();
  app->add_option("--seconds", options.seconds, "Counts for so long");
  app->add_option("--devices", options.devices, "Begins when so many are live");
  app->add_option("--within", options.within_s, "Gives up waiting for them after so many seconds");
  if (const auto code = cli::Parse(*app, argc, argv)) return *code;
  const auto address = transport::ParseAddress(options.connect);
  return address ? Count(options, *address) : cli::Report(address.error());
}

}  // namespace
}  // namespace footing::vm

int main(int argc, char** argv) { return footing::vm::Run(argc, argv); }

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <iostream>

#include "common/net/server.h"
#include "footing/v1/session.pb.h"

/// A server whose every number is known, for decoders that are not ours:
///   stream_server ADDRESS
/// prints its address (with the real port), then publishes at 100 Hz until standard input ends.
/// Tick n holds one motion sample {device 1, report_count n, received_ns -n, specific force
/// (n / 2, sin n, -9.75) m/s2, simulated}, one board sample {device 2, total n / 4 N} and one raw
/// report 31 00 (n mod 256); the snapshot holds one device with the serial "Größe 42".
namespace {

using footing::transport::ChannelBytes;

std::vector<ChannelBytes> TickNumber(std::uint64_t n) {
  const double value = static_cast<double>(n);
  footing::v1::MotionSamples motion;
  auto& sample = *motion.add_samples();
  sample.set_device(1);
  sample.set_report_count(n);
  sample.set_received_ns(-static_cast<std::int64_t>(n));
  sample.mutable_specific_force_mps2()->set_x(value / 2);
  sample.mutable_specific_force_mps2()->set_y(std::sin(value));
  sample.mutable_specific_force_mps2()->set_z(-9.75);
  sample.set_simulated(true);
  footing::v1::BoardSamples boards;
  boards.add_samples()->set_device(2);
  boards.mutable_samples(0)->set_total_n(value / 4);
  footing::v1::RawReports raw;
  raw.add_reports()->set_report(std::string{'\x31', '\0', static_cast<char>(n % 256)});
  return {{17, motion.SerializeAsString()},
          {19, boards.SerializeAsString()},
          {20, raw.SerializeAsString()}};
}

std::vector<ChannelBytes> Status() {
  footing::v1::DeviceStatusList list;
  list.add_devices()->set_device(1);
  list.mutable_devices(0)->set_serial("Größe 42");
  return {{16, list.SerializeAsString()}};
}

}  // namespace

int main(int argc, char** argv) {
  const auto address = footing::transport::ParseAddress(argc == 2 ? argv[1] : "");
  if (!address) {
    std::cerr << "error: " << address.error().message << std::endl;
    return 2;
  }
  boost::asio::io_context io;
  footing::transport::ServerOptions options;
  options.server_id = "stream-server";
  options.version = "0";
  options.channels = {
      {"status", 16, true}, {"motion", 17, false}, {"boards", 19, false}, {"raw", 20, false}};
  footing::transport::Server server(io, options, {});
  if (const auto listening = server.Listen(*address); !listening) {
    std::cerr << "error: " << listening.error().message << std::endl;
    return 1;
  }
  std::cout << server.ListeningOn(0).Text() << std::endl;

  std::uint64_t last = server.Publish(1, Status());
  boost::asio::steady_timer timer(io, std::chrono::milliseconds(0));
  std::function<void(const boost::system::error_code&)> publish = [&](const auto& error) {
    if (error) return;
    last = server.Publish(static_cast<std::int64_t>(last + 1) * 10'000'000, TickNumber(last + 1));
    timer.expires_at(timer.expiry() + std::chrono::milliseconds(10));
    timer.async_wait(publish);
  };
  timer.async_wait(publish);
  boost::asio::posix::stream_descriptor input(io, 0);
  std::string nothing(1, '\0');
  boost::asio::async_read(input, boost::asio::buffer(nothing),
                          [&](const boost::system::error_code&, std::size_t) { io.stop(); });
  io.run();
  return 0;
}

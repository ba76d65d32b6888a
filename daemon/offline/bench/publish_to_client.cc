#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <cstring>
#include <functional>
#include <optional>

#include "common/clock/clock.h"
#include "common/transport/client.h"
#include "common/transport/framing.h"
#include "common/transport/server.h"
#include "daemon/offline/bench/bare_fan_out.h"
#include "daemon/offline/bench/example_tick.h"
#include "daemon/offline/bench/loop_thread.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
namespace {

constexpr int kPairs = 9;
constexpr int kTicks = 200;
constexpr std::int64_t kIntervalNs = 2'000'000;

/// A frame as long as ours, whose first eight bytes are the instant it was published.
std::shared_ptr<const std::string> StampedFrame(std::size_t payload_bytes) {
  std::string payload(payload_bytes, '\0');
  const std::int64_t now_ns = clock::MonotonicNs();
  std::memcpy(payload.data(), &now_ns, sizeof(now_ns));
  return std::make_shared<const std::string>(transport::Frame(payload));
}

std::int64_t StampOf(std::string_view payload) {
  std::int64_t stamp_ns = 0;
  std::memcpy(&stamp_ns, payload.data(), sizeof(stamp_ns));
  return stamp_ns;
}

std::size_t PayloadBytes(const std::vector<transport::ChannelBytes>& channels) {
  v1::Envelope message;
  v1::Tick& tick = *message.mutable_tick();
  tick.set_epoch(~0ull);
  tick.set_sequence(1000);
  tick.set_host_ns(clock::MonotonicNs());
  std::size_t bytes = message.ByteSizeLong();
  for (const auto& channel : channels) bytes += channel.bytes.size() + 4;
  return bytes;
}

/// Bare Asio's reading side: frames of one known length, one async_read each.
class BareReader {
 public:
  BareReader(boost::asio::io_context& io, const transport::Address& address,
             std::size_t frame_bytes, std::function<void(std::string_view)> on_payload)
      : frame_(frame_bytes, '\0'), on_payload_(std::move(on_payload)) {
    transport::Dial(io, address, [this](Result<transport::Socket> socket) {
      if (!socket) return;  // It shows as not connected.
      socket_.emplace(std::move(*socket));
      Read();
    });
  }
  bool connected() const { return socket_.has_value(); }

 private:
  void Read() {
    boost::asio::async_read(*socket_, boost::asio::buffer(frame_),
                            [this](const boost::system::error_code& error, std::size_t) {
                              if (error) return;
                              on_payload_(std::string_view(frame_).substr(transport::kLengthBytes));
                              Read();
                            });
  }

  std::string frame_;
  std::function<void(std::string_view)> on_payload_;
  std::optional<transport::Socket> socket_;
};

double MicrosecondsSince(std::int64_t stamp_ns) {
  return static_cast<double>(clock::MonotonicNs() - stamp_ns) * 1e-3;
}

}  // namespace

Result<Rows> PublishToClient() {
  const auto channels = ExampleTick();
  const std::size_t payload_bytes = PayloadBytes(channels);
  std::vector<double> delays_us;  // Of the client's thread.
  LoopThread server_thread;
  LoopThread client_thread;

  transport::Server server(server_thread.io(), ServerOptionsFor(500, 1), {});
  BareFanOut bare(server_thread.io());
  Result<void> listening;
  server_thread.Do([&] {
    listening = server.Listen(UnixAddress("ours"));
    if (listening) listening = bare.Listen(UnixAddress("bare"));
  });
  if (!listening) return listening.error();

  transport::ClientOptions options;
  options.address = UnixAddress("ours");
  transport::ClientHandlers handlers;
  handlers.on_tick = [&](const v1::Tick& tick) {
    if (!tick.snapshot()) delays_us.push_back(MicrosecondsSince(tick.host_ns()));
  };
  std::optional<transport::Client> client;
  std::optional<BareReader> reader;
  client_thread.Do([&] {
    client.emplace(client_thread.io(), options, handlers);
    client->Start();
    reader.emplace(client_thread.io(), UnixAddress("bare"), payload_bytes + transport::kLengthBytes,
                   [&](std::string_view payload) {
                     delays_us.push_back(MicrosecondsSince(StampOf(payload)));
                   });
  });
  const bool connected = WaitUntil(client_thread, [&] {
    return client->state() == transport::LinkState::kLive && reader->connected();
  });
  if (!connected) return Failure("publish_to_client_p50: the clients did not connect");

  const auto run = [&](const std::function<void()>& publish) {
    client_thread.Do([&] { delays_us.clear(); });
    server_thread.Pace(kTicks, kIntervalNs, publish);
    double p50_us = 0;
    client_thread.Do([&] { p50_us = Quantile(delays_us, 0.5); });
    return p50_us;
  };
  const Row row = RunPairs(
      "publish_to_client_p50", "us", kPairs,
      [&] {
        return run([&] {
          auto serialised = channels;  // footingd serialises them anew and hands them over.
          server.Publish(clock::MonotonicNs(), std::move(serialised));
        });
      },
      [&] { return run([&] { bare.Publish(StampedFrame(payload_bytes)); }); });
  client_thread.Do([&] {
    client.reset();
    reader.reset();
  });
  server_thread.Do([&] { server.Stop("done"); });
  return Rows{row};
}

}  // namespace footing::bench

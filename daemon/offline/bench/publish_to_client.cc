#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <cstring>
#include <functional>
#include <optional>

#include "common/clock/clock.h"
#include "common/text/quantile.h"
#include "common/transport/client.h"
#include "common/transport/framing.h"
#include "common/transport/server.h"
#include "daemon/offline/bench/bare_fan_out.h"
#include "daemon/offline/bench/example_tick.h"
#include "daemon/offline/bench/loop_thread.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/viewer.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
namespace {

constexpr int kPublishPairs = 9;
constexpr int kPublishTicks = 200;
constexpr std::size_t kShortestTick = 400;
constexpr std::int64_t kPublishIntervalNs = 2'000'000;

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

/// Skips one varint.
std::size_t After(std::string_view payload, std::size_t at) {
  while ((static_cast<unsigned char>(payload.at(at)) & 0x80u) != 0) ++at;
  return at + 1;
}

/// host_ns of a tick without parsing it: tag and length of Envelope.tick, then epoch, sequence and
/// host_ns, each a tag of one byte and a varint (docs/protocol.md).
std::int64_t HostNsOf(std::string_view payload) {
  std::size_t at = After(payload, 2);
  at = After(payload, at + 1);
  at = After(payload, at + 1) + 1;
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7, ++at) {
    const auto byte = static_cast<unsigned char>(payload.at(at));
    value |= std::uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80) break;
  }
  return static_cast<std::int64_t>(value);
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
  transport::Server to_handler(server_thread.io(), ServerOptionsFor(500, 1), {});
  BareFanOut bare(server_thread.io());
  Result<void> listening;
  server_thread.Do([&] {
    listening = server.Listen(UnixAddress("ours"));
    if (listening) listening = to_handler.Listen(UnixAddress("handler"));
    if (listening) listening = bare.Listen(UnixAddress("bare"));
  });
  if (!listening) return listening.error();

  transport::ClientOptions options;
  options.address = UnixAddress("handler");
  transport::ClientHandlers handlers;
  handlers.on_tick = [&](const v1::Tick& tick) {
    if (!tick.snapshot()) delays_us.push_back(MicrosecondsSince(tick.host_ns()));
  };
  std::optional<transport::Client> client;
  std::optional<Viewer> viewer;
  std::optional<BareReader> reader;
  client_thread.Do([&] {
    client.emplace(client_thread.io(), options, handlers);
    client->Start();
    viewer.emplace(client_thread.io(), UnixAddress("ours"), Viewer::Greeting::kSubscribe, true,
                   [&](std::string_view payload) {
                     if (payload.size() < kShortestTick) return;  // Welcome, Subscribed, snapshot.
                     delays_us.push_back(MicrosecondsSince(HostNsOf(payload)));
                   });
    reader.emplace(client_thread.io(), UnixAddress("bare"), payload_bytes + transport::kLengthBytes,
                   [&](std::string_view payload) {
                     delays_us.push_back(MicrosecondsSince(StampOf(payload)));
                   });
  });
  const bool connected = WaitUntil(client_thread, [&] {
    return client->state() == transport::LinkState::kLive && viewer->connected() &&
           reader->connected();
  });
  if (!connected) return Failure("publish_to_client_p50: the clients did not connect");

  const auto run = [&](const std::function<void()>& publish) {
    client_thread.Do([&] { delays_us.clear(); });
    server_thread.Pace(kPublishTicks, kPublishIntervalNs, publish);
    double p50_us = 0;
    client_thread.Do([&] { p50_us = text::Quantile(delays_us, 0.5); });
    return p50_us;
  };
  const auto publish_on = [&](transport::Server& one) {
    return run([&] {
      auto serialised = channels;  // footingd serialises them again and hands them over.
      one.Publish(clock::MonotonicNs(), std::move(serialised));
    });
  };
  const auto publish_bare = [&] { return run([&] { bare.Publish(StampedFrame(payload_bytes)); }); };
  const Row bytes = RunPairs(
      "publish_to_client_p50", "us", kPublishPairs, [&] { return publish_on(server); },
      publish_bare);
  const Row parsed = RunPairs(
      "publish_to_handler_p50", "us", kPublishPairs, [&] { return publish_on(to_handler); },
      publish_bare);
  client_thread.Do([&] {
    client.reset();
    viewer.reset();
    reader.reset();
  });
  server_thread.Do([&] {
    server.Stop("done");
    to_handler.Stop("done");
  });
  return Rows{bytes, parsed};
}

}  // namespace footing::bench

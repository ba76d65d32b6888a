#include <functional>
#include <optional>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/net/server.h"
#include "daemon/offline/bench/bare_fan_out.h"
#include "daemon/offline/bench/bare_reader.h"
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

/// The servers that are compared, on a thread of their own.
class Publishers {
 public:
  Publishers()
      : to_viewer_(thread_.io(), ServerOptionsFor(500, 1), {}),
        to_handler_(thread_.io(), ServerOptionsFor(500, 1), {}),
        bare_(thread_.io()) {}
  ~Publishers() {
    thread_.Do([this] {
      to_viewer_.Stop("done");
      to_handler_.Stop("done");
    });
    thread_.Stop();
  }
  Publishers(const Publishers&) = delete;
  Publishers& operator=(const Publishers&) = delete;

  Result<void> Listen() {
    Result<void> listening;
    thread_.Do([&] {
      listening = to_viewer_.Listen(UnixAddress("ours"));
      if (listening) listening = to_handler_.Listen(UnixAddress("handler"));
      if (listening) listening = bare_.Listen(UnixAddress("bare"));
    });
    return listening;
  }

  void PublishToViewer() { Publish(to_viewer_); }
  void PublishToHandler() { Publish(to_handler_); }
  void PublishBare() {
    Pace([this] { bare_.Publish(StampedFrame(payload_bytes_)); });
  }
  std::size_t payload_bytes() const { return payload_bytes_; }

 private:
  void Publish(transport::Server& server) {
    Pace([&] { server.Publish(clock::MonotonicNs(), channels_); });
  }
  void Pace(const std::function<void()>& publish) {
    thread_.Pace(kPublishTicks, kPublishIntervalNs, publish);
  }

  const std::vector<transport::ChannelBytes> channels_ = ExampleTick();
  const std::size_t payload_bytes_ = PayloadBytes(channels_);
  LoopThread thread_;
  transport::Server to_viewer_;
  transport::Server to_handler_;
  BareFanOut bare_;
};

/// One reader of each server, on another thread; they measure how long a tick has been under way.
class Readers {
 public:
  explicit Readers(std::size_t payload_bytes) {
    transport::ClientOptions options;
    options.address = UnixAddress("handler");
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) {
      if (!tick.snapshot()) AddDelaySince(tick.host_ns());
    };
    thread_.Do([&] {
      client_.emplace(thread_.io(), options, handlers);
      client_->Start();
      viewer_.emplace(thread_.io(), UnixAddress("ours"), Viewer::Greeting::kSubscribe, true,
                      [this](std::string_view payload) {
                        // Welcome, Subscribed and the snapshot are shorter.
                        if (payload.size() >= kShortestTick) AddDelaySince(HostNsOf(payload));
                      });
      bare_.emplace(thread_.io(), UnixAddress("bare"), payload_bytes + transport::kLengthBytes,
                    [this](std::string_view payload) { AddDelaySince(StampOf(payload)); });
    });
  }
  ~Readers() {
    thread_.Do([this] {
      client_.reset();
      viewer_.reset();
      bare_.reset();
    });
    thread_.Stop();
  }
  Readers(const Readers&) = delete;
  Readers& operator=(const Readers&) = delete;

  bool WaitUntilConnected() {
    return WaitUntil(thread_, [this] {
      return client_->state() == transport::LinkState::kLive && viewer_->connected() &&
             bare_->connected();
    });
  }

  /// Median delay of what `publish` publishes until it returns.
  double MedianDelayUs(const std::function<void()>& publish) {
    thread_.Do([this] { delays_us_.clear(); });
    publish();
    double p50_us = 0;
    thread_.Do([&] { p50_us = text::Quantile(delays_us_, 0.5); });
    return p50_us;
  }

 private:
  void AddDelaySince(std::int64_t stamp_ns) {
    delays_us_.push_back(static_cast<double>(clock::MonotonicNs() - stamp_ns) * 1e-3);
  }

  std::vector<double> delays_us_;  // Of the thread.
  LoopThread thread_;
  std::optional<transport::Client> client_;
  std::optional<Viewer> viewer_;
  std::optional<BareReader> bare_;
};

}  // namespace

Result<Rows> PublishToClient() {
  Publishers publishers;
  if (auto listening = publishers.Listen(); !listening) return listening.error();
  Readers readers(publishers.payload_bytes());
  if (!readers.WaitUntilConnected()) {
    return Failure("publish_to_client_p50: the clients did not connect");
  }
  const auto publish_bare = [&] {
    return readers.MedianDelayUs([&] { publishers.PublishBare(); });
  };
  const Row bytes = RunPairs(
      "publish_to_client_p50", "us", kPublishPairs,
      [&] { return readers.MedianDelayUs([&] { publishers.PublishToViewer(); }); }, publish_bare);
  const Row parsed = RunPairs(
      "publish_to_handler_p50", "us", kPublishPairs,
      [&] { return readers.MedianDelayUs([&] { publishers.PublishToHandler(); }); }, publish_bare);
  return Rows{bytes, parsed};
}

}  // namespace footing::bench

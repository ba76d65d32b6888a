#include "daemon/offline/bench/bare_reader.h"

#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>

#include "common/base/text.h"
#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/net/server.h"
#include "common/net/tick.h"
#include "common/runtime/clock.h"
#include "daemon/offline/bench/broker_link.h"
#include "daemon/offline/bench/pairs.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {

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

BareReader::BareReader(boost::asio::io_context& io, const transport::Address& address,
                       std::size_t frame_bytes, std::function<void(std::string_view)> on_payload)
    : frame_(frame_bytes, '\0'), on_payload_(std::move(on_payload)) {
  transport::Dial(io, address, [this](Result<transport::Socket> socket) {
    if (!socket) return;  // It shows as not connected.
    socket_.emplace(std::move(*socket));
    Read();
  });
}

void BareReader::Read() {
  boost::asio::async_read(socket_->plain(), boost::asio::buffer(frame_),
                          [this](const boost::system::error_code& error, std::size_t) {
                            if (error) return;
                            on_payload_(std::string_view(frame_).substr(transport::kLengthBytes));
                            Read();
                          });
}

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

  std::vector<double> delays_us_;  // Delays measured on the reader's thread.
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

namespace {

constexpr int kRaceTicks = 300;
constexpr int kRaceRounds = 7;
constexpr std::int64_t kRaceIntervalNs = 2'000'000;

/// Bare Asio, with readers that parse.
constexpr const char* kBareParsed = "bare_parsed";

struct RaceWay {
  std::string name;               ///< Empty: bare Asio.
  std::function<void()> publish;  ///< On the publishing thread.
  std::vector<double> p50_us = {}, p99_us = {};
};

/// The envelope of a tick made now.
std::string TickPayload(const std::vector<transport::ChannelBytes>& channels) {
  transport::Tick tick;
  for (const auto& channel : channels) transport::AppendField(channel.field, channel.bytes, tick);
  transport::TickHead head;
  head.epoch = ~0ull;
  head.sequence = 1000;
  head.host_ns = clock::MonotonicNs();
  std::array<char, transport::kMaxTickHeadBytes> bytes;
  const std::size_t size = transport::EncodeTickHead(head, tick.bytes.size(), bytes.data());
  return std::string(bytes.data() + transport::kLengthBytes, size - transport::kLengthBytes) +
         tick.bytes;
}

class Race {
 public:
  Race()
      : server_(publisher_.io(), ServerOptionsFor(500, 1), {}),
        bare_(publisher_.io()),
        parsed_(publisher_.io()) {}
  ~Race() {
    lsl_.reset();  // Its thread uses the reader's.
    publisher_.Do([this] { server_.Stop("done"); });
    reader_.Do([this] {
      client_.reset();
      bare_reader_.reset();
      parsed_reader_.reset();
      subscribers_.clear();
    });
    publisher_.Do([this] { publishers_.clear(); });
    reader_.Stop();
    publisher_.Stop();
  }
  Race(const Race&) = delete;
  Race& operator=(const Race&) = delete;

  Result<void> Begin() {
    Result<void> listening;
    publisher_.Do([&] {
      listening = server_.Listen(UnixAddress("race"));
      if (listening) listening = bare_.Listen(UnixAddress("race-bare"));
      if (listening) listening = parsed_.Listen(UnixAddress("race-parsed"));
    });
    if (!listening) return listening;
    ways_.push_back({"ours", [this] { server_.Publish(clock::MonotonicNs(), channels_); }});
    ways_.push_back({"", [this] { bare_.Publish(BareFrame()); }});
    ways_.push_back({kBareParsed, [this] {
                       parsed_.Publish(std::make_shared<const std::string>(
                           transport::Frame(TickPayload(channels_))));
                     }});
    ConnectOwn();
    ConnectBare();
    for (const BrokerKind kind : {BrokerKind::kMosquitto, BrokerKind::kNats}) {
      if (auto broker = Broker::Start(kind)) ConnectBroker(std::move(broker));
    }
    ConnectLsl();
    const bool ready = WaitUntil(reader_, [this] {
      bool all = client_->state() == transport::LinkState::kLive && bare_reader_->connected() &&
                 parsed_reader_->connected();
      for (const auto& link : subscribers_) all = all && link->ready();
      return all;
    });
    if (!ready) return Failure("publish_to_handler: the clients did not connect");
    return {};
  }

  Result<void> Run() {
    for (int round = -1; round < kRaceRounds; ++round) {  // The first one warms up.
      for (std::size_t i = 0; i < ways_.size(); ++i) {
        RaceWay& way = ways_[round % 2 == 0 ? i : ways_.size() - 1 - i];
        reader_.Do([this] { delays_us_.clear(); });
        publisher_.Pace(kRaceTicks, kRaceIntervalNs, way.publish);
        if (!WaitUntil(reader_, [this] { return delays_us_.size() >= kRaceTicks; })) {
          return Failure("publish_to_handler: ticks were lost by " +
                         (way.name.empty() ? std::string("bare Asio") : way.name));
        }
        if (round < 0) continue;
        way.p50_us.push_back(text::Quantile(delays_us_, 0.5));
        way.p99_us.push_back(text::Quantile(delays_us_, 0.99));
      }
    }
    return {};
  }

  const std::vector<RaceWay>& ways() const { return ways_; }

 private:
  void ConnectOwn() {
    transport::ClientOptions options;
    options.address = UnixAddress("race");
    transport::ClientHandlers handlers;
    handlers.on_tick = [this](const v1::Tick& tick) {
      if (!tick.snapshot()) AddDelaySince(tick.host_ns());
    };
    reader_.Do([&] {
      client_.emplace(reader_.io(), options, handlers);
      client_->Start();
    });
  }

  void ConnectBare() {
    const std::size_t bytes = payload_bytes_ + transport::kLengthBytes;
    reader_.Do([&] {
      bare_reader_.emplace(reader_.io(), UnixAddress("race-bare"), bytes,
                           [this](std::string_view payload) { AddDelaySince(StampOf(payload)); });
      parsed_reader_.emplace(reader_.io(), UnixAddress("race-parsed"), bytes,
                             [this](std::string_view payload) { ParseAndAddDelay(payload); });
    });
  }

  void ConnectBroker(std::unique_ptr<Broker> broker) {
    brokers_.push_back(std::move(broker));
    const Broker& of = *brokers_.back();
    reader_.Do([&] {
      subscribers_.push_back(std::make_unique<BrokerLink>(
          reader_.io(), of, BrokerLink::Part::kSubscribes, 1,
          [this](std::string_view payload) { ParseAndAddDelay(payload); }));
    });
    publisher_.Do([&] {
      publishers_.push_back(std::make_unique<BrokerLink>(publisher_.io(), of,
                                                         BrokerLink::Part::kPublishes, 2, nullptr));
      ways_.push_back({NameOf(of.kind()), [this, link = publishers_.back().get()] {
                         link->Publish(TickPayload(channels_));
                       }});
    });
  }

  /// Its inlet has a thread of its own, on which the tick is parsed and its delay taken.
  void ConnectLsl() {
    lsl_ = LslLink::Start([this](std::string_view payload) {
      const v1::Envelope* const message = lsl_parser_.Parse(payload);
      if (message == nullptr) return;
      const double delay_us = DelayUsSince(message->tick().host_ns());
      lsl_parser_.Discard();
      boost::asio::post(reader_.io(), [this, delay_us] { delays_us_.push_back(delay_us); });
    });
    if (lsl_ == nullptr) return;
    ways_.push_back({"lsl", [this] { lsl_->Publish(TickPayload(channels_)); }});
  }

  /// Bytes as long as ours, which nobody parses.
  std::shared_ptr<const std::string> BareFrame() const { return StampedFrame(payload_bytes_); }

  void ParseAndAddDelay(std::string_view payload) {
    const v1::Envelope* const message = parser_.Parse(payload);
    if (message != nullptr) AddDelaySince(message->tick().host_ns());
    parser_.Discard();  // As our own client does.
  }

  static double DelayUsSince(std::int64_t stamp_ns) {
    return static_cast<double>(clock::MonotonicNs() - stamp_ns) * 1e-3;
  }
  void AddDelaySince(std::int64_t stamp_ns) { delays_us_.push_back(DelayUsSince(stamp_ns)); }

  const std::vector<transport::ChannelBytes> channels_ = ExampleTick();
  const std::size_t payload_bytes_ = TickPayload(channels_).size();
  LoopThread publisher_;
  LoopThread reader_;
  transport::Server server_;
  BareFanOut bare_;
  BareFanOut parsed_;
  std::vector<std::unique_ptr<Broker>> brokers_;
  std::vector<RaceWay> ways_;
  std::vector<double> delays_us_;  // Delays measured on the reader's thread.
  transport::MessageParser parser_;
  std::optional<transport::Client> client_;
  std::optional<BareReader> bare_reader_;
  std::optional<BareReader> parsed_reader_;
  std::vector<std::unique_ptr<BrokerLink>> subscribers_;
  std::vector<std::unique_ptr<BrokerLink>> publishers_;
  transport::MessageParser lsl_parser_;
  std::unique_ptr<LslLink> lsl_;
};

Row RaceRow(const std::string& name, const std::vector<double>& ours,
            const std::vector<double>& baseline) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < ours.size(); ++i) ratios.push_back(ours[i] / baseline[i]);
  return {name, text::Median(ours), text::Median(baseline), text::Median(ratios), "us"};
}

}  // namespace

Result<Rows> PublishToHandler() {
  Race race;
  if (auto begun = race.Begin(); !begun) return begun.error();
  if (auto run = race.Run(); !run) return run.error();
  const RaceWay& ours = race.ways().front();
  Rows rows;
  for (std::size_t i = 1; i < race.ways().size(); ++i) {
    const RaceWay& other = race.ways()[i];
    const std::string against = other.name.empty() ? "" : "_" + other.name;
    rows.push_back(RaceRow("publish_to_handler" + against + "_p50", ours.p50_us, other.p50_us));
    rows.push_back(RaceRow("publish_to_handler" + against + "_p99", ours.p99_us, other.p99_us));
  }
  return rows;
}

}  // namespace footing::bench

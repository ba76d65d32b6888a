#include <array>
#include <boost/asio/post.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/runtime/clock.h"
#include "common/base/quantile.h"
#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/net/message_parser.h"
#include "common/net/server.h"
#include "common/net/tick.h"
#include "daemon/offline/bench/bare_fan_out.h"
#include "daemon/offline/bench/bare_reader.h"
#include "daemon/offline/bench/broker_link.h"
#include "daemon/offline/bench/example_tick.h"
#include "daemon/offline/bench/lsl_link.h"
#include "daemon/offline/bench/row.h"
#include "daemon/offline/bench/waiting.h"

namespace footing::bench {
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
  std::vector<double> delays_us_;  // Of the reader's thread.
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

#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/relay/mqtt_link.h"
#include "clients/relay/nats_link.h"
#include "clients/relay/source.h"
#include "clients/relay/thinner.h"
#include "common/base/result.h"
#include "common/net/token_bucket.h"

namespace footing::relay {

struct PublisherOptions {
  std::string site;
  std::vector<transport::Address> servers;
  std::vector<std::string> channels;  ///< Empty: all.
  std::optional<NatsOptions> nats;
  std::optional<MqttOptions> mqtt;
  double mqtt_rate_hz = 20;  ///< Of each channel of samples; 0: every tick.
};

struct PublisherReport {
  struct SourceState {
    std::string address;
    std::string server;  ///< Empty until it has welcomed us.
    bool up = false;
  };
  std::uint64_t ticks = 0;
  std::uint64_t missing = 0;    ///< Ticks that never came from the servers.
  std::uint64_t published = 0;  ///< Messages, answers not counted.
  std::uint64_t dropped = 0;    ///< Messages that a broker did not take: gone, slow, or too small.
  std::vector<SourceState> sources;
  std::optional<bool> nats_up, mqtt_up;  ///< Of the brokers that are published in.
};

/// Publishes the ticks of servers in NATS, as they are, and in MQTT, a channel a topic. Everything
/// runs on the io_context's one thread.
class Publisher {
 public:
  Publisher(boost::asio::io_context& io, PublisherOptions options);
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  Result<void> Start();
  void Stop();
  PublisherReport report() const;
  /// Fails when no server has ever welcomed it, or no broker has ever taken anything.
  Result<void> CheckUseful() const;

 private:
  void OnNamed(Source& source);
  void OnTick(const Source& source, const v1::Tick& tick);
  void OnAsked(const nats::Message& message);
  void PublishChannels(const Source& source, const v1::Tick& tick);
  void RepeatRetained();
  static void Say(const std::string& line, std::string& state);
  const Source* Asked(std::string_view subject) const;

  PublisherOptions options_;
  std::vector<std::unique_ptr<Source>> sources_;
  std::optional<NatsLink> nats_;
  std::optional<MqttLink> mqtt_;
  std::map<std::uint64_t, Thinner> thinners_;  ///< For MQTT, by epoch.
  std::string nats_state_, mqtt_state_;        ///< As logged last.
  transport::TokenBucket answers_;
  std::uint64_t published_ = 0;
};

}  // namespace footing::relay

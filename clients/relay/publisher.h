#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/relay/channels.h"
#include "clients/relay/nats_link.h"
#include "common/base/result.h"
#include "common/net/client.h"
#include "common/net/limits.h"
#include "footing/v1/session.pb.h"

namespace footing::relay {

/// One server whose ticks are published: the session with it, and what one who comes later needs.
class Source {
 public:
  struct Handlers {
    /// It is known now what the server is called. Again when another server answers there.
    std::function<void(Source&)> on_named;
    /// Live, refilled and snapshot ticks.
    std::function<void(Source&, const v1::Tick&)> on_tick;
  };

  Source(boost::asio::io_context& io, const transport::Address& address,
         const std::vector<std::string>& channels, Handlers handlers);

  void Start() { client_.Start(); }
  void Stop() { client_.Stop(); }

  /// Empty until it has welcomed us. One part of a subject.
  const std::string& name() const { return name_; }
  const std::string& address() const { return address_; }
  bool live() const { return client_.state() == transport::LinkState::kLive; }
  std::uint64_t epoch() const { return welcome_.epoch(); }
  double tick_rate_hz() const;
  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t missing() const { return missing_; }  ///< Ticks of Gaps.
  const std::string& link() const { return link_; }   ///< A line for a person.

  const v1::Welcome& welcome() const { return welcome_; }
  /// The last values of the retained channels.
  const v1::Tick& snapshot() const { return snapshot_; }
  /// The server's clock; nothing while it is not known.
  std::optional<std::int64_t> ServerNs() const;

 private:
  void OnWelcome(const v1::Welcome& welcome);
  void OnTick(const v1::Tick& tick);

  Handlers handlers_;
  std::string address_;
  std::string name_;
  std::string link_;
  v1::Welcome welcome_;
  v1::Tick snapshot_;
  std::uint64_t ticks_ = 0;
  std::uint64_t missing_ = 0;
  transport::Client client_;
};

/// Options of a publisher.
struct PublisherOptions {
  std::string site;
  std::vector<transport::Address> servers;
  std::vector<std::string> channels;  ///< Empty: all.
  std::optional<NatsOptions> nats;
  std::optional<MqttOptions> mqtt;
  double mqtt_rate_hz = 20;  ///< Rate of each channel of samples; 0: every tick.
};

/// State and counts of a publisher.
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
  std::optional<bool> nats_up, mqtt_up;  ///< State of each configured broker.
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

#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/net/client.h"
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

}  // namespace footing::relay

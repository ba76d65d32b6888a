#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/net/socket.h"
#include "daemon/offline/bench/broker.h"

namespace footing::bench {

/// A client of a broker at its barest: one topic, QoS 0, no acknowledgements. It answers nothing,
/// so that it lasts for a minute or two.
class BrokerLink {
 public:
  enum class Part { kPublishes, kSubscribes };

  /// Dials at once. `number` makes its name.
  BrokerLink(boost::asio::io_context& io, const Broker& broker, Part part, int number,
             std::function<void(std::string_view payload)> on_payload);
  ~BrokerLink();
  BrokerLink(const BrokerLink&) = delete;
  BrokerLink& operator=(const BrokerLink&) = delete;

  /// The broker has taken it in, with its subscription.
  bool ready() const;
  void Publish(std::string_view payload);

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::bench

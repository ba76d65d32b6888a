#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "clients/stream/plan.h"
#include "common/net/address.h"

namespace footing::stream_client {

struct DialerOptions {
  transport::Address to;
  double rate_scale = 1;  ///< The devices' clocks run this much faster than nominal.
};

/// Attaches the simulated devices to footingd's device socket, delivers their reports in real time,
/// passes its output reports to them, and sends the feeds. Dials again whenever the connection is
/// lost; the motion then starts from the beginning, as with a device that reconnects.
class Dialer {
 public:
  /// `on_end` is called when the motion has come to its end.
  Dialer(boost::asio::io_context& io, DialerOptions options, Plan plan,
         std::function<void()> on_end);
  ~Dialer();
  Dialer(const Dialer&) = delete;
  Dialer& operator=(const Dialer&) = delete;

  void Start();
  /// Detaches every device and closes.
  void Stop(const std::string& reason);
  /// Whether footingd has been there at any time.
  bool has_attached() const;
  /// Whether footingd has refused every device, on the present or the last connection.
  bool all_refused() const;

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::stream_client

#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "clients/stream/plan.h"
#include "common/transport/address.h"

namespace footing::stream_client {

struct DialerOptions {
  transport::Address to;
  double rate_scale = 1;  ///< The devices' clocks run this much faster than nominal.
};

/// Attaches the stand-ins to footingd's device socket, delivers their reports in real time and
/// passes its output reports to them; what is told without a device is sent besides. Dials again
/// whenever the connection is lost; the motion then begins anew, as a device that reconnects does.
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

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::stream_client

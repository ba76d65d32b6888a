#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "common/net/address.h"
#include "common/net/framed_connection.h"

namespace footing::bench {

/// A cheap reader: takes frames and looks into none but a Ping, which it answers. It reads the bare
/// baseline's frames as well as ours.
class Viewer {
 public:
  enum class Greeting { kNone, kSubscribe };

  /// Dials at once. `on_frame` gets every frame but pings; with `reads` false it never reads.
  Viewer(boost::asio::io_context& io, const transport::Address& address, Greeting greeting,
         bool reads, std::function<void(std::string_view)> on_frame);

  bool connected() const { return connection_.has_value() && connection_->open(); }

 private:
  void OnFrame(std::string_view payload);

  std::function<void(std::string_view)> on_frame_;
  std::optional<transport::FramedConnection> connection_;
};

}  // namespace footing::bench

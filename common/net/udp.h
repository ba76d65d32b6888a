#pragma once

#include <string>

#include <boost/asio/ip/udp.hpp>

#include "common/base/result.h"

namespace footing::transport {

/// "HOST:PORT" with a numeric host, "localhost" (127.0.0.1) or "[IPv6]"; a usage error names
/// `option`. Port 0 is for a listener only: the system chooses one.
Result<boost::asio::ip::udp::endpoint> ParseUdp(const std::string& text, const std::string& option);

}  // namespace footing::transport

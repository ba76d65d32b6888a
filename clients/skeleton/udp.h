#pragma once

#include <boost/asio/ip/udp.hpp>
#include <string>

#include "common/base/result.h"

namespace footing::skeleton {

/// "HOST:PORT" with a numeric host, "localhost" or "[IPv6]"; a usage error names `option`. Port 0
/// is for a listener only: the system chooses one.
Result<boost::asio::ip::udp::endpoint> ParseUdp(const std::string& text, const std::string& option);

}  // namespace footing::skeleton

#include "common/net/udp.h"

#include <cstddef>
#include <cstdint>

#include <boost/asio/ip/address.hpp>

#include "common/base/text.h"

namespace footing::transport {

Result<boost::asio::ip::udp::endpoint> ParseUdp(const std::string& text,
                                                const std::string& option) {
  const auto wrong = [&] {
    return UsageError(option + " " + text +
                      ": must be HOST:PORT with a numeric host, such as 127.0.0.1:7110 or "
                      "[::1]:7110");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return wrong();
  std::string host = text.substr(0, colon);
  const auto port = text::ToCount(text.substr(colon + 1));
  if (!port || *port > 65'535) return wrong();
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (host == "localhost") host = "127.0.0.1";
  if (bracketed) host = host.substr(1, host.size() - 2);
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  // Without brackets the port of an IPv6 address would be a guess.
  if (error || bracketed != address.is_v6()) return wrong();
  return boost::asio::ip::udp::endpoint(address, static_cast<std::uint16_t>(*port));
}

}  // namespace footing::transport

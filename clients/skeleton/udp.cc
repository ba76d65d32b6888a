#include "clients/skeleton/udp.h"

#include <boost/asio/ip/address.hpp>

#include "common/base/number.h"

namespace footing::skeleton {

Result<boost::asio::ip::udp::endpoint> ParseUdp(const std::string& text,
                                                const std::string& option) {
  const auto wrong = [&] {
    return UsageError(option + " " + text + ": not HOST:PORT, for example 127.0.0.1:7110");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return wrong();
  std::string host = text.substr(0, colon);
  const auto port = text::ToCount(text.substr(colon + 1));
  if (!port || *port > 65'535) return wrong();
  if (host == "localhost") host = "127.0.0.1";
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  if (error) return wrong();
  return boost::asio::ip::udp::endpoint(address, static_cast<std::uint16_t>(*port));
}

}  // namespace footing::skeleton

#include "common/net/own_address.h"

#include <algorithm>
#include <array>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

namespace footing::transport {
namespace {

namespace asio = boost::asio;

/// An address of no host (RFC 5737): a UDP socket that is connected to it sends nothing, but the
/// kernel says which way it would take.
constexpr const char* kElsewhere = "192.0.2.1";

bool IsLoopback(const std::string& host) {
  boost::system::error_code error;
  const asio::ip::address address = asio::ip::make_address(host, error);
  return error || address.is_loopback();
}

}  // namespace

std::vector<std::string> OwnAddresses() {
  std::vector<std::string> addresses;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return addresses;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    if ((one->ifa_flags & IFF_UP) == 0) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) != nullptr)
      addresses.emplace_back(text.data());
  }
  ::freeifaddrs(all);
  return addresses;
}

bool IsEveryAddress(const std::string& host) {
  boost::system::error_code error;
  const asio::ip::address address = asio::ip::make_address(host, error);
  return !error && address.is_unspecified();
}

std::string AddressForOthers() {
  boost::system::error_code error;
  asio::io_context io;
  asio::ip::udp::socket socket(io);
  socket.open(asio::ip::udp::v4(), error);
  if (!error) socket.connect({asio::ip::make_address(kElsewhere), 9}, error);
  if (!error) {
    const auto own = socket.local_endpoint(error);
    if (!error && !own.address().is_loopback()) return own.address().to_string();
  }
  const auto addresses = OwnAddresses();
  const auto found = std::find_if_not(addresses.begin(), addresses.end(), IsLoopback);
  return found == addresses.end() ? "" : *found;
}

}  // namespace footing::transport

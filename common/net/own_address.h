#pragma once

#include <string>
#include <vector>

namespace footing::transport {

/// The numeric IPv4 addresses of this host's interfaces that are up, loopback among them.
std::vector<std::string> OwnAddresses();

/// Whether an address to listen on means every interface, 0.0.0.0 or ::, so that nobody can dial
/// it.
bool IsEveryAddress(const std::string& host);

/// The address by which other hosts most likely reach this one: that of its way to other networks,
/// else of its first interface but loopback; empty: it is in no network.
std::string AddressForOthers();

}  // namespace footing::transport

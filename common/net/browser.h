#pragma once

#include <string>
#include <vector>

#include "common/net/avahi.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::discovery {

/// A server that answers mDNS; whoever sits in the network may claim to be one.
struct Found {
  Service service;
  transport::Address address;
};

/// Asks avahi-daemon who is there, by name, and waits at most `within_s` for the answers. An error
/// when there is no system bus or no avahi-daemon.
Result<std::vector<Found>> Browse(double within_s);

}  // namespace footing::discovery

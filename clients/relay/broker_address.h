#pragma once

#include <string>

#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::relay {

/// Where a broker listens: "tcp:HOST:PORT" or "HOST:PORT", on this host. What would leave it in
/// clear is refused; `instead` says what to do.
Result<transport::Address> ParseBrokerAddress(const std::string& text, const std::string& instead);

}  // namespace footing::relay

#pragma once

#include <string>

#include "clients/relay/nats_protocol.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::relay {

/// A file that only its owner may read (mode 0600 or less): one line is a token; two are a user and
/// a password. An empty path gives an empty login. What it holds is never logged.
Result<nats::Login> ReadLoginFile(const std::string& path);

/// Where a broker listens: "tcp:HOST:PORT" or "HOST:PORT", on this host. What would leave it in
/// clear is refused; `instead` says what to do.
Result<transport::Address> ParseBrokerAddress(const std::string& text, const std::string& instead);

}  // namespace footing::relay

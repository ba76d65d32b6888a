#pragma once

#include <string>

#include "clients/relay/requests.h"
#include "common/base/result.h"

namespace footing::relay {

/// A file that only its owner may read (mode 0600 or less): one line is a token; two are a user and
/// a password. An empty path gives an empty login. What it holds is never logged.
Result<nats::Login> ReadLoginFile(const std::string& path);

}  // namespace footing::relay

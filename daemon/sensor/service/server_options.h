#pragma once

#include <string>

#include "common/base/result.h"
#include "common/net/access.h"
#include "common/net/server.h"
#include "daemon/sensor/service/config.h"

namespace footing::sensor {

/// The socket that the service manager passed under this name, or the user's own.
std::string OwnAddress(const std::string& name);

/// Who may come over TCP and TLS; a configured state_directory has the certificate, too.
transport::AccessSettings AccessOf(const Config& config);

/// What the start checks besides the config itself, without its sockets and devices.
Result<void> CheckStart(const Config& config);

/// `with_access`: who may come in.
transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version,
                                           const transport::ServerOptions& with_access);

}  // namespace footing::sensor

#pragma once

#include <string>

#include "common/transport/server.h"
#include "daemon/sensor/service/config.h"

namespace footing::sensor {

/// The socket that the service manager passed under this name, or the user's own.
std::string OwnAddress(const std::string& name);

/// `with_access`: who may come in.
transport::ServerOptions MakeServerOptions(const Config& config, const std::string& version,
                                           const transport::ServerOptions& with_access);

}  // namespace footing::sensor

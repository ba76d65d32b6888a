#pragma once

#include <functional>
#include <string>

#include "common/net/address.h"
#include "daemon/offline/bench/loop_thread.h"

namespace footing::bench {

/// A Unix socket of this run's own.
transport::Address UnixAddress(const std::string& name);
/// Loopback, any free port.
transport::Address TcpAddress();

/// Asks `condition` on the thread every 5 ms; false when it does not hold within 5 s.
bool WaitUntil(LoopThread& thread, const std::function<bool()>& condition);

/// Resident memory of this process.
double ResidentMegabytes();

}  // namespace footing::bench

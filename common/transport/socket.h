#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <string>

#include "common/result/result.h"
#include "common/timer/timer.h"
#include "common/transport/address.h"

/// One socket type for Unix and TCP, so that everything above shares its code.
namespace footing::transport {

using Socket = boost::asio::generic::stream_protocol::socket;
using Endpoint = boost::asio::generic::stream_protocol::endpoint;

/// The address as the kernel takes it. "localhost" is 127.0.0.1; other hosts must be numeric, so
/// that no name server is asked. Usage error otherwise.
Result<Endpoint> EndpointOf(const Address& address);

/// True for a Unix socket and for 127.0.0.0/8 and ::1.
bool StaysOnThisHost(const Address& address);

/// Connects without blocking; `done` gets the socket or one line with the reason, for example
/// "unix:/run/x.sock: no such file". `done` may be dropped with the io_context.
void Dial(boost::asio::io_context& io, const Address& address,
          std::function<void(Result<Socket>)> done);

/// Non-blocking, TCP_NODELAY, and a send buffer small enough that a slow reader's data do not wait
/// in the kernel where nobody can drop them.
void Prepare(Socket& socket);

/// Whether a timer that has just ended did so more than a second late: the program itself, or the
/// machine, stood still, and the silence meanwhile is nobody else's fault.
inline bool WasLate(const timer::Timer& timer) {
  return timer::Now() - timer.expiry() > std::chrono::seconds(1);
}

/// The system's words for an error, begun in lower case.
std::string MessageOf(const boost::system::error_code& error);

}  // namespace footing::transport

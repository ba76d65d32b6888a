#pragma once

#include <cstdint>
#include <string>

#include "common/base/result.h"

namespace footing::transport {

/// Where a listener listens and a client dials: "unix:PATH", "tcp:HOST:PORT", or "tls:HOST:PORT"
/// for TLS 1.3 over TCP. A listener may also take the socket that the service manager passed under
/// a name: "fd:NAME"; if that is one of TCP, it speaks TLS.
struct Address {
  enum class Kind { kUnix, kTcp, kTls, kPassed };
  Kind kind = Kind::kUnix;
  std::string path;  ///< Unix socket; of a passed one its name.
  std::string host;  ///< TCP and TLS: a numeric address or "localhost".
  std::uint16_t port = 0;

  std::string Text() const;
  /// Over TCP, in clear or not: the kernel does not know who is at the other end.
  bool OverTcp() const { return kind == Kind::kTcp || kind == Kind::kTls; }
};

/// Usage error with the right form when the text is none.
Result<Address> ParseAddress(const std::string& text);

/// Where a program listens when nothing is said: unix:$XDG_RUNTIME_DIR/footing/NAME.sock, or
/// unix:/tmp/footing-UID/NAME.sock where there is no runtime directory. NAME is "sensor", "devices"
/// or "simulation". A client (`create` not set) finds the service's /run/footing/NAME.sock where
/// the user has none of that name. Creates the folder with mode 0700 if `create` is set.
Address DefaultAddress(const std::string& name, bool create = false);

}  // namespace footing::transport

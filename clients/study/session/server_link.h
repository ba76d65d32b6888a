#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "clients/study/session/console.h"
#include "clients/study/session/held_lease.h"
#include "common/net/client.h"

namespace footing::study {

/// What a session wants of a server.
struct ServerLinkOptions {
  std::string server;  ///< "footingd" or "footing-sim".
  transport::Address address;
  std::vector<std::string> channels;
  std::string holder;  ///< Of the server's lease.
};

struct ServerLinkHandlers {
  std::function<void(const v1::Tick&)> on_tick;
  std::function<void()> on_down;  ///< The connection is lost and is being restored.
};

/// A session's connection to one server, with that server's lease. A connection that breaks goes on
/// where it was: the server keeps the ticks of that time.
class ServerLink {
 public:
  ServerLink(Console& console, ServerLinkOptions options, ServerLinkHandlers handlers);
  ~ServerLink();
  ServerLink(const ServerLink&) = delete;
  ServerLink& operator=(const ServerLink&) = delete;

  transport::Client& client();
  HeldLease& lease();
  const HeldLease& lease() const;
  const std::string& name() const;  ///< "footingd at unix:...".
  /// How it stands, for a person.
  std::string Text() const;

  /// The server is there and does not let this program in.
  bool refused() const;
  /// Connected, and the lease is held where it is wanted.
  bool up() const;
  /// A trial cannot go on: the server was restarted, ticks are missing, the lease was taken over,
  /// or the link has been down for 4 s.
  bool broken() const;
  /// Times that it was down.
  std::uint64_t breaks() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::study

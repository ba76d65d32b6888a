#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "common/config/config.h"
#include "common/transport/input_pace.h"
#include "common/transport/peer.h"

namespace footing::transport {

/// How many sessions a server has at once, and what each may send: settings of both servers.
///
/// Administrators (the server's own user and root, on the Unix socket) have places of their own
/// beyond `max_sessions`, half of which only root may take: no crowd of others locks them out.
struct SessionLimits {
  std::int64_t max_sessions = 256;
  /// Of one user; all sessions over TCP count as one user's, since nobody knows whose they are.
  std::int64_t max_sessions_per_user = 224;
  /// Over TLS, of one host, before they are welcomed: who has no token cannot take all places.
  std::int64_t max_entering_per_host = 64;
  std::int64_t admin_places = 16;
  std::int64_t max_log_sessions = 64;      ///< With the role log, administrators not counted.
  std::int64_t max_control_sessions = 32;  ///< With the role control, likewise.
  /// What one session may send, on the average and at once after a pause; a Subscribe counts as 20,
  /// a Command as 2. A session that sends more is slowed and informed.
  double session_messages_per_s = 100;
  double session_kilobytes_per_s = 1024;

  void Bind(config::Binder& binder);
  InputBudget Input() const;
};

/// The sessions that there are, those being refused not counted.
struct SessionCounts {
  std::int64_t all = 0;
  std::int64_t of_user = 0;  ///< Of the user that comes now.
  /// Over TLS from the host that comes now, and not welcomed yet.
  std::int64_t entering_of_host = 0;
};

/// Why there is not a place for one more session of this peer; empty when there is.
std::string WhyNoPlace(const SessionLimits& limits, const Peer& peer, uid_t own_user,
                       const SessionCounts& taken);

/// Why the role cannot be had by one more; empty when it can. `taken`: sessions that have it.
std::string WhyRoleIsTaken(const SessionLimits& limits, v1::Role role, std::int64_t taken);

}  // namespace footing::transport

#include "common/transport/session_limits.h"

namespace footing::transport {
namespace {

constexpr double kMostSessions = 8000;  // Each is a file descriptor; the units allow 8192.

}  // namespace

void SessionLimits::Bind(config::Binder& binder) {
  constexpr auto most = static_cast<std::int64_t>(kMostSessions);
  binder.Integer("max_sessions", max_sessions, 1, most, "Sessions at once");
  binder.Integer("max_sessions_per_user", max_sessions_per_user, 1, most,
                 "Sessions of one user at once; all those over TCP count as one user's");
  binder.Integer(
      "max_entering_per_host", max_entering_per_host, 1, most,
      "Connections over TLS of one host that have not shown a token or a certificate yet");
  binder.Integer("admin_places", admin_places, 2, 100,
                 "Further sessions for the server's own user and root; half of them for root only");
  binder.Integer("max_log_sessions", max_log_sessions, 1, most,
                 "Sessions with the role log, without those of the server's own user and root");
  binder.Integer("max_control_sessions", max_control_sessions, 1, most,
                 "Sessions with the role control, without those of the server's own user and root");
  binder.Number("session_messages_per_s", session_messages_per_s, 10, 100000,
                "Messages that a session may send per second before it is slowed");
  binder.Number("session_kilobytes_per_s", session_kilobytes_per_s, 64, 1e6,
                "Kilobytes that a session may send per second before it is slowed");
}

InputBudget SessionLimits::Input() const {
  constexpr double kBurstS = 0.25;  // Of bytes: the longest message fits in four times.
  const double bytes_per_s = session_kilobytes_per_s * 1024;
  return {session_messages_per_s, session_messages_per_s, bytes_per_s, kBurstS * bytes_per_s};
}

std::string WhyNoPlace(const SessionLimits& limits, const Peer& peer, uid_t own_user,
                       const SessionCounts& taken) {
  if (peer.known && (peer.user == own_user || peer.user == 0)) {
    const std::int64_t for_all = peer.user == 0 ? limits.admin_places : limits.admin_places / 2;
    if (taken.all < limits.max_sessions + for_all) return "";
    return std::to_string(taken.all) + " sessions already, those for administrators included";
  }
  if (taken.all >= limits.max_sessions) {
    return std::to_string(limits.max_sessions) + " sessions already";
  }
  if (taken.entering_of_host >= limits.max_entering_per_host) {
    return std::to_string(limits.max_entering_per_host) +
           " unauthenticated connections from this host";
  }
  if (taken.of_user < limits.max_sessions_per_user) return "";
  return std::to_string(limits.max_sessions_per_user) +
         (peer.known ? " sessions of this user already" : " sessions over TCP already");
}

std::string WhyRoleIsTaken(const SessionLimits& limits, v1::Role role, std::int64_t taken) {
  const bool log = role == v1::ROLE_LOG;
  if (!log && role != v1::ROLE_CONTROL) return "";
  const std::int64_t most = log ? limits.max_log_sessions : limits.max_control_sessions;
  if (taken < most) return "";
  return std::to_string(most) + " sessions with the role " + (log ? "log" : "control") + " already";
}

}  // namespace footing::transport

#include "common/net/limits.h"

#include <algorithm>
#include <array>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace footing::transport {
namespace {

std::string HostOf(int socket) {
  sockaddr_storage name{};
  socklen_t size = sizeof(name);
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (getpeername(socket, reinterpret_cast<sockaddr*>(&name), &size) != 0) return "";
  const void* address = &reinterpret_cast<const sockaddr_in*>(&name)->sin_addr;
  if (name.ss_family == AF_INET6) {
    address = &reinterpret_cast<const sockaddr_in6*>(&name)->sin6_addr;
  }
  const bool written = inet_ntop(name.ss_family, address, text.data(), text.size()) != nullptr;
  return written ? text.data() : "";
}

}  // namespace

Peer PeerOf(int socket) {
  Peer peer;
  ucred credentials{};
  socklen_t size = sizeof(credentials);
  sockaddr name{};
  socklen_t name_size = sizeof(name);
  if (getsockname(socket, &name, &name_size) != 0 || name.sa_family != AF_UNIX) {
    peer.host = HostOf(socket);
    return peer;
  }
  if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return peer;
  peer.known = true;
  peer.user = credentials.uid;
  peer.groups = {credentials.gid};
  constexpr std::size_t kMaxGroups = 1024;  // More are not needed to find one.
  std::vector<gid_t> groups(kMaxGroups);
  socklen_t bytes = static_cast<socklen_t>(groups.size() * sizeof(gid_t));
  if (getsockopt(socket, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &bytes) == 0) {
    groups.resize(bytes / sizeof(gid_t));
    peer.groups.insert(peer.groups.end(), groups.begin(), groups.end());
  }
  return peer;
}

v1::Role HighestRole(const Peer& peer, uid_t own_user, gid_t own_group) {
  if (!peer.known) return v1::ROLE_LOG;
  if (peer.user == own_user || peer.user == 0) return v1::ROLE_ADMIN;
  const bool in_group =
      std::find(peer.groups.begin(), peer.groups.end(), own_group) != peer.groups.end();
  return in_group ? v1::ROLE_CONTROL : v1::ROLE_LOG;
}

namespace {

constexpr double kMostSessions = 8000;  // Each is a file descriptor; the units allow 8192.

bool IsOrdinary(v1::Role role) { return role < v1::ROLE_CONTROL; }

/// Number of `places` that sessions without the role control leave free.
std::int64_t KeptForControl(const SessionLimits& limits, std::int64_t places) {
  return std::min(limits.control_places, places / 4);
}

/// Most places with the role control of one host or certificate: the others have the rest.
std::int64_t MostControlOfOne(const SessionLimits& limits) {
  return (limits.max_control_sessions + 1) / 2;
}

std::string Already(std::int64_t count, const std::string& what) {
  return std::to_string(count) + " sessions " + what + " already";
}

}  // namespace

void SessionLimits::Bind(config::Binder& binder) {
  constexpr auto most = static_cast<std::int64_t>(kMostSessions);
  binder.Integer("max_sessions", max_sessions, 1, most, "Sessions at once");
  binder.Integer("max_sessions_per_user", max_sessions_per_user, 1, most,
                 "Sessions of one user at once; all those over TCP count as one user's");
  binder.Integer(
      "max_entering_per_host", max_entering_per_host, 1, most,
      "Connections over TLS of one host that have not shown a token or a certificate yet");
  binder.Integer(
      "max_sessions_per_host", max_sessions_per_host, 1, most,
      "Sessions over TCP and TLS of one address; those with the role control are counted "
      "apart, up to half of max_control_sessions");
  binder.Integer("max_sessions_per_certificate", max_sessions_per_certificate, 1, most,
                 "Sessions of one client certificate; those with the role control likewise");
  binder.Integer(
      "control_places", control_places, 0, most,
      "Places that sessions with the roles view and log leave free for the role control, "
      "at most a quarter of all and of those over TCP and TLS");
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
  constexpr double kBurstS = 0.25;  // Burst of bytes: the longest message fits in four times.
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

std::int64_t PlacesTaken::with_role(v1::Role role) const {
  const auto found = with_role_.find(role);
  return found == with_role_.end() ? 0 : found->second;
}

std::string PlacesTaken::WhyOneHasTooMany(const std::string& key, std::int64_t most,
                                          const SessionLimits& limits, const Claim& claim,
                                          const std::string& whose) const {
  const auto found = of_.find(key);
  if (key.empty() || found == of_.end()) return "";
  if (IsOrdinary(claim.role)) {
    return found->second.ordinary < most ? "" : Already(most, whose);
  }
  most = std::min(most, MostControlOfOne(limits));
  return found->second.control < most ? "" : Already(most, "with the role control " + whose);
}

std::string PlacesTaken::WhyNotOneMore(const SessionLimits& limits, const Claim& claim) const {
  auto why = WhyOneHasTooMany(claim.certificate, limits.max_sessions_per_certificate, limits, claim,
                              "of this certificate");
  if (!why.empty()) return why;
  why = WhyOneHasTooMany(claim.host, limits.max_sessions_per_host, limits, claim,
                         "from this address");
  if (!why.empty()) return why;
  if (!IsOrdinary(claim.role)) {
    const std::int64_t most = limits.max_control_sessions;
    return with_role(claim.role) < most ? "" : Already(most, "with the role control");
  }
  const std::int64_t logs = limits.max_log_sessions;
  if (claim.role == v1::ROLE_LOG && with_role(claim.role) >= logs) {
    return Already(logs, "with the role log");
  }
  const std::int64_t free_for_all =
      limits.max_sessions - KeptForControl(limits, limits.max_sessions);
  if (with_role(v1::ROLE_VIEW) + with_role(v1::ROLE_LOG) >= free_for_all) {
    return Already(free_for_all, "with the roles view and log");
  }
  const std::int64_t remote = std::min(limits.max_sessions_per_user, limits.max_sessions);
  const std::int64_t free_for_remote = remote - KeptForControl(limits, remote);
  if (claim.remote && ordinary_remote_ >= free_for_remote) {
    return Already(free_for_remote, "with the roles view and log over TCP");
  }
  return "";
}

void PlacesTaken::Count(const Claim& claim, std::int64_t one) {
  const bool ordinary = IsOrdinary(claim.role);
  if ((with_role_[claim.role] += one) == 0) with_role_.erase(claim.role);
  if (ordinary && claim.remote) ordinary_remote_ += one;
  for (const std::string& key : {claim.host, claim.certificate}) {
    if (key.empty()) continue;
    Sessions& sessions = of_[key];
    (ordinary ? sessions.ordinary : sessions.control) += one;
    if (sessions.ordinary == 0 && sessions.control == 0) of_.erase(key);
  }
}

}  // namespace footing::transport

#include "common/net/peer.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

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

}  // namespace footing::transport

#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "footing/v1/session.pb.h"

/// Who is at the other end, and what it may do.
namespace footing::transport {

struct Peer {
  bool known = false;  ///< False over TCP: nothing is known about it but its host.
  uid_t user = 0;
  std::vector<gid_t> groups;  ///< The main one and the supplementary ones.
  std::string host = {};      ///< Over TCP: the other side's numeric address.
};

/// Asks the kernel about the other end of a connected socket: of a Unix socket who it is
/// (SO_PEERCRED, SO_PEERGROUPS), over TCP where.
Peer PeerOf(int socket);

/// The highest role it may have: on the Unix socket the server's own user (and root) may be admin,
/// a member of its group control, others view and log; over loopback TCP view and log.
v1::Role HighestRole(const Peer& peer, uid_t own_user, gid_t own_group);

}  // namespace footing::transport

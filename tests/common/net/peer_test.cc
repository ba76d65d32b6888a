#include "common/net/limits.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace footing::transport {
namespace {

constexpr uid_t kServerUser = 990;
constexpr gid_t kServerGroup = 991;

Peer Someone(uid_t user, std::vector<gid_t> groups) { return {true, user, std::move(groups)}; }

TEST(Peer, TheServersUserAndRootMayBeAdmin) {
  EXPECT_EQ(HighestRole(Someone(kServerUser, {5}), kServerUser, kServerGroup), v1::ROLE_ADMIN);
  EXPECT_EQ(HighestRole(Someone(0, {0}), kServerUser, kServerGroup), v1::ROLE_ADMIN);
}

TEST(Peer, AMemberOfTheGroupMayControl) {
  EXPECT_EQ(HighestRole(Someone(1000, {1000, kServerGroup}), kServerUser, kServerGroup),
            v1::ROLE_CONTROL);
}

TEST(Peer, OthersAndTcpMayLookAndLog) {
  EXPECT_EQ(HighestRole(Someone(1000, {1000}), kServerUser, kServerGroup), v1::ROLE_LOG);
  EXPECT_EQ(HighestRole(Peer(), kServerUser, kServerGroup), v1::ROLE_LOG);
}

TEST(Peer, TheKernelNamesTheOtherEndOfAUnixSocketOnly) {
  int pair[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
  const Peer peer = PeerOf(pair[0]);
  EXPECT_TRUE(peer.known);
  EXPECT_EQ(peer.user, geteuid());
  ASSERT_FALSE(peer.groups.empty());
  EXPECT_EQ(peer.groups[0], getegid());
  close(pair[0]);
  close(pair[1]);
  const int tcp = socket(AF_INET, SOCK_STREAM, 0);
  EXPECT_FALSE(PeerOf(tcp).known);
  EXPECT_EQ(PeerOf(tcp).host, "") << "it is not connected";
  close(tcp);
}

}  // namespace
}  // namespace footing::transport

#include "common/net/address.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "common/net/socket.h"
#include "common/net/udp.h"
#include "tests/common/temporary_folder.h"

namespace footing::transport {
namespace {

TEST(Address, UnixAndTcpAreReadAndWrittenBack) {
  for (const std::string text : {"unix:/run/footing/sensor.sock", "tcp:127.0.0.1:7450",
                                 "tcp:localhost:0", "tcp:[::1]:65535"}) {
    const auto address = ParseAddress(text);
    ASSERT_TRUE(address.ok()) << text;
    EXPECT_EQ(address->Text(), text);
  }
}

TEST(Address, WhatIsNoAddressIsAUsageErrorThatShowsTheRightForm) {
  for (const std::string text : {"", "unix:", "tcp:127.0.0.1", "tcp::5", "tcp:h:", "tcp:h:65536",
                                 "tcp:h:1x", "/run/x", "http://x", "tcp:h:-1"}) {
    const auto address = ParseAddress(text);
    ASSERT_FALSE(address.ok()) << text;
    EXPECT_EQ(address.error().kind, ErrorKind::kUsage);
    EXPECT_NE(address.error().message.find("unix:PATH"), std::string::npos);
  }
}

TEST(ParseUdp, TakesHostsAndPorts) {
  EXPECT_EQ(ParseUdp("127.0.0.1:7110", "--listen")->port(), 7110);
  EXPECT_TRUE(ParseUdp("localhost:0", "--listen")->address().is_loopback());
  EXPECT_TRUE(ParseUdp("[::1]:7110", "--listen")->address().is_v6());
  EXPECT_TRUE(ParseUdp("[::]:6969", "--listen")->address().is_unspecified());
  for (const char* const wrong : {"", "7110", "host:7110", "127.0.0.1:", "127.0.0.1:70000", "::1",
                                  "::1:7110", "[127.0.0.1]:7110", "[]:7110", "127.0.0.1:-1"}) {
    const auto parsed = ParseUdp(wrong, "--listen");
    ASSERT_FALSE(parsed) << wrong;
    EXPECT_EQ(parsed.error().kind, ErrorKind::kUsage);
    EXPECT_EQ(parsed.error().message.rfind(std::string("--listen ") + wrong, 0), 0u);
  }
}

TEST(Address, APathLongerThanTheKernelTakesIsRefused) {
  // sockaddr_un holds 108 bytes, the last one is the terminating zero.
  EXPECT_TRUE(ParseAddress("unix:" + std::string(107, 'x')).ok());
  EXPECT_FALSE(ParseAddress("unix:" + std::string(108, 'x')).ok());
}

TEST(Address, OnlyLoopbackStaysOnThisHost) {
  EXPECT_TRUE(StaysOnThisHost(*ParseAddress("unix:/x")));
  EXPECT_TRUE(StaysOnThisHost(*ParseAddress("tcp:127.0.0.1:1")));
  EXPECT_TRUE(StaysOnThisHost(*ParseAddress("tcp:127.9.9.9:1")));
  EXPECT_TRUE(StaysOnThisHost(*ParseAddress("tcp:[::1]:1")));
  EXPECT_TRUE(StaysOnThisHost(*ParseAddress("tcp:localhost:1")));
  EXPECT_FALSE(StaysOnThisHost(*ParseAddress("tcp:0.0.0.0:1")));
  EXPECT_FALSE(StaysOnThisHost(*ParseAddress("tcp:[::]:1")));
  EXPECT_FALSE(StaysOnThisHost(*ParseAddress("tcp:192.168.1.5:1")));
  EXPECT_FALSE(StaysOnThisHost(*ParseAddress("tcp:example.org:1")));
}

TEST(Address, TheDefaultNamesTheServer) {
  const Address address = DefaultAddress("sensor");
  EXPECT_EQ(address.kind, Address::Kind::kUnix);
  EXPECT_NE(address.path.find("/sensor.sock"), std::string::npos);
}

TEST(Address, WhoMayNotOpenTheSocketJoinsItsGroupInPlaceOfStartingAServer) {
  const std::string start = "start footing-sim";
  EXPECT_EQ(RemedyFor("tcp:127.0.0.1:7710: connection refused", start), "; start footing-sim");
  EXPECT_EQ(RemedyFor("tcp:127.0.0.1:7710: connection refused", ""), "");
  const std::string denied = "unix:/run/footing/simulation.sock: permission denied";
  const std::string remedy = RemedyFor(denied, start);
  EXPECT_NE(remedy.find("; join the group"), std::string::npos) << remedy;
  EXPECT_NE(remedy.find("usermod -aG footing"), std::string::npos) << remedy;
  EXPECT_NE(remedy.find("log in again (docs/setup.md)"), std::string::npos) << remedy;
  EXPECT_EQ(remedy.find("start"), std::string::npos) << remedy;
  EXPECT_EQ(RemedyFor(denied + remedy, start), "") << "once is enough";
}

TEST(RunFolder, OnlyAFolderOfTheOwnUserAloneIsTrusted) {
  const test::TemporaryFolder folder;
  const std::string own = folder.Path("own"), link = folder.Path("link"),
                    file = folder.Path("file");
  EXPECT_TRUE(CheckRunFolder(own, geteuid()).ok()) << "it can be made";
  ASSERT_EQ(mkdir(own.c_str(), 0700), 0);
  EXPECT_TRUE(CheckRunFolder(own, geteuid()).ok());
  const auto others = CheckRunFolder(own, geteuid() + 1);
  ASSERT_FALSE(others.ok());
  EXPECT_NE(others.error().message.find("belongs to user"), std::string::npos);
  ASSERT_EQ(symlink(own.c_str(), link.c_str()), 0);
  EXPECT_FALSE(CheckRunFolder(link, geteuid()).ok());
  ASSERT_EQ(chmod(own.c_str(), 0770), 0);
  EXPECT_FALSE(CheckRunFolder(own, geteuid()).ok());
  ASSERT_EQ(close(creat(file.c_str(), 0600)), 0);
  EXPECT_FALSE(CheckRunFolder(file, geteuid()).ok());
}

}  // namespace
}  // namespace footing::transport

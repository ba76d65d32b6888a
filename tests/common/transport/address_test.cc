#include "common/transport/address.h"

#include <gtest/gtest.h>

#include "common/transport/socket.h"

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

}  // namespace
}  // namespace footing::transport

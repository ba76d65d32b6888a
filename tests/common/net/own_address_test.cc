#include "common/net/own_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::transport {
namespace {

TEST(OwnAddress, OnlyTheAddressesThatListenEverywhereAreEveryAddress) {
  EXPECT_TRUE(IsEveryAddress("0.0.0.0"));
  EXPECT_TRUE(IsEveryAddress("::"));
  for (const char* const host : {"127.0.0.1", "192.168.1.5", "::1", "lab.example", ""}) {
    EXPECT_FALSE(IsEveryAddress(host)) << host;
  }
}

TEST(OwnAddress, IsOneOfThisHostAndNotLoopback) {
  const auto all = OwnAddresses();
  EXPECT_THAT(all, testing::Contains("127.0.0.1"));
  const std::string address = AddressForOthers();
  if (address.empty()) {  // This host is in no network.
    EXPECT_THAT(all, testing::Each(testing::StartsWith("127.")));
    return;
  }
  EXPECT_THAT(all, testing::Contains(address));
  EXPECT_NE(address.substr(0, 4), "127.");
}

}  // namespace
}  // namespace footing::transport

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "clients/relay/login.h"
#include "tests/common/temporary_folder.h"

namespace footing::relay {
namespace {

TEST(BrokerAddress, IsOnThisHostOrRefused) {
  EXPECT_EQ(ParseBrokerAddress("tcp:127.0.0.1:4222", "x")->Text(), "tcp:127.0.0.1:4222");
  EXPECT_EQ(ParseBrokerAddress("localhost:1883", "x")->port, 1883);
  const auto away = ParseBrokerAddress("tcp:192.168.1.5:4222", "use a leaf node");
  ASSERT_FALSE(away.ok());
  EXPECT_NE(away.error().message.find("use a leaf node"), std::string::npos);
  EXPECT_EQ(away.error().kind, ErrorKind::kUsage);
  for (const char* const text :
       {"unix:/tmp/x", "tls:127.0.0.1:1", "tcp:broker.example:4222", "4222", ""}) {
    EXPECT_FALSE(ParseBrokerAddress(text, "x").ok()) << text;
  }
}

class LoginFile : public testing::Test {
 protected:
  std::string Write(const std::string& text, mode_t mode = 0600) {
    const std::string path = folder_.Path("login");
    std::ofstream(path) << text;
    chmod(path.c_str(), mode);
    return path;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LoginFile, HasATokenOrAUserAndAPassword) {
  EXPECT_EQ(ReadLoginFile(Write("a-token\n"))->token, "a-token");
  const auto both = ReadLoginFile(Write("anna\npass word\n"));
  EXPECT_EQ(both->user, "anna");
  EXPECT_EQ(both->password, "pass word");
  EXPECT_TRUE(both->token.empty());
  EXPECT_TRUE(ReadLoginFile("")->token.empty());
}

TEST_F(LoginFile, IsRefusedWhenOthersMayReadItOrItIsEmpty) {
  EXPECT_EQ(ReadLoginFile(Write("a-token\n", 0640)).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(ReadLoginFile(Write("")).error().kind, ErrorKind::kInvalidData);
  EXPECT_FALSE(ReadLoginFile("/nowhere/login").ok());
}

}  // namespace
}  // namespace footing::relay

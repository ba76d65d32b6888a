#include "common/transport/token.h"

#include <sys/stat.h>

#include <fstream>

#include "common/transport/client_messages.h"
#include "tests/common/temporary_folder.h"
#include "tests/common/transport/server_fixture.h"

namespace footing::transport {
namespace {

constexpr char kToken[] = "0123456789abcdef";

TEST(Token, OnlyAFileOfItsOwnerAloneWithALongLineIsTaken) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("token");
  EXPECT_FALSE(ReadTokenFile(path).ok());
  std::ofstream(path) << kToken << "\n";
  ASSERT_EQ(chmod(path.c_str(), 0640), 0);
  EXPECT_FALSE(ReadTokenFile(path).ok()) << "others may read it";
  ASSERT_EQ(chmod(path.c_str(), 0600), 0);
  const auto token = ReadTokenFile(path);
  ASSERT_TRUE(token.ok());
  EXPECT_EQ(*token, kToken);
  std::ofstream(path) << "short\n";
  const auto brief = ReadTokenFile(path);
  ASSERT_FALSE(brief.ok());
  EXPECT_EQ(brief.error().message.find("short"), std::string::npos) << "never shown";
}

TEST(Token, AFolderOrAPipeIsRefusedAtOnceAndNamed) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder.Path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto of_folder = ReadTokenFile(folder.Path(".")), of_pipe = ReadTokenFile(pipe);
  ASSERT_FALSE(of_folder.ok());
  EXPECT_NE(of_folder.error().message.find("it is a folder, not"), std::string::npos);
  ASSERT_FALSE(of_pipe.ok());
  EXPECT_NE(of_pipe.error().message.find("it is a pipe, not"), std::string::npos);
}

TEST(Token, SecretsAreEqualOrNot) {
  EXPECT_TRUE(IsSameSecret("abc", "abc"));
  EXPECT_FALSE(IsSameSecret("abc", "abd"));
  EXPECT_FALSE(IsSameSecret("abcabc", "abc"));
  EXPECT_FALSE(IsSameSecret("", "abc"));
  EXPECT_FALSE(IsSameSecret("abc", ""));
}

TEST(Token, GuessingIsSlowedEvenWhenTheGuessIsRight) {
  TokenGuard guard(kToken);
  std::int64_t now_ns = 1'000'000'000;
  EXPECT_TRUE(guard.Accepts(kToken, "10.0.0.1", now_ns));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(guard.Accepts("wrong", "10.0.0.1", now_ns));
  EXPECT_FALSE(guard.Accepts(kToken, "10.0.0.1", now_ns));
  now_ns += 5'100'000'000;
  EXPECT_TRUE(guard.Accepts(kToken, "10.0.0.1", now_ns));
  EXPECT_FALSE(TokenGuard().Accepts("", "10.0.0.1", now_ns)) << "without a token none is right";
}

TEST(Token, GuessingKeepsNobodyElseOut) {
  TokenGuard guard(kToken);
  const std::int64_t now_ns = 1'000'000'000;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(guard.Accepts("wrong", "10.0.0.1", now_ns));
  EXPECT_TRUE(guard.Accepts(kToken, "10.0.0.2", now_ns));
}

TEST(Token, AThousandHostsThatGuessAreSlowedTogether) {
  TokenGuard guard(kToken);
  std::int64_t now_ns = 1'000'000'000;
  for (int host = 0; host < 1000; ++host) {
    for (int i = 0; i < 5; ++i) {
      EXPECT_FALSE(guard.Accepts("wrong", "10.0.0." + std::to_string(host), now_ns));
    }
  }
  EXPECT_FALSE(guard.Accepts(kToken, "10.0.1.1", now_ns)) << "nobody new: all places are guessers'";
  now_ns += 26'000'000'000;  // 5 tries at 0.2 a second, and those of the shared one.
  EXPECT_TRUE(guard.Accepts(kToken, "10.0.1.1", now_ns));
}

TEST(Token, AClientPresentsTheEnvironmentsTokenOverTcpOnly) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("token");
  std::ofstream(path) << kToken << "\n";
  ASSERT_EQ(chmod(path.c_str(), 0600), 0);
  ASSERT_EQ(setenv("FOOTING_TOKEN_FILE", path.c_str(), 1), 0);
  ClientOptions options;
  EXPECT_EQ(MakeHello(options)->hello().token(), "")
      << "on a Unix socket the kernel says who it is";
  options.address = *ParseAddress("tcp:127.0.0.1:7450");
  EXPECT_EQ(MakeHello(options)->hello().token(), kToken);
  unsetenv("FOOTING_TOKEN_FILE");
  EXPECT_EQ(MakeHello(options)->hello().token(), "");
}

TEST(Token, AFileThatCannotBeUsedIsNamedNotPassedOver) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Path("token");
  ASSERT_EQ(setenv("FOOTING_TOKEN_FILE", path.c_str(), 1), 0);
  ClientOptions options;
  options.address.kind = Address::Kind::kTls;
  const auto missing = MakeHello(options);
  std::ofstream(path) << kToken << "\n";
  ASSERT_EQ(chmod(path.c_str(), 0644), 0);
  const auto open_to_all = MakeHello(options);
  options.token = kToken;  // Then the environment is not asked.
  EXPECT_TRUE(MakeHello(options).ok());
  unsetenv("FOOTING_TOKEN_FILE");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().message,
            "FOOTING_TOKEN_FILE: token file " + path +
                ": No such file or directory; make one on the server (openssl rand -hex 16 > FILE; "
                "chmod 600 FILE), and copy it to clients on other machines");
  ASSERT_FALSE(open_to_all.ok());
  EXPECT_NE(open_to_all.error().message.find("may be read by others"), std::string::npos);
}

class TokenTest : public ServerFixture {
 protected:
  std::unique_ptr<TestClient> SayHello(const std::string& token, v1::Role role) {
    auto client = Connect(1);  // Over TCP.
    client->Read();
    v1::Envelope hello = Hello(role);
    hello.mutable_hello()->set_token(token);
    client->Send(hello);
    EXPECT_TRUE(RunUntil([&] { return !client->messages.empty(); }));
    return client;
  }
};

TEST_F(TokenTest, OverTcpOnlyTheTokenGivesControl) {
  ServerOptions options = Options();
  options.token = kToken;
  StartServer(options);
  const auto without = SayHello("", v1::ROLE_CONTROL);
  EXPECT_EQ(without->messages[0].refused().reason(), v1::Refused::REASON_ROLE);
  const auto wrong = SayHello("0123456789abcdeX", v1::ROLE_VIEW);
  EXPECT_EQ(wrong->messages[0].refused().reason(), v1::Refused::REASON_TOKEN);
  const auto right = SayHello(kToken, v1::ROLE_CONTROL);
  EXPECT_EQ(right->messages[0].welcome().granted_role(), v1::ROLE_CONTROL);
  const auto admin = SayHello(kToken, v1::ROLE_ADMIN);
  EXPECT_EQ(admin->messages[0].refused().reason(), v1::Refused::REASON_ROLE);
}

TEST_F(TokenTest, AClientWithAnUnusableTokenFileSaysSoAndComesOnceItIsMended) {
  StartServer();
  const std::string path = folder_ + "/token";
  ASSERT_EQ(setenv("FOOTING_TOKEN_FILE", path.c_str(), 1), 0);
  ClientOptions options;
  options.address = server_->ListeningOn(1);
  options.refused_wait_s = 0.01;
  std::string why;
  LinkState state = LinkState::kConnecting;
  ClientHandlers handlers;
  handlers.on_state = [&](LinkState now, const std::string& text) { state = now, why = text; };
  Client client(io_, options, handlers);
  client.Start();
  EXPECT_TRUE(RunUntil([&] { return state == LinkState::kRefused; }));
  EXPECT_NE(why.find(path), std::string::npos) << why;
  EXPECT_EQ(server_->statistics().refused, 0u);
  unsetenv("FOOTING_TOKEN_FILE");
  EXPECT_TRUE(RunUntil([&] { return state == LinkState::kLive; }));
}

TEST_F(TokenTest, BeyondThisHostItListensOnlyWhenThatIsAllowedAndNobodyComesWithoutTheToken) {
  Address everywhere;
  everywhere.kind = Address::Kind::kTcp;
  everywhere.host = "0.0.0.0";
  for (const bool allowed : {false, true}) {
    for (const std::string token : {"", kToken}) {
      ServerOptions options = Options();
      options.insecure_lan = allowed;
      options.token = token;
      options.identity_file = "identity.pem";
      Server server(io_, options, {});
      const auto listening = server.Listen(everywhere);
      EXPECT_EQ(listening.ok(), allowed && !token.empty());
      if (listening) continue;
      EXPECT_NE(listening.error().message.find("--set insecure_lan=true"), std::string::npos);
    }
  }
  ServerOptions options = Options();
  options.insecure_lan = true;
  options.token = kToken;
  StartServer(options);
  const auto without = SayHello("", v1::ROLE_VIEW);
  EXPECT_EQ(without->messages[0].refused().reason(), v1::Refused::REASON_TOKEN);
  const auto with = SayHello(kToken, v1::ROLE_VIEW);
  EXPECT_TRUE(with->messages[0].has_welcome());
}

}  // namespace
}  // namespace footing::transport

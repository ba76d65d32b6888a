#include <fstream>

#include <sys/stat.h>
#include <unistd.h>

#include "common/net/access.h"
#include "common/net/client.h"
#include "common/net/tls_context.h"
#include "tests/common/net/server_fixture.h"
#include "tests/common/temporary_folder.h"

namespace footing::transport {
namespace {

TEST(Access, ClientsAreLinesOfFingerprintAndRole) {
  const std::string one = tls::FingerprintOf("one"), two = tls::FingerprintOf("two");
  const auto clients =
      ParseClients("# the lab\n" + one + " view wall screen\n\n" + two + " control\n");
  ASSERT_TRUE(clients.ok()) << clients.error().message;
  EXPECT_EQ(*clients,
            (std::map<std::string, v1::Role>{{one, v1::ROLE_VIEW}, {two, v1::ROLE_CONTROL}}));
}

TEST(Access, AWrongLineIsNamedAndNobodyIsLetIn) {
  const std::string one = tls::FingerprintOf("one");
  for (const std::string& line : {one + " admin Ada", one, std::string("sha256:12 view Ada")}) {
    const auto refused = ParseClients("# the lab\n" + line + "\n");
    ASSERT_FALSE(refused.ok()) << line;
    EXPECT_NE(refused.error().message.find("line 2"), std::string::npos);
  }
}

TEST(Access, TheFilesOfTheSettingsComeIntoTheOptions) {
  const test::TemporaryFolder folder;
  AccessSettings settings;
  settings.token_file = folder.Path("token");
  settings.clients_file = folder.Path("clients");
  settings.identity_file = folder.Path("identity.pem");
  std::ofstream(settings.token_file) << "0123456789abcdef\n";
  ASSERT_EQ(chmod(settings.token_file.c_str(), 0600), 0);
  std::ofstream(settings.clients_file) << tls::FingerprintOf("one") << " log Ada\n";
  ServerOptions options;
  const auto applied = settings.Apply(options);
  ASSERT_TRUE(applied.ok()) << applied.error().message;
  EXPECT_EQ(options.token, "0123456789abcdef");
  EXPECT_EQ(options.clients.at(tls::FingerprintOf("one")), v1::ROLE_LOG);
  EXPECT_EQ(options.identity_file, folder.Path("identity.pem"));
  std::ofstream(settings.clients_file) << "Ada\n";
  const auto refused = settings.Apply(options);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find(settings.clients_file + ", line 1"), std::string::npos);
}

TEST(Access, TheViewTokenIsAnotherOneThanTheToken) {
  const test::TemporaryFolder folder;
  AccessSettings settings;
  settings.token_file = folder.Path("token");
  settings.view_token_file = folder.Path("view");
  for (const std::string& file : {settings.token_file, settings.view_token_file}) {
    std::ofstream(file) << "0123456789abcdef\n";
    ASSERT_EQ(chmod(file.c_str(), 0600), 0);
  }
  ServerOptions options;
  const auto same = settings.Apply(options);
  ASSERT_FALSE(same.ok());
  EXPECT_NE(same.error().message.find("have the same token"), std::string::npos);
  std::ofstream(settings.view_token_file) << "fedcba9876543210\n";
  ASSERT_TRUE(settings.Apply(options).ok());
  EXPECT_EQ(options.view_token, "fedcba9876543210");
  settings.token_file.clear();
  settings.insecure_lan = true;
  EXPECT_TRUE(settings.Check().ok());
  EXPECT_TRUE(settings.CheckStart({"tcp:0.0.0.0:7700"}).ok());
}

TEST(Access, AClientsFileThatOthersMayWriteIsRefused) {
  const test::TemporaryFolder folder;
  AccessSettings settings;
  settings.clients_file = folder.Path("clients");
  std::ofstream(settings.clients_file) << tls::FingerprintOf("one") << " log\n";
  for (const auto& [mode, taken] :
       {std::pair<mode_t, bool>{0664, false}, {0646, false}, {0644, true}}) {
    ASSERT_EQ(chmod(settings.clients_file.c_str(), mode), 0);
    ServerOptions options;
    EXPECT_EQ(settings.Apply(options).ok(), taken) << mode;
  }
}

TEST(Access, AClientsFileOrAnIdentityThatIsAPipeIsRefusedAtOnce) {
  const test::TemporaryFolder folder;
  AccessSettings settings;
  settings.clients_file = folder.Path("pipe");
  ASSERT_EQ(mkfifo(settings.clients_file.c_str(), 0600), 0);
  ServerOptions options;
  const auto refused = settings.Apply(options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message,
            "clients file " + settings.clients_file + ": it is a pipe, not a regular file");
  const auto identity = tls::Identity::LoadOrMake(settings.clients_file, "test");
  ASSERT_FALSE(identity.ok());
  EXPECT_NE(identity.error().message.find("it is a pipe"), std::string::npos);
}

TEST(Access, WhatTheStartNeedsIsCheckedWithoutASocket) {
  const test::TemporaryFolder folder;
  AccessSettings settings;
  settings.identity_file = folder.Path("identity.pem");
  const auto why = [&](const std::string& address) {
    const auto checked = settings.CheckStart({address});
    return checked ? std::string() : checked.error().message;
  };
  EXPECT_NE(why("nonsense"), "");
  EXPECT_NE(why("tcp:0.0.0.0:7700").find("must be encrypted"), std::string::npos);
  EXPECT_NE(why("tls:0.0.0.0:7700").find("set token_file or clients_file"), std::string::npos);
  settings.token_file = folder.Path("token");
  EXPECT_NE(why("unix:" + folder.Path("socket")).find("token file"), std::string::npos);
  std::ofstream(settings.token_file) << "0123456789abcdef\n";
  ASSERT_EQ(chmod(settings.token_file.c_str(), 0600), 0);
  EXPECT_EQ(why("tls:0.0.0.0:7700"), "");
  EXPECT_NE(access(settings.identity_file.c_str(), F_OK), 0) << "the start makes it";
  std::ofstream(settings.identity_file) << "nonsense";
  ASSERT_EQ(chmod(settings.identity_file.c_str(), 0600), 0);
  EXPECT_NE(why("tls:0.0.0.0:7700").find("identity"), std::string::npos);
}

TEST(Access, WithoutEncryptionThereMustBeAToken) {
  AccessSettings settings;
  settings.insecure_lan = true;
  EXPECT_FALSE(settings.Check().ok());
  settings.token_file = "/etc/footing/token";
  EXPECT_TRUE(settings.Check().ok());
}

constexpr char kToken[] = "0123456789abcdef";
constexpr char kViewToken[] = "view-0123456789abcdef";

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

TEST(Token, WrongOnesWaitForTheirAnswerAndTheRightOneDoesNot) {
  TokenGuard guard(kToken, kViewToken);
  const std::string host = "10.0.0.1";
  std::int64_t now_ns = 1'000'000'000;
  EXPECT_EQ(guard.Check(kToken, host, now_ns).role, v1::ROLE_CONTROL);
  const auto waiting = [&](int guesses) {
    int count = 0;
    for (int i = 0; i < guesses; ++i) {
      const auto verdict = guard.Check("wrong", host, now_ns);
      EXPECT_EQ(verdict.role, v1::ROLE_UNSPECIFIED);
      count += verdict.waits ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(waiting(25), 20) << "five typing errors are answered at once";
  EXPECT_EQ(guard.Check(kToken, host, now_ns).role, v1::ROLE_CONTROL);
  EXPECT_EQ(guard.Check(kViewToken, host, now_ns).role, v1::ROLE_VIEW);
  now_ns += 5'100'000'000;
  EXPECT_EQ(waiting(3), 2) << "one more in 5 s";
  EXPECT_FALSE(guard.Check("wrong", "10.0.0.2", now_ns).waits) << "another host";
}

TEST(Token, WithoutATokenNoneIsRight) {
  for (const std::string_view presented : {"", "wrong"}) {
    EXPECT_EQ(TokenGuard().Check(presented, "10.0.0.1", 1).role, v1::ROLE_UNSPECIFIED);
    EXPECT_EQ(TokenGuard(kToken).Check(presented, "10.0.0.1", 1).role, v1::ROLE_UNSPECIFIED);
  }
}

TEST(Token, AThousandHostsThatGuessWaitTogether) {
  TokenGuard guard(kToken);
  std::int64_t now_ns = 1'000'000'000;
  for (int host = 0; host < 1000; ++host) {
    for (int i = 0; i < 5; ++i) guard.Check("wrong", "10.0.0." + std::to_string(host), now_ns);
  }
  EXPECT_TRUE(guard.Check("wrong", "10.0.1.1", now_ns).waits) << "all places are guessers'";
  EXPECT_EQ(guard.Check(kToken, "10.0.1.1", now_ns).role, v1::ROLE_CONTROL);
  now_ns += 26'000'000'000;  // 5 tries at 0.2 a second, and those of the shared one.
  EXPECT_FALSE(guard.Check("wrong", "10.0.1.1", now_ns).waits);
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

TEST_F(TokenTest, TheViewTokenLetsLookAndNoMore) {
  ServerOptions options = Options();
  options.token = kToken;
  options.view_token = kViewToken;
  options.insecure_lan = true;
  StartServer(options);
  const auto viewer = SayHello(kViewToken, v1::ROLE_VIEW);
  EXPECT_EQ(viewer->messages[0].welcome().granted_role(), v1::ROLE_VIEW);
  const auto control = SayHello(kViewToken, v1::ROLE_CONTROL);
  EXPECT_EQ(control->messages[0].refused().reason(), v1::Refused::REASON_ROLE);
  EXPECT_NE(control->messages[0].refused().message().find("view_token_file"), std::string::npos);
}

TEST_F(TokenTest, GuessesHoldNoPlaceThatTheRightTokenNeeds) {
  ServerOptions options = Options();
  options.token = kToken;
  options.sessions.max_sessions = options.sessions.max_sessions_per_user = 3;
  options.wrong_token_wait_s = 600;  // In place of 2 s: only who needs the place ends the wait.
  StartServer(options);
  for (int i = 0; i < 5; ++i) SayHello("wrong", v1::ROLE_VIEW);
  std::vector<std::unique_ptr<TestClient>> guesses;
  const auto guess = [&] {
    guesses.push_back(Connect(1));
    guesses.back()->Read();
    v1::Envelope hello = Hello();
    hello.mutable_hello()->set_token("wrong");
    guesses.back()->Send(hello);
    const std::uint64_t before = server_->statistics().denied;
    EXPECT_TRUE(RunUntil([&] { return server_->statistics().denied > before; }));
  };
  for (int i = 0; i < 3; ++i) guess();
  for (const auto& one : guesses) EXPECT_TRUE(one->messages.empty()) << "no answer yet";
  guesses[2]->Send(Subscribe());  // Ignored: the answer is still to come.
  const auto right = SayHello(kToken, v1::ROLE_CONTROL);
  EXPECT_TRUE(right->messages[0].has_welcome());
  ASSERT_TRUE(RunUntil([&] { return !guesses[0]->messages.empty(); }));
  EXPECT_EQ(guesses[0]->messages[0].refused().reason(), v1::Refused::REASON_TOKEN);
  EXPECT_TRUE(guesses[1]->messages.empty() && guesses[2]->messages.empty());
}

TEST_F(TokenTest, AGuessIsAnsweredAfterItsWait) {
  ServerOptions options = Options();
  options.token = kToken;
  options.wrong_token_wait_s = 0.05;
  StartServer(options);
  std::vector<std::string> answers;
  for (int i = 0; i < 7; ++i) {
    const auto wrong = SayHello("wrong", v1::ROLE_VIEW);
    ASSERT_FALSE(wrong->messages.empty());
    EXPECT_EQ(wrong->messages[0].refused().reason(), v1::Refused::REASON_TOKEN);
    answers.push_back(wrong->messages[0].refused().message());
  }
  EXPECT_EQ(answers, std::vector<std::string>(7, answers[0]));
  EXPECT_EQ(server_->statistics().refused, 7u);
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

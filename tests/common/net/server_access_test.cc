#include <sys/stat.h>

#include <fstream>

#include "common/net/fingerprint.h"
#include "common/net/access.h"
#include "common/net/client_messages.h"
#include "tests/common/net/tls_fixture.h"

/// Who comes in, and what a client gives away before it knows to whom.
namespace footing::transport {
namespace {

class ServerAccess : public TlsFixture {
 protected:
  ~ServerAccess() override {
    unsetenv("FOOTING_TOKEN_FILE");
    unsetenv("FOOTING_INSECURE_LAN");
  }

  /// The user's own certificate, which a client shows.
  tls::Identity OwnCertificate() const {
    return tls::Identity::LoadOrMake(config_.Path("client.pem"), "viewer").value();
  }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(config_.Path(name)) << text;
    ASSERT_EQ(chmod(config_.Path(name).c_str(), 0600), 0);
  }

  std::optional<v1::Role> RoleOf(v1::Role role, const std::string& token) {
    ClientOptions options;
    options.address = TlsAddress(Port());
    options.role = role;
    options.token = token;
    std::optional<v1::Role> granted;
    bool refused = false;
    ClientHandlers handlers;
    handlers.on_welcome = [&](const v1::Welcome& welcome) { granted = welcome.granted_role(); };
    handlers.on_refused = [&](const v1::Refused&) { refused = true; };
    Client client(io_, options, handlers);
    client.Start();
    EXPECT_TRUE(RunUntil([&] { return granted || refused; }));
    return granted;
  }
};

TEST_F(ServerAccess, ACertificateThatCannotBeRememberedIsRefusedBeforeHello) {
  setenv("FOOTING_KNOWN_SERVERS", "/proc/none/known_servers", 1);
  StartTlsServer();
  StartClient(TlsAddress(Port()));
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_TRUE(WhyHas("cannot be remembered") && WhyHas("/proc/none")) << why_;
  EXPECT_TRUE(WhyHas(server_->fingerprint())) << why_;
  EXPECT_EQ(server_->statistics().denied, 0u) << "nothing was sent";
  EXPECT_TRUE(ticks_.empty());
}

TEST_F(ServerAccess, WhoseCertificateGivesTooLittleHearsWhereThatIsChanged) {
  options_.clients[OwnCertificate().fingerprint()] = v1::ROLE_VIEW;
  StartTlsServer();
  ClientOptions options;
  options.address = TlsAddress(Port());
  options.role = v1::ROLE_CONTROL;
  std::optional<v1::Refused> refused;
  ClientHandlers handlers;
  handlers.on_refused = [&](const v1::Refused& why) { refused = why; };
  Client client(io_, options, handlers);
  client.Start();
  ASSERT_TRUE(RunUntil([&] { return refused.has_value(); }));
  EXPECT_EQ(refused->reason(), v1::Refused::REASON_ROLE);
  EXPECT_NE(refused->message().find("the server's clients_file"), std::string::npos)
      << refused->message();
}

TEST_F(ServerAccess, FilesReadAgainHoldForSessionsThatCome) {
  AccessSettings settings;
  settings.token_file = config_.Path("token");
  settings.clients_file = config_.Path("clients");
  settings.identity_file = config_.Path("identity.pem");
  Write("token", "0123456789abcdef\n");
  Write("clients", "# nobody yet\n");
  ASSERT_TRUE(settings.Apply(options_).ok());
  StartTlsServer();
  EXPECT_EQ(RoleOf(v1::ROLE_CONTROL, "0123456789abcdef"), v1::ROLE_CONTROL);
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{});

  Write("token", "fedcba9876543210\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"token_file"});
  EXPECT_EQ(RoleOf(v1::ROLE_CONTROL, "0123456789abcdef"), std::nullopt);
  EXPECT_EQ(RoleOf(v1::ROLE_CONTROL, "fedcba9876543210"), v1::ROLE_CONTROL);

  Write("clients", OwnCertificate().fingerprint() + " log\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"clients_file"});
  EXPECT_EQ(server_->options().clients.at(OwnCertificate().fingerprint()), v1::ROLE_LOG);

  Write("clients", "Ada\n");
  EXPECT_FALSE(settings.Reapply(*server_).ok());
  EXPECT_EQ(server_->options().clients.size(), 1u) << "an error changes nothing";
}

TEST_F(ServerAccess, ACertificateEnteredLaterComesInWithoutARestart) {
  const tls::Identity own = OwnCertificate();
  StartTlsServer();
  EXPECT_EQ(RoleOf(v1::ROLE_LOG, ""), std::nullopt);
  AccessKeys keys;
  keys.clients[own.fingerprint()] = v1::ROLE_LOG;
  EXPECT_EQ(server_->SetAccess(keys), 0u);
  EXPECT_EQ(RoleOf(v1::ROLE_LOG, ""), v1::ROLE_LOG);
}

TEST_F(ServerAccess, FilesReadAgainEndWhatCameInByWhatIsGone) {
  AccessSettings settings;
  settings.token_file = config_.Path("token");
  settings.view_token_file = config_.Path("view");
  settings.clients_file = config_.Path("clients");
  settings.identity_file = config_.Path("identity.pem");
  Write("token", "0123456789abcdef\n");
  Write("view", "view-0123456789abcdef\n");
  Write("clients", "# nobody yet\n");
  ASSERT_TRUE(settings.Apply(options_).ok());
  StartTlsServer();
  const auto come = [&](std::size_t listener, const std::string& token) {
    auto client = Connect(listener);
    client->Read();
    v1::Envelope hello = Hello();
    hello.mutable_hello()->set_token(token);
    client->Send(hello);
    EXPECT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
    return client;
  };
  const auto local = come(0, ""), by_token = come(kTls, "0123456789abcdef"),
             by_view_token = come(kTls, "view-0123456789abcdef");
  Write("token", "fedcba9876543210\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"token_file"});
  ASSERT_TRUE(WaitFor(*by_token, v1::Envelope::kGoodbye));
  EXPECT_EQ(by_token->Find(v1::Envelope::kGoodbye)->goodbye().reason(),
            "revoked: the token in the server's token_file was replaced; copy the new one to this "
            "client");
  settings.view_token_file.clear();
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"view_token_file"});
  ASSERT_TRUE(WaitFor(*by_view_token, v1::Envelope::kGoodbye));

  // The user's own certificate, which a real client shows.
  Write("clients", OwnCertificate().fingerprint() + " log\n");
  EXPECT_TRUE(settings.Reapply(*server_).ok());
  StartClient(TlsAddress(Port()), "");
  ASSERT_TRUE(RunUntilState(LinkState::kLive)) << why_;
  Write("clients", "# nobody\n");
  EXPECT_EQ(settings.Reapply(*server_).value(), std::vector<std::string>{"clients_file"});
  ASSERT_TRUE(RunUntil([&] { return WhyHas("was removed from the server's clients_file"); }));
  ASSERT_TRUE(RunUntilState(LinkState::kRefused)) << why_;
  EXPECT_EQ(local->Find(v1::Envelope::kGoodbye), nullptr) << "nothing of its was revoked";
}

TEST_F(ServerAccess, EachKindOfMissingProofHasALineOfTheLog) {
  options_.clients["sha256:another"] = v1::ROLE_VIEW;
  StartTlsServer();
  const auto nameless = Connect(kTls);
  nameless->Read();
  nameless->Send(Hello());
  ASSERT_TRUE(WaitFor(*nameless, v1::Envelope::kRefused));
  const std::string own = OwnCertificate().fingerprint();
  EXPECT_EQ(RoleOf(v1::ROLE_VIEW, ""), std::nullopt);
  ASSERT_EQ(overloads_.size(), 2u);
  EXPECT_NE(overloads_[0].find("neither a token nor a certificate"), std::string::npos);
  EXPECT_NE(overloads_[1].find("its certificate is not in the clients_file"), std::string::npos);
  EXPECT_NE(overloads_[1].find(own + " view"), std::string::npos) << overloads_[1];
}

TEST_F(ServerAccess, BeyondThisHostTheTokenIsNotSentInClearUnlessAllowed) {
  ClientOptions options;
  options.token = "0123456789abcdef";
  const auto hello = [&](const std::string& address) {
    options.address = ParseAddress(address).value();
    return MakeHello(options);
  };
  for (const std::string address : {"tls:192.0.2.5:7450", "tcp:127.0.0.1:7450", "unix:/tmp/s"}) {
    EXPECT_EQ(hello(address).value().hello().token(), options.token) << address;
  }
  const auto refused = hello("tcp:192.0.2.5:7450");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("FOOTING_INSECURE_LAN=1"), std::string::npos);
  setenv("FOOTING_INSECURE_LAN", "1", 1);
  EXPECT_EQ(hello("tcp:192.0.2.5:7450").value().hello().token(), options.token);
  unsetenv("FOOTING_INSECURE_LAN");
  options.token.clear();
  EXPECT_TRUE(hello("tcp:192.0.2.5:7450").ok()) << "there is nothing to hide";
}

}  // namespace
}  // namespace footing::transport

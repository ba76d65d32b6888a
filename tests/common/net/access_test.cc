#include "common/net/access.h"

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "common/net/fingerprint.h"
#include "common/net/identity.h"
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

}  // namespace
}  // namespace footing::transport

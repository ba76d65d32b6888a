#include "common/net/known_servers.h"

#include <sys/stat.h>

#include <fstream>

#include "common/net/tls_context.h"
#include "tests/common/temporary_folder.h"

namespace footing::tls {
namespace {

TEST(KnownServers, RemembersOneFingerprintPerServer) {
  const test::TemporaryFolder folder;
  const KnownServers known(folder.Path("config/footing/known_servers"));
  EXPECT_EQ(known.Find("10.0.0.1:7450").value(), std::nullopt);
  const std::string first = FingerprintOf("first"), second = FingerprintOf("second");
  ASSERT_TRUE(known.Add("10.0.0.1:7450", first).ok());
  ASSERT_TRUE(known.Add("[fe80::1]:7450", second).ok());
  EXPECT_EQ(known.Find("10.0.0.1:7450").value(), first);
  EXPECT_EQ(known.Find("[fe80::1]:7450").value(), second);
  EXPECT_EQ(known.Find("10.0.0.1:745").value(), std::nullopt);
  struct stat status {};
  ASSERT_EQ(stat(known.path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  ASSERT_TRUE(known.Add("10.0.0.1:7450", second).ok());
  EXPECT_EQ(known.Find("10.0.0.1:7450").value(), second) << "the last one counts";
}

TEST(KnownServers, ADamagedFileTrustsNobody) {
  const test::TemporaryFolder folder;
  const KnownServers known(folder.Path("known_servers"));
  std::ofstream(known.path()) << "# lab\n\n10.0.0.1:7450 " << FingerprintOf("one") << "\n";
  EXPECT_EQ(known.Find("10.0.0.1:7450").value(), FingerprintOf("one"));
  std::ofstream(known.path(), std::ios::app) << "10.0.0.2:7450 sha256:12\n";
  const auto refused = known.Find("10.0.0.1:7450");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("line 4"), std::string::npos) << refused.error().message;
}

TEST(KnownServers, AFileThatCannotBeReadTrustsNobody) {
  const test::TemporaryFolder folder;
  const KnownServers known(folder.Path(""));  // It can be opened; reading fails.
  EXPECT_FALSE(known.Find("10.0.0.1:7450").ok());
}

TEST(KnownServers, AddsBehindALastLineWithoutItsEnd) {
  const test::TemporaryFolder folder;
  const KnownServers known(folder.Path("known_servers"));
  const std::string one = FingerprintOf("one"), two = FingerprintOf("two");
  std::ofstream(known.path()) << "10.0.0.1:7450 " << one;
  ASSERT_TRUE(known.Add("10.0.0.2:7450", two).ok());
  EXPECT_EQ(known.Find("10.0.0.1:7450").value(), one);
  EXPECT_EQ(known.Find("10.0.0.2:7450").value(), two);
}

}  // namespace
}  // namespace footing::tls

#include "common/net/descriptor_table.h"

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

/// How many descriptors this process's table can hold now.
int TableSize() {
  std::ifstream status("/proc/self/status");
  std::string word;
  int size = 0;
  while (status >> word && word != "FDSize:") {
  }
  status >> size;
  return size;
}

class DescriptorTableTest : public ServerFixture {};

TEST_F(DescriptorTableTest, AServerHasRoomForItsSessionsBeforeTheyCome) {
  // A process begins with a table of 64 or 256; 256 are reserved for what is not a session.
  ServerOptions options = Options();
  options.sessions.max_sessions = 100;
  options.sessions.admin_places = 0;
  StartServer(options);
  EXPECT_GE(TableSize(), 356);

  options.sessions.max_sessions = 800;  // As a reload does.
  server_->SetLimits(options.sessions);
  EXPECT_GE(TableSize(), 800);
}

TEST(DescriptorTable, MoreThanTheLimitOfOpenFilesIsCutToIt) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit lower{std::min<rlim_t>(before.rlim_cur, 900), before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &lower), 0);
  ReserveDescriptors(0);
  ReserveDescriptors(std::size_t{1} << 40);
  EXPECT_GE(static_cast<rlim_t>(TableSize()), lower.rlim_cur);
  EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
}

}  // namespace
}  // namespace footing::transport

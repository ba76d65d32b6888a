#include "common/net/listener.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <thread>
#include <vector>

#include "common/net/address.h"
#include "tests/common/net/io_fixture.h"
#include "tests/common/temporary_folder.h"

namespace footing::transport {
namespace {

class ListenerTest : public IoFixture {
 protected:
  Result<std::unique_ptr<Listener>> Open(const Address& address) {
    return Listener::Open(io_, address,
                          [this](Socket socket) { accepted_.push_back(std::move(socket)); });
  }
  /// Dials and says whether it worked.
  Result<void> DialTo(const Address& address) {
    std::optional<Result<Socket>> dialled;
    Dial(io_, address, [&](Result<Socket> result) { dialled.emplace(std::move(result)); });
    EXPECT_TRUE(RunUntil([&] { return dialled.has_value(); }));
    if (!dialled->ok()) return dialled->error();
    return {};
  }
  /// A socket file with nobody behind it, as after a kill -9.
  void LeaveStaleSocket(const std::string& path) {
    const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
    ASSERT_EQ(bind(descriptor, reinterpret_cast<sockaddr*>(&name), sizeof(name)), 0);
    close(descriptor);
  }
  static bool Exists(const std::string& path) {
    struct stat status {};
    return lstat(path.c_str(), &status) == 0;
  }

  std::vector<Socket> accepted_;
};

TEST_F(ListenerTest, AcceptsOnUnixAndOnTcpWithARealPort) {
  for (const Address& address : {UnixAddress(), TcpAddress()}) {
    const auto listener = Open(address);
    ASSERT_TRUE(listener.ok()) << listener.error().message;
    const Address bound = (*listener)->address();
    if (bound.kind == Address::Kind::kTcp) {
      EXPECT_NE(bound.port, 0);
    }
    accepted_.clear();
    EXPECT_TRUE(DialTo(bound).ok());
    EXPECT_TRUE(RunUntil([&] { return accepted_.size() == 1; }));
  }
}

TEST_F(ListenerTest, TheUnixSocketIsForOwnerAndGroupAndGoesWithTheListener) {
  const Address address = UnixAddress();
  {
    const auto listener = Open(address);
    ASSERT_TRUE(listener.ok());
    struct stat status {};
    ASSERT_EQ(stat(address.path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0660u);
  }
  EXPECT_FALSE(Exists(address.path));
}

TEST_F(ListenerTest, ASocketLeftOverByADeadServerIsReplaced) {
  const Address address = UnixAddress();
  LeaveStaleSocket(address.path);
  const auto listener = Open(address);
  ASSERT_TRUE(listener.ok()) << listener.error().message;
  EXPECT_TRUE(DialTo(address).ok());
}

TEST_F(ListenerTest, ASocketInUseIsRefusedAndLeftAlone) {
  const Address address = UnixAddress();
  const auto first = Open(address);
  ASSERT_TRUE(first.ok());
  const auto second = Open(address);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(address.Text() + " is in use by another server; "),
            std::string::npos)
      << second.error().message;
  EXPECT_TRUE(DialTo(address).ok());
}

TEST_F(ListenerTest, AFileThatIsNoSocketIsNeverRemoved) {
  const Address address = UnixAddress();
  std::ofstream(address.path) << "precious";
  const auto listener = Open(address);
  EXPECT_FALSE(listener.ok());
  EXPECT_TRUE(Exists(address.path));
  unlink(address.path.c_str());
}

TEST_F(ListenerTest, AFileThatReplacedOursSurvivesUs) {
  const Address address = UnixAddress();
  {
    const auto listener = Open(address);
    ASSERT_TRUE(listener.ok());
    unlink(address.path.c_str());
    LeaveStaleSocket(address.path);
  }
  EXPECT_TRUE(Exists(address.path));
  unlink(address.path.c_str());
}

TEST_F(ListenerTest, AMissingFolderIsNamed) {
  const auto listener = Open(UnixAddress("none/s"));
  ASSERT_FALSE(listener.ok());
  EXPECT_NE(listener.error().message.find("none/"), std::string::npos);
}

TEST_F(ListenerTest, ServersThatAreStartedTogetherWaitForEachOther) {
  const Address address = UnixAddress();
  const std::string folder = address.path.substr(0, address.path.rfind('/'));
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  const auto refused = Open(address);  // The other never ends.
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("another server is being started"), std::string::npos);
  std::thread other([descriptor] {
    usleep(50'000);
    close(descriptor);
  });
  const auto listener = Open(address);
  other.join();
  EXPECT_TRUE(listener.ok()) << listener.error().message;
}

TEST_F(ListenerTest, TheDefaultAddressNamedByHandGetsItsFolder) {
  const char* const before = std::getenv("XDG_RUNTIME_DIR");
  const std::string kept = before == nullptr ? "" : before;
  const test::TemporaryFolder folder;
  ASSERT_EQ(setenv("XDG_RUNTIME_DIR", folder.Path("").c_str(), 1), 0);
  const std::string run = RunFolder();
  const auto listener = Open(*ParseAddress("unix:" + run + "/simulation.sock"));
  const auto elsewhere = Open(*ParseAddress("unix:" + folder.Path("else") + "/simulation.sock"));
  before == nullptr ? unsetenv("XDG_RUNTIME_DIR") : setenv("XDG_RUNTIME_DIR", kept.c_str(), 1);
  EXPECT_TRUE(listener.ok()) << listener.error().message;
  struct stat status {};
  ASSERT_EQ(stat(run.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700U);
  ASSERT_FALSE(elsewhere.ok());  // Any other folder is made by whoever names it.
}

TEST_F(ListenerTest, APortInUseIsRefusedWithTheReason) {
  const auto first = Open(TcpAddress());
  ASSERT_TRUE(first.ok());
  const auto second = Open((*first)->address());
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find("is in use by another program"), std::string::npos);
}

TEST_F(ListenerTest, AnAddressOfAnotherHostIsRefusedWithWhatToDo) {
  Address address = TcpAddress();
  address.host = "192.0.2.1";  // For documentation: no host has it.
  ListenSecurity security;
  security.insecure_lan = true;
  const auto listener = Listener::Open(
      io_, address, [](const Socket&) {}, security);
  ASSERT_FALSE(listener.ok());
  EXPECT_NE(listener.error().message.find("this host has no address 192.0.2.1; list"),
            std::string::npos)
      << listener.error().message;
}

TEST_F(ListenerTest, BeyondLoopbackIsRefusedWithTheReason) {
  Address address = TcpAddress();
  address.host = "0.0.0.0";
  const auto listener = Open(address);
  ASSERT_FALSE(listener.ok());
  EXPECT_EQ(listener.error().kind, ErrorKind::kUsage);
  EXPECT_NE(listener.error().message.find("beyond this host"), std::string::npos);
  EXPECT_NE(listener.error().message.find("ssh -L"), std::string::npos) << "it has no TLS";
}

TEST_F(ListenerTest, DiallingNobodySaysWhatIsMissing) {
  const auto dialled = DialTo(UnixAddress("nobody"));
  ASSERT_FALSE(dialled.ok());
  EXPECT_EQ(dialled.error().message, UnixAddress("nobody").Text() + ": no such file");
}

TEST_F(ListenerTest, AHostThatDoesNotEvenRefuseIsGivenUp) {
  // A queue of connections that is full and that nobody empties: the kernel drops what comes then.
  const int full = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(name);
  ASSERT_EQ(bind(full, reinterpret_cast<sockaddr*>(&name), size), 0);
  ASSERT_EQ(listen(full, 0), 0);
  ASSERT_EQ(getsockname(full, reinterpret_cast<sockaddr*>(&name), &size), 0);
  std::vector<int> waiting;
  for (int i = 0; i < 4; ++i) {
    waiting.push_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
    connect(waiting.back(), reinterpret_cast<sockaddr*>(&name), size);
  }
  Address address = TcpAddress();
  address.port = ntohs(name.sin_port);
  const auto dialled = DialTo(address);
  ASSERT_FALSE(dialled.ok());
  EXPECT_EQ(dialled.error().message, address.Text() + ": no answer within 3 s");
  for (const int one : waiting) close(one);
  close(full);
}

}  // namespace
}  // namespace footing::transport

#include "clients/study/session/server_link.h"

#include <gmock/gmock.h>

#include "common/net/lease.h"
#include "common/net/server.h"
#include "common/runtime/clock.h"
#include "tests/common/temporary_folder.h"

namespace footing::study {
namespace {

using ::testing::HasSubstr;

constexpr double kWithinS = 20;

/// A server with a lease, as footingd and footing-sim have it, and a session's link to it.
class ServerLinkTest : public ::testing::Test {
 protected:
  ServerLinkTest() { address_.path = folder_.Path("server.sock"); }

  void StartServer(std::uint64_t epoch) {
    transport::ServerOptions options;
    options.server_id = "footingd";
    options.version = "1";
    options.channels = {{"status", v1::Tick::kStatusFieldNumber, true}};
    options.epoch = epoch;
    transport::ServerHandlers handlers;
    handlers.on_command = [this](const transport::SessionInfo& who, const v1::Command& command) {
      if (command.take_lease().holder() == kHolder) ++asked_;
      return lease_.Answer(command, who.session, clock::MonotonicNs());
    };
    handlers.on_session_end = [this](const transport::SessionInfo& who) {
      lease_.EndSession(who.session);
    };
    server_ = std::make_unique<transport::Server>(console_.io(), options, handlers);
    ASSERT_TRUE(server_->Listen(address_).ok());
  }

  void Link() {
    link_ = std::make_unique<ServerLink>(
        console_, ServerLinkOptions{"footingd", address_, {"status"}, kHolder},
        ServerLinkHandlers{[this](const v1::Tick&) { ++ticks_; }, [this] { ++downs_; }});
  }

  bool RunUntil(const std::function<bool()>& condition) {
    return console_.RunUntil(condition, kWithinS) == Waited::kDone;
  }

  /// Answer of footingd to another session.
  v1::CommandResult Tare() {
    v1::Command command;
    command.mutable_tare()->set_serial("a board");
    const auto answer = lease_.Answer(command, kOther, clock::MonotonicNs());
    return answer ? *answer : v1::CommandResult();
  }

  /// Somebody takes the lease over, and gives it back.
  void TakeOver() {
    v1::Command command;
    command.mutable_take_lease()->set_holder("the operator");
    command.mutable_take_lease()->set_take_over(true);
    EXPECT_TRUE(lease_.Answer(command, kOther, clock::MonotonicNs())->ok());
  }

  static constexpr const char* kHolder = "participant P01";
  static constexpr std::uint64_t kOther = 1000;

  test::TemporaryFolder folder_;
  transport::Address address_;
  Console console_;
  lease::LeaseControl lease_{"footingd"};
  std::unique_ptr<transport::Server> server_;
  std::unique_ptr<ServerLink> link_;
  int ticks_ = 0, downs_ = 0, asked_ = 0;
};

TEST_F(ServerLinkTest, WhileItIsUpNobodyElseCommands) {
  StartServer(7);
  Link();
  EXPECT_FALSE(link_->up());
  ASSERT_TRUE(RunUntil([&] { return link_->up(); }));
  EXPECT_THAT(Tare().message(), HasSubstr("participant P01 has the lease of this footingd"));
  bool released = false;
  link_->lease().Release([&] { released = true; });
  ASSERT_TRUE(RunUntil([&] { return released; }));
  EXPECT_EQ(Tare().message(), "") << "lent";
  EXPECT_TRUE(link_->up()) << "a lease that is not wanted is not missed";
  EXPECT_FALSE(link_->lease().held());
  link_->lease().Hold();
  ASSERT_TRUE(RunUntil([&] { return link_->lease().held(); }));
  EXPECT_THAT(Tare().message(), HasSubstr("P01"));
}

TEST_F(ServerLinkTest, WhoMayOnlyWatchIsToldHowToGetMore) {
  StartServer(7);
  ASSERT_TRUE(server_->Listen(*transport::ParseAddress("tcp:127.0.0.1:0")).ok());
  address_ = server_->ListeningOn(1);
  Link();
  ASSERT_TRUE(RunUntil([&] { return link_->refused(); }));
  EXPECT_THAT(link_->Text(), HasSubstr("role control"));
  EXPECT_THAT(link_->Text(), HasSubstr("server's Unix socket"));
  EXPECT_FALSE(link_->up());
}

TEST_F(ServerLinkTest, ALeaseThatSomebodyHasIsAskedForAgain) {
  StartServer(7);
  TakeOver();
  Link();
  ASSERT_TRUE(RunUntil([&] { return !link_->lease().refusal().empty(); }));
  EXPECT_THAT(link_->Text(), HasSubstr("the operator has the lease"));
  EXPECT_FALSE(link_->up());
  EXPECT_FALSE(link_->broken());
  v1::Command release;
  release.mutable_release_lease();
  EXPECT_TRUE(lease_.Answer(release, kOther, clock::MonotonicNs())->ok());
  EXPECT_TRUE(RunUntil([&] { return link_->up(); }));
  EXPECT_GE(asked_, 2);
}

TEST_F(ServerLinkTest, ALeaseThatIsTakenOverBreaksIt) {
  StartServer(7);
  Link();
  ASSERT_TRUE(RunUntil([&] { return link_->up(); }));
  TakeOver();
  EXPECT_TRUE(RunUntil([&] { return link_->broken(); }));
  EXPECT_FALSE(link_->up());
  EXPECT_TRUE(link_->lease().lost());
  EXPECT_THAT(link_->Text(), HasSubstr("the operator has the lease"));
}

TEST_F(ServerLinkTest, AConnectionThatComesBackGoesOnWithItsLease) {
  StartServer(7);
  Link();
  ASSERT_TRUE(RunUntil([&] { return link_->up(); }));
  server_.reset();
  ASSERT_TRUE(RunUntil([&] { return downs_ == 1; }));
  EXPECT_FALSE(link_->up());
  EXPECT_FALSE(link_->broken());
  StartServer(7);  // The same one: only the connection was gone.
  ASSERT_TRUE(RunUntil([&] { return link_->up(); }));
  EXPECT_FALSE(link_->broken());
  EXPECT_EQ(link_->breaks(), 1u);
  EXPECT_THAT(Tare().message(), HasSubstr("P01"));
}

TEST_F(ServerLinkTest, AServerThatWasStartedAgainBreaksIt) {
  StartServer(7);
  Link();
  ASSERT_TRUE(RunUntil([&] { return link_->up(); }));
  server_.reset();
  ASSERT_TRUE(RunUntil([&] { return downs_ == 1; }));
  StartServer(8);
  EXPECT_TRUE(RunUntil([&] { return link_->broken(); }));
  EXPECT_THAT(link_->Text(), HasSubstr("it was started again"));
}

}  // namespace
}  // namespace footing::study

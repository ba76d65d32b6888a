#include "clients/study/session/servers.h"

#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/net/lease.h"
#include "common/net/server.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "tests/common/temporary_folder.h"

namespace footing::study {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A server that publishes one tick again and again, gives its lease, and answers other commands
/// as the test says.
class RepeatingServer {
 public:
  RepeatingServer(Console& console, const std::string& name, const transport::Address& address,
                  std::vector<transport::Channel> channels)
      : lease_(name),
        server_(console.io(), Options(name, std::move(channels)), Handlers()),
        timer_(console.io()) {
    EXPECT_TRUE(server_.Listen(address).ok());
    PublishLater();
  }

  v1::Tick tick;
  std::function<v1::CommandResult(const v1::Command&)> answer;

 private:
  static transport::ServerOptions Options(const std::string& name,
                                          std::vector<transport::Channel> channels) {
    transport::ServerOptions options;
    options.server_id = name;
    options.version = "1";
    options.channels = std::move(channels);
    return options;
  }
  transport::ServerHandlers Handlers() {
    transport::ServerHandlers handlers;
    handlers.on_command = [this](const transport::SessionInfo& who, const v1::Command& command) {
      const auto leased = lease_.Answer(command, who.session, clock::MonotonicNs());
      return leased ? leased : std::optional(answer(command));
    };
    return handlers;
  }
  void PublishLater() {
    timer_.expires_after(std::chrono::milliseconds(10));
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      server_.Publish(clock::MonotonicNs(), transport::ChannelsOf(tick));
      PublishLater();
    });
  }

  lease::LeaseControl lease_;
  transport::Server server_;
  timer::Timer timer_;
};

/// A session's connections to both servers; the character is in a trial with the interface arm.
class ServersTest : public ::testing::Test {
 protected:
  ServersTest() {
    sensor_address_.path = folder_.Path("sensor");
    simulation_address_.path = folder_.Path("simulation");
    sensor_.emplace(
        console_, "footingd", sensor_address_,
        std::vector<transport::Channel>{{"status", v1::Tick::kStatusFieldNumber, true},
                                        {"features", v1::Tick::kFeaturesFieldNumber, false}});
    sensor_->tick.mutable_status();
    simulation_.emplace(
        console_, "footing-sim", simulation_address_,
        std::vector<transport::Channel>{{"characters", v1::Tick::kCharactersFieldNumber, false}});
    v1::Character& character = *simulation_->tick.mutable_characters()->add_characters();
    trial_ = character.mutable_trial();
    trial_->set_phase(v1::TrialState::PHASE_RUNNING);
    trial_->set_trial("a trial");
    interface_ = character.mutable_interface();
    interface_->set_interface(v1::USER_INTERFACE_ARM);
    simulation_->answer = [this](const v1::Command& command) { return Answer(command); };
  }

  v1::CommandResult Answer(const v1::Command& command) {
    v1::CommandResult result;
    result.set_id(command.id());
    result.set_ok(command.has_set_interface());
    if (command.has_set_interface()) interface_->set_interface(v1::USER_INTERFACE_WRIST);
    if (!command.has_stop_trial()) return result;
    ++stops_;
    result.set_message("stop_trial: no trial is ready or running");
    if (ends_by_itself_) trial_->set_phase(v1::TrialState::PHASE_FINISHED);
    if (!ends_by_itself_) result.set_message("stop_trial: the brake is stuck");
    return result;
  }

  /// Text that the experimenter reads while the study changes over to the interface wrist.
  std::string UseWrist() {
    auto servers =
        Servers::Open(console_, {sensor_address_, simulation_address_, "the test"}, active_);
    EXPECT_TRUE(servers) << servers.error().message;
    if (!servers) return "";
    testing::internal::CaptureStderr();
    const auto done = (*servers)->UseInterface("wrist", "head", "");
    EXPECT_TRUE(done) << done.error().message;
    return testing::internal::GetCapturedStderr();
  }

  test::TemporaryFolder folder_;
  Console console_;
  ActiveTime active_;
  transport::Address sensor_address_, simulation_address_;
  std::optional<RepeatingServer> sensor_, simulation_;
  v1::TrialState* trial_ = nullptr;
  v1::InterfaceState* interface_ = nullptr;
  bool ends_by_itself_ = true;
  int stops_ = 0;
};

TEST_F(ServersTest, ATrialThatEndsByItselfNeedNotBeStopped) {
  EXPECT_THAT(UseWrist(), Not(HasSubstr("not stopped")));
  EXPECT_EQ(stops_, 1);
}

TEST_F(ServersTest, BeforeTheFirstTrialNothingIsStopped) {
  trial_->set_phase(v1::TrialState::PHASE_READY);
  trial_->clear_trial();
  ends_by_itself_ = false;
  EXPECT_EQ(UseWrist(), "");
  EXPECT_EQ(stops_, 0);
}

TEST_F(ServersTest, OnlyTheBrokenConnectionIsACause) {
  auto servers =
      Servers::Open(console_, {sensor_address_, simulation_address_, "the test"}, active_);
  ASSERT_TRUE(servers) << servers.error().message;
  EXPECT_EQ((*servers)->WhyNotLive(), "");
  simulation_.reset();
  ASSERT_EQ(console_.RunUntil([&] { return !(*servers)->live(); }, 20), Waited::kDone);
  EXPECT_THAT((*servers)->WhyNotLive(), HasSubstr("footing-sim at "));
  EXPECT_THAT((*servers)->WhyNotLive(), Not(HasSubstr("footingd")));
}

TEST_F(ServersTest, WhyATrialThatGoesOnWasNotStoppedIsSaid) {
  ends_by_itself_ = false;
  EXPECT_THAT(UseWrist(), HasSubstr("the trial that goes on was not stopped: footing-sim: "
                                    "stop_trial: the brake is stuck"));
}

}  // namespace
}  // namespace footing::study

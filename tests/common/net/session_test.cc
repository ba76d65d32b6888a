#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "common/net/session.h"
#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

using testing::HasSubstr;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string ProblemOf(const std::function<void(v1::Command&)>& set) {
  v1::Command command;
  set(command);
  const auto checked = CheckContent(command);
  return checked ? "" : checked.error().message;
}

TEST(TickStream, WhoResumesGetsTheRingBeforeLiveTicks) {
  const ServerOptions options;
  Publication publication(options);
  const auto publish = [&] {
    const SharedTick tick = publication.Publish(publication.Next(1'000'000), {});
    publication.Keep(tick);
    return tick;
  };
  for (int i = 0; i < 3; ++i) publish();
  const std::uint64_t epoch = 5;
  TickStream stream(publication, epoch);
  v1::Subscribe wish;
  wish.set_from_epoch(epoch);
  wish.set_from_sequence(2);
  EXPECT_EQ(stream.FirstSequence(wish), 2u);
  stream.Begin(Settle(wish, options).subscription, 2, options.tick_rate_hz);
  EXPECT_EQ(stream.Waiting().first, 2u);
  EXPECT_EQ(stream.Offer(publish()), TickStream::Offered::kFromRing);
  WriteBatch batch;
  EXPECT_FALSE(stream.FillLive(batch));
  while (stream.wants_ring()) stream.FillFromRing(batch);
  EXPECT_EQ(stream.sent(), 3u);
  EXPECT_EQ(stream.Offer(publish()), TickStream::Offered::kQueued);
  EXPECT_TRUE(stream.FillLive(batch));
  EXPECT_EQ(stream.sent(), 4u);
}

TEST(CommandContent, EveryTextIsPrintable) {
  for (const std::string text : {"a\nb", "\x1b[2J", "a\x7f", "\u009b2J", "\t"}) {
    const std::vector<std::function<void(v1::Command&)>> all = {
        [&](auto& command) { command.mutable_assign_role()->set_rig(text); },
        [&](auto& command) { command.mutable_record_setup()->set_rig(text); },
        [&](auto& command) { command.mutable_record_setup()->mutable_item()->set_note(text); },
        [&](auto& command) { command.mutable_set_board_layout()->mutable_layout()->set_rig(text); },
        [&](auto& command) { command.mutable_set_study()->mutable_study()->set_participant(text); },
        [&](auto& command) {
          command.mutable_set_game()->mutable_game()->add_players()->set_name(text);
        },
        [&](auto& command) { command.mutable_set_subject()->set_code(text); },
        [&](auto& command) { command.mutable_correct_failure()->set_reason(text); },
        [&](auto& command) { command.mutable_start_trial()->set_track(text); },
        [&](auto& command) { command.mutable_take_lease()->set_holder(text); }};
    for (const auto& set : all) EXPECT_THAT(ProblemOf(set), HasSubstr("control characters"));
  }
}

TEST(CommandContent, TheFieldIsNamed) {
  EXPECT_EQ(ProblemOf([](auto& command) {
              command.mutable_record_setup()->mutable_item()->set_unit("N\n");
            }),
            "record_setup.item.unit has control characters, which a text must not have");
  EXPECT_EQ(ProblemOf([](auto& command) {
              command.mutable_record_setup()->mutable_item()->set_residual(kNotANumber);
            }),
            "record_setup.item.residual is not a finite number");
}

TEST(CommandContent, LettersOfAllLanguagesAndTablesOfSeveralLinesAreTaken) {
  EXPECT_EQ(ProblemOf([](auto& command) {
              command.mutable_set_study()->mutable_study()->set_doing("Grüße, 日本語 𝄞");
            }),
            "");
  EXPECT_EQ(
      ProblemOf([](auto& command) { command.mutable_set_interface()->set_table("{\n\t}\n"); }), "");
  EXPECT_EQ(ProblemOf([](auto&) {}), "");
}

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

#include "common/net/command_content.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

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

}  // namespace
}  // namespace footing::transport

#include "common/cli/cli.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace footing::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Options {
  int trials = 3;
  std::uint64_t seed = 1;
  double rate_hz = 50;
  double seconds = 0;
  std::string gait = "walk";
  std::vector<std::string> listen;
};

/// A program with one command, as all of ours are built.
struct Program {
  Program() {
    CLI::App* run = app->add_subcommand("run", "Run the trials");
    run->add_option("--trials", options.trials, "Number of trials");
    run->add_option("--seed", options.seed, "Seed");
    run->add_option("--rate-hz", options.rate_hz, "Rate, Hz")->check(CLI::Range(0.25, 100.0));
    run->add_option("--gait", options.gait, "Gait")->check(CLI::IsMember({"walk", "run"}));
    run->add_option("--seconds", options.seconds, "Duration, s (default: until SIGINT)");
    run->add_option("--listen", options.listen, "Address; may be repeated");
    app->add_subcommand("list", "List the trials");
    app->require_subcommand(1);
  }

  Options options;
  std::unique_ptr<CLI::App> app = NewApp("footing-test", "A program.",
                                         "  footing-test run --trials 2 \\\n"
                                         "                   --seconds 1\n"
                                         "  footing-test list");
};

/// The exit code that Parse asks for; 0 when the program may go on.
int ExitCode(Program& program, std::vector<std::string> words) {
  std::vector<char*> argv{const_cast<char*>("footing-test")};
  for (std::string& word : words) argv.push_back(word.data());
  return Parse(*program.app, static_cast<int>(argv.size()), argv.data()).value_or(0);
}

TEST(Help, PrintsDefaultsButNoEmptyOrStatedOnes) {
  Program program;
  testing::internal::CaptureStdout();
  EXPECT_EQ(ExitCode(program, {"run", "--help"}), 0);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_THAT(help, HasSubstr("--trials INT=3"));
  EXPECT_THAT(help, Not(HasSubstr("=[]")));
  EXPECT_THAT(help, Not(HasSubstr("--seconds FLOAT=0")));
}

TEST(Help, ShowsACommandItsOwnExamplesOnly) {
  Program program;
  testing::internal::CaptureStdout();
  EXPECT_EQ(ExitCode(program, {"run", "--help"}), 0);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_THAT(help, HasSubstr("Examples:\n  footing-test run --trials 2 \\\n"
                              "                   --seconds 1\nExit codes: 0 ok"));
  EXPECT_THAT(help, Not(HasSubstr("footing-test list")));
}

TEST(Parse, NamesAnUnknownOptionAndWhereHelpIs) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {"run", "--frequency", "3"}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "error: unknown option --frequency; run footing-test run --help\n");
}

TEST(Parse, ListsTheSubcommandsBesideAnUnknownOne) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {"walk"}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "error: unknown subcommand walk; there are: run list; run footing-test --help\n");
}

TEST(Parse, ListsTheSubcommandsWhenNoneIsGiven) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "error: a subcommand is missing; there are: run list; run footing-test --help\n");
}

TEST(Parse, WritesARangeWithoutTrailingZeros) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {"run", "--rate-hz", "200.5"}), 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("--rate-hz 200.5: must be from 0.25 to 100;"));
}

TEST(Parse, ListsTheValuesThatAnOptionTakes) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {"run", "--gait", "fly"}), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "error: --gait fly: must be one of walk, run; run footing-test run --help\n");
}

TEST(Parse, ListsTheSubcommandsWhenAnOptionIsGivenWithoutOne) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {"--of", "nothing"}), 2);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("there are: run list"));
}

TEST(Parse, TakesNoNumberThatIsNotFinite) {
  for (const char* word : {"nan", "NaN", "inf", "-inf"}) {
    for (const char* option : {"--rate-hz", "--seconds"}) {
      Program program;
      testing::internal::CaptureStderr();
      EXPECT_EQ(ExitCode(program, {"run", option, word}), 2) << option << " " << word;
      EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr(option));
    }
  }
  Program program;
  EXPECT_EQ(ExitCode(program, {"run", "--seconds", "1e300"}), 0);
}

TEST(Parse, TakesNoNegativeNumberWhereThereIsNone) {
  Program negative, positive;
  EXPECT_EQ(ExitCode(negative, {"run", "--seed", "-1"}), 2);
  EXPECT_EQ(ExitCode(positive, {"run", "--seed", "18446744073709551615", "--trials", "-2"}), 0);
  EXPECT_EQ(positive.options.seed, 18446744073709551615u);
}

TEST(Parse, ReportsAValueThatIsNotANumberInOneLine) {
  Program program;
  testing::internal::CaptureStderr();
  EXPECT_EQ(ExitCode(program, {"run", "--trials", "many"}), 2);
  const std::string error = testing::internal::GetCapturedStderr();
  EXPECT_THAT(error, testing::StartsWith("error: "));
  EXPECT_THAT(error, HasSubstr("--trials: many is not a number that it takes; run "));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1);
}

}  // namespace
}  // namespace footing::cli

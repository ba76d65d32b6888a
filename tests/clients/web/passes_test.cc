#include "clients/web/passes.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "clients/web/web_server.h"
#include "common/base/units.h"

namespace footing::web {
namespace {

std::function<std::string()> Numbered() {
  return [number = 0]() mutable { return "secret-" + std::to_string(++number); };
}

TEST(Passes, ACodeIsForOneBrowserAndTenMinutes) {
  Passes passes(Numbered());
  const std::string code = passes.NewCode(Right::kDevices, 0);
  EXPECT_FALSE(passes.Redeem("secret-2", 1));
  EXPECT_FALSE(passes.Redeem("", 1));
  const auto pass = passes.Redeem(code, 1);
  ASSERT_TRUE(pass);
  EXPECT_NE(*pass, code);
  EXPECT_FALSE(passes.Redeem(code, 2)) << "used";
  EXPECT_EQ(passes.RightOf(*pass, 2), Right::kDevices);
  EXPECT_EQ(passes.RightOf(code, 2), Right::kNone);
  EXPECT_EQ(passes.RightOf("", 2), Right::kNone);
  EXPECT_EQ(passes.RightOf(*pass, SecondsToNanoseconds(Passes::kPassLastsS + 1)), Right::kNone);
  const std::string old = passes.NewCode(Right::kView, 0);
  EXPECT_FALSE(passes.Redeem(old, SecondsToNanoseconds(Passes::kCodeLastsS + 1)));
}

TEST(Passes, TheOldestCodeGoesWhenThereAreTooMany) {
  Passes passes(Numbered());
  const std::string first = passes.NewCode(Right::kView, 0);
  std::string last;
  for (std::size_t i = 0; i < Passes::kMostCodes; ++i) last = passes.NewCode(Right::kView, 0);
  EXPECT_FALSE(passes.Redeem(first, 1));
  EXPECT_TRUE(passes.Redeem(last, 1));
}

TEST(Passes, ArePickedUpAfterARestart) {
  constexpr std::int64_t kHour = 3'600'000'000'000, kWall = 500'000 * kHour;
  Passes before(Numbered());
  const std::string view = *before.Redeem(before.NewCode(Right::kView, 0), 0);
  const std::string phone = *before.Redeem(before.NewCode(Right::kDevices, kHour), kHour);
  const std::string text = before.Text(2 * kHour, kWall);
  EXPECT_EQ(text.find(view), std::string::npos) << "a reader of the file cannot enter by it";
  // The machine was started as well: its own clock begins again.
  Passes after(Numbered());
  after.Take("no pass\n" + text + std::string(64, '0') + " 9 99999999999\n", 7, kWall + kHour);
  EXPECT_EQ(after.RightOf(view, 7), Right::kView);
  EXPECT_EQ(after.RightOf(phone, 7), Right::kDevices);
  EXPECT_EQ(after.RightOf("", 7), Right::kNone);
  EXPECT_EQ(after.RightOf(view, 9 * kHour + 8), Right::kNone) << "12 hours in all";
  EXPECT_EQ(after.RightOf(phone, 10 * kHour + 8), Right::kNone);
  EXPECT_EQ(after.RightOf(phone, 9 * kHour + 8), Right::kDevices);
}

TEST(Passes, AClockThatWasSetBackMakesNoPassLonger) {
  constexpr std::int64_t kHour = 3'600'000'000'000, kWall = 500'000 * kHour;
  Passes before(Numbered());
  const std::string pass = *before.Redeem(before.NewCode(Right::kView, 0), 0);
  Passes after(Numbered());
  after.Take(before.Text(0, kWall), 0, kWall - 1000 * kHour);
  EXPECT_EQ(after.RightOf(pass, 11 * kHour), Right::kView);
  EXPECT_EQ(after.RightOf(pass, 13 * kHour), Right::kNone);
  Passes late(Numbered());
  late.Take(before.Text(0, kWall), 0, kWall + 13 * kHour);
  EXPECT_EQ(late.RightOf(pass, 0), Right::kNone);
}

TEST(Passes, FindsItsCookieAmongOthers) {
  EXPECT_EQ(CookieIn("a=1; footing_pass=xyz; b=2", "footing_pass"), "xyz");
  EXPECT_EQ(CookieIn("footing_pass=xyz", "footing_pass"), "xyz");
  EXPECT_EQ(CookieIn("not_footing_pass=xyz", "footing_pass"), "");
  EXPECT_EQ(CookieIn("footing_pass_2=xyz", "footing_pass"), "");
  EXPECT_EQ(CookieIn("", "footing_pass"), "");
}

TEST(IsOwnHost, TakesNumericAddressesAndNamesThatItKnows) {
  for (const char* const own : {"127.0.0.1:7480", "127.0.0.1", "localhost:1", "[::1]:7480", "[::1]",
                                "192.168.1.5:7480", "lab1.example:7480"}) {
    EXPECT_TRUE(IsOwnHost(own, {"lab1.example"})) << own;
  }
  for (const char* const foreign : {"", ":7480", "attacker.example", "127.0.0.1.attacker.example",
                                    "localhost.attacker.example:7480", "[attacker]", "[::1", "["}) {
    EXPECT_FALSE(IsOwnHost(foreign, {"lab1.example"})) << foreign;
  }
}

TEST(PageFiles, AreCompressedAndEachOnce) {
  std::set<std::string_view> names, tags;
  for (const PageFile& file : PageFiles()) {
    EXPECT_TRUE(names.insert(file.name).second) << file.name;
    EXPECT_TRUE(tags.insert(file.etag).second) << file.name;
    ASSERT_GT(file.gzip.size(), 20u) << file.name;
    EXPECT_EQ(file.gzip.substr(0, 2), "\x1f\x8b") << file.name;
  }
  for (const char* const name : {"index.html", "live.js", "phone.html", "phone.js", "schema.js"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

}  // namespace
}  // namespace footing::web

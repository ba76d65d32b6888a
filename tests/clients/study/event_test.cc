#include "clients/study/report/event.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::study::records {
namespace {

std::string Line(std::uint64_t number, EventKind kind, nlohmann::ordered_json fields = {}) {
  Event event{kind, number, 1'700'000'000'000'000'000, nlohmann::ordered_json::object()};
  if (!fields.is_null()) event.fields = std::move(fields);
  return ToLine(event) + "\n";
}

TEST(JournalEvent, ReadsBackAsItWasWritten) {
  for (int i = 0; i <= static_cast<int>(EventKind::kNote); ++i) {
    const auto kind = static_cast<EventKind>(i);
    const Event event{kind,
                      3,
                      42,
                      {{"text", "line\nbreak \"q\" ü"},
                       {"value", 2.5},
                       {"f", true},
                       {"trial", "P01.wrist.test"},
                       {"item", "fun"},
                       {"outcome", "finished"},
                       {"time_s", 12.5},
                       {"failure", 1},
                       {"kind", "curve"}}};
    const std::string line = ToLine(event);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto read = ParseLine(line);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->kind, kind);
    EXPECT_EQ(read->number, 3u);
    EXPECT_EQ(read->wall_ns, 42);
    EXPECT_EQ(read->Text("text"), "line\nbreak \"q\" ü");
    EXPECT_EQ(read->Number("value"), 2.5);
    EXPECT_TRUE(read->Flag("f"));
    EXPECT_EQ(read->Text("value"), "");  // A number is not a text.
  }
}

TEST(JournalText, DropsATornLastLineAtWhateverByteItWasCut) {
  const std::string whole = Line(1, EventKind::kSessionStarted) + Line(2, EventKind::kNote);
  const std::string last = Line(3, EventKind::kRating, {{"item", "fun"}, {"value", 4}});
  for (std::size_t cut = 0; cut < last.size(); ++cut) {
    const auto journal = ParseJournal(whole + last.substr(0, cut), "j");
    ASSERT_TRUE(journal) << journal.error().message;
    EXPECT_EQ(journal->events.size(), 2u);
    EXPECT_EQ(journal->whole_bytes, whole.size());
    EXPECT_EQ(journal->torn_bytes, cut);
  }
  EXPECT_EQ(ParseJournal(whole + last, "j")->events.size(), 3u);
}

TEST(JournalText, RefusesAValueOfAnotherTypeThatWouldCountAsZero) {
  const std::pair<const char*, const char*> kWrong[] = {
      {R"("event": "trial_finished", "outcome": "finished", "time_s": "x"})", "time_s"},
      {R"("event": "trial_finished", "outcome": "finished"})", "without time_s"},
      {R"("event": "trial_finished", "time_s": 3})", "without outcome"},
      {R"("event": "rating", "item": "fun", "value": "five"})", "value must be a number"},
      {R"("event": "rating", "item": "fun"})", "without value"},
      {R"("event": "failure", "failure": "1", "kind": "curve"})", "failure must be a number"},
      {R"("event": "trial_started", "attempt": 1})", "without trial"}};
  for (const auto& [fields, what] : kWrong) {
    const auto journal =
        ParseJournal(R"({"number": 1, "wall_ns": 0, )" + std::string(fields) + "\n", "j.jsonl");
    ASSERT_FALSE(journal) << fields;
    EXPECT_EQ(journal.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(journal.error().message,
                testing::AllOf(testing::HasSubstr("j.jsonl, line 1"), testing::HasSubstr(what)));
  }
  const auto unknown = ParseJournal(
      R"({"number": 1, "wall_ns": 0, "event": "trial_finished", "outcome": "device_lost", "anticipation_s": null})"
      "\n",
      "j.jsonl");
  EXPECT_TRUE(unknown) << unknown.error().message;
}

TEST(JournalText, RefusesADamagedLineInTheMiddle) {
  const std::string first = Line(1, EventKind::kSessionStarted);
  for (const std::string& wrong :
       {std::string("{\"number\": 2\n"), std::string("\n"), Line(3, EventKind::kNote),
        std::string(R"({"number": 2, "wall_ns": 0, "event": "party"})") + "\n"}) {
    const auto journal = ParseJournal(first + wrong + Line(3, EventKind::kNote), "j.jsonl");
    ASSERT_FALSE(journal);
    EXPECT_EQ(journal.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(journal.error().message, testing::HasSubstr("j.jsonl, line 2"));
  }
}

}  // namespace
}  // namespace footing::study::records

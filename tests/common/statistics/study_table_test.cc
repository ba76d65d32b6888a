#include "common/statistics/study_table.h"

#include <gtest/gtest.h>

namespace footing::statistics {
namespace {

Result<StudyTable> Parse(const std::string& text, TableUse use = TableUse::kIndependent,
                         const std::string& control = "") {
  return ParseStudyTable(text, {"data.csv", control, use});
}

void ExpectFault(const Result<StudyTable>& result, const std::string& place,
                 const std::string& message) {
  ASSERT_FALSE(result) << message;
  EXPECT_EQ(result.error().kind, ErrorKind::kInvalidData);
  EXPECT_NE(result.error().message.find("data.csv, " + place + ":"), std::string::npos)
      << result.error().message;
  EXPECT_NE(result.error().message.find(message), std::string::npos) << result.error().message;
}

TEST(StudyTable, PutsTheControlFirstAndTheOthersByIndex) {
  const auto table = Parse("group_index,group,value\n2,leg,5\n0,stick,1\n1,arm,3\n0,stick,2\n");
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(table->groups.size(), 3u);
  EXPECT_EQ(table->groups[0].name, "stick");
  EXPECT_EQ(table->groups[0].values, (std::vector<double>{1, 2}));
  EXPECT_EQ(table->groups[1].name, "arm");
  EXPECT_EQ(table->groups[2].name, "leg");
  EXPECT_FALSE(table->blocks);
}

TEST(StudyTable, LeavesOtherColumnsAloneAndReadsWhatSpreadsheetsWrite) {
  const auto table = Parse(
      "\xEF\xBB\xBF\"note\",\"value\",\"group\",\"group_index\"\r\n"
      "# a remark\r\n\r\nx,1.5,\"stick\",0\r\n,+2e1,arm,1\r\n");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->groups[0].values, (std::vector<double>{1.5}));
  EXPECT_EQ(table->groups[1].values, (std::vector<double>{20}));
}

TEST(StudyTable, TwoColumnsOfOneNameAreRefused) {
  ExpectFault(Parse("group_index,group,value,value\n0,stick,1,9\n1,arm,3,9\n"), "line 1",
              "two columns are named value");
}

TEST(StudyTable, MakesBlocksOfSubjects) {
  const std::string text = "subject,group,value\np2,arm,4\np1,control,1\np2,control,3\np1,arm,2\n";
  const auto table = Parse(text, TableUse::kPaired);
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_TRUE(table->blocks);
  EXPECT_EQ(table->blocks->groups, (std::vector<std::string>{"control", "arm"}));
  EXPECT_EQ(table->blocks->subjects, (std::vector<std::string>{"p2", "p1"}));
  EXPECT_EQ(table->blocks->values, (std::vector<std::vector<double>>{{3, 4}, {1, 2}}));
}

TEST(StudyTable, ControlOfAPairedTableIsNamedOrCalledControlOrTheFirst) {
  const std::string text = "subject,group,value\n1,a,1\n1,b,2\n2,a,3\n2,b,4\n";
  EXPECT_EQ(Parse(text, TableUse::kPaired)->groups[0].name, "a");
  EXPECT_EQ(Parse(text, TableUse::kPaired, "b")->groups[0].name, "b");
  const std::string named = "subject,group,value\n1,a,1\n1,control,2\n2,a,3\n2,control,4\n";
  EXPECT_EQ(Parse(named, TableUse::kPaired)->groups[0].name, "control");
}

TEST(StudyTable, IndependentGroupsWithCompleteSubjectsHaveBlocksToo) {
  const std::string head = "group_index,group,subject,value\n0,a,1,1\n1,b,1,2\n0,a,2,3\n";
  EXPECT_TRUE(Parse(head + "1,b,2,4\n")->blocks);
  EXPECT_FALSE(Parse(head)->blocks);  // Subject 2 lacks group b; only a paired test needs it.
}

TEST(StudyTable, ReadsCountsAndExposures) {
  const auto table =
      Parse("group_index,group,value,exposure\n0,a,3,1.5\n1,b,0,2\n", TableUse::kCounts);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->exposures, (std::vector<std::vector<double>>{{1.5}, {2}}));
  const auto plain = Parse("group_index,group,value\n0,a,3\n1,b,0\n", TableUse::kCounts);
  EXPECT_EQ(plain->exposures, (std::vector<std::vector<double>>{{1}, {1}}));
}

TEST(StudyTable, BlocksOfCountsAreRates) {
  const auto table = Parse("group_index,group,subject,value,exposure\n0,a,1,3,1.5\n1,b,1,5,2\n",
                           TableUse::kCounts);
  EXPECT_EQ(table->blocks->values, (std::vector<std::vector<double>>{{2, 2.5}}));
  EXPECT_EQ(table->groups[0].values, (std::vector<double>{3}));
}

TEST(StudyTable, NamesTheLineOfABadCell) {
  const std::string head = "group_index,group,value\n0,a,1\n";
  ExpectFault(Parse(head + "1,b,two\n"), "line 3", "'two' is not a number");
  ExpectFault(Parse(head + "1,b,\n"), "line 3", "'' is not a number");
  ExpectFault(Parse(head + "1,b,nan\n"), "line 3", "is not a number");
  ExpectFault(Parse(head + "1,b,1e400\n"), "line 3", "is not a number");
  ExpectFault(Parse(head + "1,b,1e101\n"), "line 3", "is not a number");
  ExpectFault(Parse(head + "\n1,b\n"), "line 4", "2 cells where the header has 3");
  ExpectFault(Parse(head + "-1,b,2\n"), "line 3", "group_index '-1'");
  ExpectFault(Parse(head + "x,b,2\n"), "line 3", "group_index 'x'");
  ExpectFault(Parse(head + "1,,2\n"), "line 3", "column group is empty");
}

TEST(StudyTable, NamesAMissingColumn) {
  ExpectFault(Parse(""), "line 1", "empty");
  ExpectFault(Parse("group_index,group\n0,a\n"), "line 1", "no column value");
  ExpectFault(Parse("group_index,value\n0,1\n"), "line 1", "no column group;");
  ExpectFault(Parse("group,value\na,1\n"), "line 1", "no column group_index");
  ExpectFault(Parse("group,value\na,1\n", TableUse::kPaired), "line 1", "no column subject");
  ExpectFault(Parse("group_index,group,value\n"), "line 1", "no row");
  EXPECT_TRUE(Parse("group,value\na,1\nb,2\n", TableUse::kIndependent, "b"));
}

TEST(StudyTable, NamesAGroupThatIsMissingOrContradictsItself) {
  const std::string head = "group_index,group,value\n";
  ExpectFault(Parse(head + "1,a,1\n2,b,2\n"), "line 3", "no row has group_index 0");
  ExpectFault(Parse(head + "0,a,1\n2,b,2\n"), "line 3", "group_index 1 has no row");
  ExpectFault(Parse(head + "0,a,1\n0,a,2\n"), "line 3", "all rows are of the group 'a'");
  ExpectFault(Parse(head + "0,a,1\n1,b,2\n1,a,3\n"), "line 4",
              "group_index 1 here and 0 in line 2");
  ExpectFault(Parse(head + "0,a,1\n1,b,2\n1,c,3\n"), "line 4", "'b' and of 'c'");
  ExpectFault(Parse(head + "0,a,1\n1,b,2\n", TableUse::kIndependent, "c"), "line 3",
              "no row is of the control 'c'; the groups are a, b");
}

TEST(StudyTable, NamesTheSubjectThatIsIncompleteOrTwice) {
  const std::string head = "subject,group,value\np1,control,1\np1,arm,2\np2,control,3\n";
  ExpectFault(Parse(head, TableUse::kPaired), "line 4", "'p2' has no value for group 'arm'");
  ExpectFault(Parse(head + "p2,arm,1\np2,arm,2\n", TableUse::kPaired), "line 6",
              "second value for group 'arm' (the first is in line 5)");
  ExpectFault(Parse(head + ",arm,1\n", TableUse::kPaired), "line 5", "column subject is empty");
}

TEST(StudyTable, RefusesWhatIsNotACount) {
  const std::string head = "group_index,group,value,exposure\n0,a,1,1\n";
  for (const char* const value : {"1.5", "-1", "1000001"}) {
    ExpectFault(Parse(head + "1,b," + value + ",1\n", TableUse::kCounts), "line 3", "not a count");
  }
  for (const char* const exposure : {"0", "-1", "x", "1e10"}) {
    ExpectFault(Parse(head + "1,b,1," + exposure + "\n", TableUse::kCounts), "line 3", "exposure");
  }
}

}  // namespace
}  // namespace footing::statistics

#include "common/virtual/motion/table.h"

#include <gmock/gmock.h>

namespace footing::motion {
namespace {

using testing::HasSubstr;

constexpr const char* kMot =
    "forces\nversion=1\nnRows=2\nnColumns=10\ninDegrees=no\nendheader\n"
    "time\tg_force_vx\tg_force_vy\tg_force_vz\tg_force_px\tg_force_py\tg_force_pz\t"
    "g_torque_x\tg_torque_y\tg_torque_z\n"
    "0\t1\t700\t2\t0.1\t0\t0.3\t0\t5\t0\n"
    "0.01\t1\t701\t2\t0.1\t0\t0.3\t0\t5\t0\n";

std::string TableWith(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Table, RowsAndColumnsAreReadAndWrittenAgainByteForByte) {
  const auto table = ParseTable(kMot, "g.mot");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->values.rows(), 2);
  EXPECT_EQ(table->values(1, FindColumn(*table, "g_force_vy")), 701);
  const std::string once = WriteTable(*table);
  EXPECT_EQ(WriteTable(ParseTable(once, "once").value()), once);
}

TEST(Table, TheOtherHeaderIsReadToo) {
  const auto table = ParseTable(
      "name a b\ndatacolumns 2\ndatarows 1\nrange 0 1\nendheader\n\n time\t x\n 0.5\t 7\n",
      "a.sto");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->name, "a b");
  EXPECT_EQ(table->values(0, 1), 7);
}

TEST(Table, ForcesStandInTheWorld) {
  const auto forces = ToGroundForces(ParseTable(kMot, "g.mot").value(), "g.mot");
  ASSERT_TRUE(forces.ok()) << forces.error().message;
  EXPECT_EQ(forces->rate_hz, 100);
  ASSERT_EQ(forces->plates.size(), 1u);
  EXPECT_TRUE(forces->plates[0].force_W.col(0).isApprox(Eigen::Vector3d(1, -2, 700)));
  EXPECT_TRUE(forces->plates[0].cop_W.col(0).isApprox(Eigen::Vector3d(0.1, -0.3, 0)));
  EXPECT_TRUE(forces->plates[0].moment_W.col(0).isApprox(Eigen::Vector3d(0, 0, 5)));
}

TEST(Table, PlacesInMillimetresAreSeenAsThat) {
  const auto forces = ToGroundForces(
      ParseTable(TableWith(kMot, "\t0.1\t0\t0.3\t", "\t100\t0\t300\t"), "g.mot").value(), "g.mot");
  EXPECT_TRUE(forces->plates[0].cop_W.col(0).isApprox(Eigen::Vector3d(0.1, -0.3, 0)));
}

TEST(Table, ErrorsSayFileLineAndWhatWasExpected) {
  const struct {
    std::string text, message;
  } kRows[] = {
      {"", "expected 'endheader'"},
      {TableWith(kMot, "nColumns=10", "nColumns=11"), "11 columns are announced, 10 named"},
      {TableWith(kMot, "nRows=2", "nRows=3"), "3 rows are announced, the file has 2"},
      {TableWith(kMot, "701", "nan"), "g.mot, line 9: column g_force_vy: expected a number"},
      {TableWith(kMot, "0.01\t1\t701\t2", "0.01\t1\t701"), "the end of the line"},
      {TableWith(kMot, "\t5\t0\n", "\t5\t0\t1\n"), "more numbers than columns"},
  };
  for (const auto& row : kRows) {
    const auto table = ParseTable(row.text, "g.mot");
    ASSERT_FALSE(table.ok()) << row.message;
    EXPECT_THAT(table.error().message, HasSubstr(row.message));
  }
  const Table back = ParseTable(TableWith(kMot, "\n0.01\t", "\n-1\t"), "g.mot").value();
  EXPECT_THAT(ToGroundForces(back, "g.mot").error().message, HasSubstr("do not rise"));
}

}  // namespace
}  // namespace footing::motion

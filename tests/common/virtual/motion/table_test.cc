#include <gmock/gmock.h>

#include "common/virtual/motion/table.h"

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

constexpr const char* kTrc =
    "PathFileType\t4\t(X/Y/Z)\tx.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
    "100\t100\t2\t2\tmm\n"
    "Frame#\tTime\tC7\t\t\tL.ASIS\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "1\t1.5\t100\t1500\t-200\t1\t2\t3\n"
    "2\t1.51\t101\t1501\t-201\t\t\t\n";

std::string TrcWith(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(Trc, PlacesAreMetresAndGapsAreNotSeen) {
  const auto tracks = ParseTrc(kTrc, "x.trc");
  ASSERT_TRUE(tracks.ok()) << tracks.error().message;
  EXPECT_EQ(tracks->rate_hz, 100);
  EXPECT_EQ(tracks->start_s, 1.5);
  ASSERT_EQ(tracks->frames(), 2);
  EXPECT_TRUE(tracks->p[0].col(1).isApprox(Eigen::Vector3d(0.101, 1.501, -0.201)));
  EXPECT_TRUE(Seen(tracks->p[1].col(0)));
  EXPECT_FALSE(Seen(tracks->p[1].col(1)));
  EXPECT_EQ(FindMarker(*tracks, "L.ASIS"), 1);
  EXPECT_EQ(FindMarker(*tracks, "l.asis"), -1);
}

TEST(Trc, ToTheWorldZIsUp) {
  const auto tracks = ToWorld(FileAxes::kYUp, ParseTrc(kTrc, "x.trc").value());
  EXPECT_TRUE(tracks.p[0].col(0).isApprox(Eigen::Vector3d(0.1, 0.2, 1.5)));
}

TEST(Trc, OurOwnOutputIsReadAndWrittenAgainByteForByte) {
  const std::string once = WriteTrc(ParseTrc(kTrc, "x.trc").value(), "x.trc");
  const auto again = ParseTrc(once, "once");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(WriteTrc(*again, "x.trc"), once);
}

TEST(Trc, NaNInAFieldAndZerosAreGaps) {
  const auto nan = ParseTrc(TrcWith(kTrc, "1\t2\t3\n", "NaN\tNaN\tNaN\n"), "x.trc");
  ASSERT_TRUE(nan.ok());
  EXPECT_FALSE(Seen(nan->p[1].col(0)));
  const auto zero = ParseTrc(TrcWith(kTrc, "1\t2\t3\n", "0\t0\t0\n"), "x.trc");
  EXPECT_FALSE(Seen(zero->p[1].col(0)));
}

TEST(Trc, ErrorsSayFileLineAndWhatWasExpected) {
  const struct {
    std::string text, message;
  } kRows[] = {
      {"", "not a TRC file"},
      {TrcWith(kTrc, "\tmm\n", "\tinch\n"), "x.trc, line 3: expected Units"},
      {TrcWith(kTrc, "100\t100", "0\t100"), "expected DataRate"},
      {TrcWith(kTrc, "1501", "15o1"),
       "line 8: marker C7: expected a number within +-1e9, found '15o1'"},
      {TrcWith(kTrc, "2\t1.51", "2\tx"), "expected a frame number and a time"},
      {TrcWith(kTrc, "1.51", "1.53"), "line 8: the time 1.53 s is not a frame of DataRate after"},
      {TrcWith(kTrc, "1.51", "1.49"), "frames are missing or in another order"},
      {TrcWith(kTrc, "100\t100", "200\t100"), "or DataRate is wrong"},
      {TrcWith(kTrc, "100\t2\t2", "100\t897\t2"), "ends after frame 2, and NumFrames is 897"},
      {std::string(kTrc).substr(0, std::string(kTrc).find("\n1\t1.5")), "no frame"},
  };
  for (const auto& row : kRows) {
    const auto tracks = ParseTrc(row.text, "x.trc");
    ASSERT_FALSE(tracks.ok()) << row.message;
    EXPECT_THAT(tracks.error().message, HasSubstr(row.message));
  }
}

}  // namespace
}  // namespace footing::motion

#include "common/virtual/motion/trc.h"

#include <gmock/gmock.h>

namespace footing::motion {
namespace {

using testing::HasSubstr;

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

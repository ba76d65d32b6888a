#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "daemon/sensor/reports/camera.h"
#include "daemon/sensor/reports/input_report.h"

namespace footing::reports {
namespace {

using InterleaverReport = std::vector<std::uint8_t>;

/// A half with buttons b0 b1, an acceleration byte and 18 camera bytes that count up.
InterleaverReport HalfReport(std::uint8_t id, std::uint8_t b0, std::uint8_t b1, std::uint8_t axis,
                             std::uint8_t first_camera_byte) {
  InterleaverReport report = {id, b0, b1, axis};
  report.resize(22);
  std::iota(report.begin() + 4, report.end(), first_camera_byte);
  return report;
}

Data DataOf(const InterleaverReport& report) { return std::get<Data>(Decode(report).body); }

TEST(Interleaver, JoinsAPair) {
  Interleaver interleaver;
  // z = 0x9c = 1001'1100: bits 7,6 = 2 in 3e b1; 5,4 = 1 in 3e b0; 3,2 = 3 in 3f b1; 1,0 = 0 in 3f
  // b0.
  const Data first = DataOf(HalfReport(0x3e, 1 << 5, 2 << 5, 0x81, 0));
  EXPECT_EQ(first.half, Half::kFirst);
  EXPECT_FALSE(first.has_acceleration);
  EXPECT_FALSE(interleaver.Take(first));
  const auto pair = interleaver.Take(DataOf(HalfReport(0x3f, 0 << 5, 3 << 5, 0x7d, 18)));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->half, Half::kNone);
  EXPECT_TRUE(pair->has_acceleration);
  EXPECT_EQ(pair->acceleration_counts,
            (std::array<std::uint16_t, 3>{0x81 << 2, 0x7d << 2, 0x9c << 2}));
  ASSERT_EQ(pair->camera().size(), 36u);
  for (std::uint8_t i = 0; i < 36; ++i) EXPECT_EQ(pair->camera()[i], i);
}

TEST(Interleaver, ALoneHalfGivesNothing) {
  Interleaver interleaver;
  const Data first = DataOf(HalfReport(0x3e, 0, 0, 0x80, 0));
  const Data second = DataOf(HalfReport(0x3f, 0, 0, 0x80, 18));
  EXPECT_FALSE(interleaver.Take(second));
  EXPECT_FALSE(interleaver.Take(first));
  EXPECT_FALSE(interleaver.Take(first)) << "the second one was lost";
  EXPECT_TRUE(interleaver.Take(second)) << "joins the newer first half";
  EXPECT_FALSE(interleaver.Take(second)) << "each half is used once";
}

TEST(Interleaver, AnotherReportInBetweenPassesAndBreaksThePair) {
  Interleaver interleaver;
  EXPECT_FALSE(interleaver.Take(DataOf(HalfReport(0x3e, 0, 0, 0x80, 0))));
  const auto passed = interleaver.Take(DataOf(InterleaverReport{0x31, 0, 0, 0x80, 0x80, 0x9a}));
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->id, 0x31);
  EXPECT_FALSE(interleaver.Take(DataOf(HalfReport(0x3f, 0, 0, 0x80, 18))));
}

TEST(Interleaver, HalvesCutShortJoinNothing) {
  for (std::size_t size = 3; size < 22; ++size) {
    Interleaver interleaver;
    InterleaverReport cut = HalfReport(0x3e, 0, 0, 0x80, 0);
    cut.resize(size);
    EXPECT_FALSE(interleaver.Take(DataOf(cut))) << size;
    EXPECT_FALSE(interleaver.Take(DataOf(HalfReport(0x3f, 0, 0, 0x80, 18)))) << size;
  }
}

TEST(CameraBytes, AreWhereEachReportHasThem) {
  struct Case {
    std::uint8_t id;
    std::size_t at;
    std::size_t size;
  };
  // Counted from the id byte.
  for (const Case& c : {Case{0x33, 6, 12}, Case{0x36, 3, 10}, Case{0x37, 6, 10}, Case{0x3e, 4, 18},
                        Case{0x3f, 4, 18}}) {
    InterleaverReport report(22);
    std::iota(report.begin(), report.end(), std::uint8_t{0});
    report[0] = c.id;
    if (c.id == 0x33) report.resize(18);
    const Data data = DataOf(report);
    ASSERT_EQ(data.camera().size(), c.size) << int{c.id};
    EXPECT_EQ(data.camera().front(), c.at) << int{c.id};
    EXPECT_EQ(data.camera().back(), c.at + c.size - 1) << int{c.id};
    report.resize(c.at + c.size - 1);
    EXPECT_TRUE(DataOf(report).camera().empty()) << "cut short";
  }
}

TEST(ShortForms, OfEveryDataReportCarryButtonsOnly) {
  // The kernel takes ids 0x30 to 0x3f with two bytes of payload; only 0x3d has no buttons.
  for (const std::uint8_t id : {0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x3e, 0x3f}) {
    const InputReport report = Decode(InterleaverReport{id, 0xff, 0xff});
    EXPECT_EQ(report.buttons, 0x1f9f) << int{id};
    const Data& data = std::get<Data>(report.body);
    EXPECT_FALSE(data.has_acceleration);
    EXPECT_TRUE(data.extension().empty());
    EXPECT_TRUE(data.camera().empty());
  }
}

}  // namespace
}  // namespace footing::reports

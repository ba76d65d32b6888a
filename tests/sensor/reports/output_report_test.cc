#include <gtest/gtest.h>

#include "daemon/sensor/reports/output_report.h"

namespace footing::reports {
namespace {

using Progress = MemoryRead::Progress;

MemoryData Piece(std::uint16_t offset, std::uint8_t size, std::uint8_t fill) {
  MemoryData piece;
  piece.offset = offset;
  piece.size = size;
  piece.data.fill(fill);
  return piece;
}

TEST(MemoryRead, PutsPiecesTogether) {
  MemoryRead read(Space::kEeprom, 0x0016, 20);
  EXPECT_EQ(read.Take(Piece(0x16, 16, 1)), Progress::kMore);
  EXPECT_EQ(read.Take(Piece(0x26, 4, 2)), Progress::kDone);
  ASSERT_EQ(read.bytes().size(), 20u);
  EXPECT_EQ(read.bytes()[15], 1);
  EXPECT_EQ(read.bytes()[16], 2);
}

TEST(MemoryRead, ShorterPiecesThanUsualAddUp) {
  MemoryRead read(Space::kEeprom, 0, 5);
  EXPECT_EQ(read.Take(Piece(0, 2, 1)), Progress::kMore);
  EXPECT_EQ(read.Take(Piece(2, 3, 1)), Progress::kDone);
}

TEST(MemoryRead, RepliesToOthersAndDuplicatesAreForeign) {
  MemoryRead read(Space::kRegisters, 0xa40020, 32);
  EXPECT_EQ(read.Take(Piece(0x00fa, 6, 9)), Progress::kForeign);
  EXPECT_EQ(read.Take(Piece(0x0020, 16, 1)), Progress::kMore);
  EXPECT_EQ(read.Take(Piece(0x0020, 16, 1)), Progress::kForeign);
  EXPECT_EQ(read.Take(Piece(0x0030, 16, 2)), Progress::kDone);
  EXPECT_EQ(read.Take(Piece(0x0040, 16, 2)), Progress::kForeign);
}

TEST(MemoryRead, APieceLongerThanWhatIsMissingIsForeign) {
  MemoryRead read(Space::kRegisters, 0xa400fa, 6);
  EXPECT_EQ(read.Take(Piece(0x00fa, 16, 1)), Progress::kForeign);
  EXPECT_TRUE(read.bytes().empty());
}

TEST(MemoryRead, AnErrorAtTheDueOffsetRefuses) {
  MemoryRead read(Space::kRegisters, 0xa600fa, 6);
  MemoryData reply = Piece(0x0000, 16, 0);
  reply.error = 7;
  EXPECT_EQ(read.Take(reply), Progress::kForeign);
  reply.offset = 0x00fa;
  EXPECT_EQ(read.Take(reply), Progress::kRefused);
  EXPECT_EQ(read.error(), 7);
}

TEST(MemoryRead, AsksForWhatIsMissing) {
  MemoryRead read(Space::kEeprom, 0x0016, 20);
  EXPECT_EQ(read.Request(), ReadMemory(Space::kEeprom, 0x0016, 20));
  EXPECT_EQ(read.Take(Piece(0x16, 16, 1)), Progress::kMore);
  EXPECT_EQ(read.Request(), ReadMemory(Space::kEeprom, 0x0026, 4));
  read.Restart();
  EXPECT_EQ(read.Request(), ReadMemory(Space::kEeprom, 0x0016, 20));
}

TEST(OutputReport, BytesAreThoseOfTheProtocol) {
  EXPECT_EQ(RumbleOnly(), (OutputReport{0x10, 0x00}));
  EXPECT_EQ(SetLeds(0x5), (OutputReport{0x11, 0x50}));
  EXPECT_EQ(SetMode(0x31, true), (OutputReport{0x12, 0x04, 0x31}));
  EXPECT_EQ(SetMode(0x30, false), (OutputReport{0x12, 0x00, 0x30}));
  EXPECT_EQ(RequestStatus(), (OutputReport{0x15, 0x00}));
  EXPECT_EQ(ReadMemory(Space::kEeprom, 0x0016, 20),
            (OutputReport{0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x14}));
  EXPECT_EQ(ReadMemory(Space::kRegisters, 0xa400fa, 6),
            (OutputReport{0x17, 0x04, 0xa4, 0x00, 0xfa, 0x00, 0x06}));
}

TEST(OutputReport, AWriteIsPaddedToSixteenBytes) {
  const std::uint8_t key[] = {0x55};
  OutputReport expected = {0x16, 0x04, 0xa4, 0x00, 0xf0, 0x01, 0x55};
  expected.resize(22, 0);
  EXPECT_EQ(WriteMemory(Space::kRegisters, 0xa400f0, key), expected);
}

TEST(OutputReport, AWriteIsCutAtSixteenBytes) {
  const std::vector<std::uint8_t> many(40, 0xaa);
  const OutputReport report = WriteMemory(Space::kEeprom, 0, many);
  EXPECT_EQ(report.size(), 22u);
  EXPECT_EQ(report[5], 16);
}

TEST(OutputReport, EveryReportKeepsTheRumbleBit) {
  const std::uint8_t byte[] = {0x00};
  for (OutputReport report :
       {RumbleOnly(), SetLeds(0xf), SetMode(0x31, true), RequestStatus(),
        WriteMemory(Space::kRegisters, 0xa400f0, byte), ReadMemory(Space::kEeprom, 0, 1)}) {
    const OutputReport without = report;
    SetRumbleBit(report, true);
    EXPECT_EQ(report[1], without[1] | 0x01);
    SetRumbleBit(report, false);
    EXPECT_EQ(report, without);
  }
}

}  // namespace
}  // namespace footing::reports

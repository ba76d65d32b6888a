#include "daemon/sensor/reports/memory_read.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace footing::reports

#include "common/virtual/devices/memory.h"

#include <gtest/gtest.h>

#include <array>

#include "common/virtual/devices/extensions.h"

namespace footing::virtual_devices {
namespace {

std::array<std::uint8_t, 6> IdentityAt(const Memory& memory, std::uint32_t page,
                                       std::uint8_t* error = nullptr) {
  std::array<std::uint8_t, 6> bytes{};
  const std::uint8_t result = memory.Read(true, page + 0xfa, bytes);
  if (error != nullptr) *error = result;
  return bytes;
}

std::uint8_t Write(Memory& memory, std::uint32_t address, std::uint8_t value) {
  return memory.Write(true, address, {{value}});
}

void Key(Memory& memory) {
  EXPECT_EQ(Write(memory, 0xa400f0, 0x55), kMemoryOk);
  EXPECT_EQ(Write(memory, 0xa400fb, 0x00), kMemoryOk);
}

TEST(Memory, AnExtensionReadsAsFfUntilTheKeyIsWritten) {
  Memory memory(false);
  memory.SetExtension(NunchukPage(DrawNunchukBlock(1)));
  EXPECT_TRUE(memory.has_extension());
  EXPECT_EQ(IdentityAt(memory, 0xa40000)[2], 0xff);
  Key(memory);
  EXPECT_EQ(IdentityAt(memory, 0xa40000),
            (std::array<std::uint8_t, 6>{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00}));
}

TEST(Memory, AMotionPlusMovesToTheExtensionsPageAndBack) {
  Memory memory(false);
  memory.SetExtension(NunchukPage(DrawNunchukBlock(1)));
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), false));
  EXPECT_EQ(IdentityAt(memory, 0xa60000),
            (std::array<std::uint8_t, 6>{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}));
  for (const std::uint8_t mode : {4, 5, 7}) {
    EXPECT_EQ(Write(memory, 0xa600fe, mode), kMemoryOk);
    EXPECT_EQ(memory.motion_plus_mode(), mode);
    EXPECT_EQ(IdentityAt(memory, 0xa40000),
              (std::array<std::uint8_t, 6>{0x00, 0x00, 0xa4, 0x20, mode, 0x05}));
    std::uint8_t error = 0;
    IdentityAt(memory, 0xa60000, &error);
    EXPECT_EQ(error, kMemoryAbsent);
    Key(memory);  // Ends it, and begins the child's initialisation.
    EXPECT_EQ(memory.motion_plus_mode(), 0);
    EXPECT_EQ(IdentityAt(memory, 0xa40000)[4], 0x00);
    EXPECT_TRUE(memory.extension_plain());
    EXPECT_EQ(IdentityAt(memory, 0xa60000)[2], 0xa6);
  }
}

TEST(Memory, AMotionPlusIgnoresModesThatItDoesNotHave) {
  Memory memory(false);
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), true));
  for (const std::uint8_t mode : {0, 3, 6, 8, 0xff}) Write(memory, 0xa600fe, mode);
  EXPECT_EQ(memory.motion_plus_mode(), 0);
  EXPECT_FALSE(memory.has_extension());  // Inactive, it does not show in the port.
  EXPECT_EQ(IdentityAt(memory, 0xa60000)[0], 0x01);
}

TEST(Memory, AnActiveMotionPlusKeepsACopyOfTheNunchuksBlock) {
  Memory memory(false);
  const NunchukBlock block = DrawNunchukBlock(8);
  memory.SetExtension(NunchukPage(block));
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), false));
  Write(memory, 0xa600fe, 5);
  NunchukBlock copy{};
  EXPECT_EQ(memory.Read(true, 0xa40040, copy), kMemoryOk);
  EXPECT_EQ(copy, block);
}

TEST(Memory, APortThatIsNotReadyAnswersNothing) {
  Memory memory(true);
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), false));
  memory.set_port_ready(false);
  EXPECT_FALSE(memory.has_extension());
  EXPECT_EQ(Write(memory, 0xa400f0, 0x55), kMemoryAbsent);
  EXPECT_EQ(Write(memory, 0xa600fe, 4), kMemoryAbsent);
  memory.set_port_ready(true);
  EXPECT_TRUE(memory.has_extension());
}

TEST(Memory, CalibrationsAndIdentitiesCannotBeOverwritten) {
  Memory memory(false);
  memory.SetExtension(NunchukPage(DrawNunchukBlock(1)));
  Key(memory);
  const auto before = IdentityAt(memory, 0xa40000);
  Write(memory, 0xa400fa, 0x77);
  EXPECT_EQ(memory.Write(true, 0xa40020, {{1, 2, 3}}), kMemoryOk);
  EXPECT_EQ(IdentityAt(memory, 0xa40000), before);
  NunchukBlock block{};
  EXPECT_EQ(memory.Read(true, 0xa40020, block), kMemoryOk);
  EXPECT_EQ(block, DrawNunchukBlock(1));
}

}  // namespace
}  // namespace footing::virtual_devices

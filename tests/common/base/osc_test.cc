#include "common/base/osc.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::osc {
namespace {

using std::string_literals::operator""s;

Result<void> Try(const std::string& bytes) {
  Packet packet;
  return Read(AsBytes(bytes), packet);
}

std::string Why(const std::string& bytes) {
  const auto read = Try(bytes);
  return read ? "" : read.error().message;
}

TEST(Osc, WritesTheExamplesOfTheSpecification) {
  // opensoundcontrol.org/spec-1_0-examples: the two messages there, byte for byte.
  const Argument one[] = {440.0f};
  EXPECT_EQ(WriteMessage("/oscillator/4/frequency", one),
            "/oscillator/4/frequency\0,f\0\0\x43\xdc\0\0"s);
  const Argument two[] = {std::int32_t{1000}, std::int32_t{-1}, std::string_view("hello"), 1.234f,
                          5.678f};
  EXPECT_EQ(WriteMessage("/foo", two),
            "/foo\0\0\0\0,iisff\0\0\0\0\x03\xe8\xff\xff\xff\xffhello\0\0\0\x3f\x9d\xf3\xb6\x40\xb5"
            "\xb2\x2d"s);
}

TEST(Osc, ReadsWhatItWroteInEveryType) {
  const std::uint8_t blob[] = {1, 2, 3, 4, 5};
  const Argument all[] = {std::int32_t{-7},
                          std::int64_t{1} << 40,
                          0.1f,
                          1e-300,
                          true,
                          false,
                          std::string_view("abc"),
                          Bytes(blob),
                          TimeTag{0x1234567890ABCDEF},
                          Nil{},
                          Impulse{}};
  const std::string inner[] = {WriteMessage("/a", all), WriteMessage("/b", {})};
  const std::string outer[] = {WriteMessage("/first", {}), WriteBundle({99}, inner)};
  const std::string bytes = WriteBundle({77}, outer);
  Packet packet;
  ASSERT_TRUE(Read(AsBytes(bytes), packet));
  ASSERT_EQ(packet.messages.size(), 3u);
  EXPECT_EQ(packet.messages[0].address, "/first");
  EXPECT_EQ(packet.messages[0].time, TimeTag{77});
  EXPECT_EQ(packet.messages[1].time, TimeTag{99});
  EXPECT_EQ(packet.messages[1].types, "ihfdTFsbtNI");
  const auto arguments = packet.Of(packet.messages[1]);
  ASSERT_EQ(arguments.size(), std::size(all));
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (i == 7) {
      const Bytes read = std::get<Bytes>(arguments[i]);
      EXPECT_TRUE(std::equal(read.begin(), read.end(), std::begin(blob), std::end(blob)));
    } else {
      EXPECT_EQ(arguments[i].index(), all[i].index()) << i;
    }
  }
  EXPECT_EQ(std::get<std::int64_t>(arguments[1]), std::int64_t{1} << 40);
  EXPECT_EQ(std::get<double>(arguments[3]), 1e-300);
  EXPECT_TRUE(std::get<bool>(arguments[4]));
  EXPECT_FALSE(std::get<bool>(arguments[5]));
  EXPECT_EQ(std::get<std::string_view>(arguments[6]), "abc");
  EXPECT_EQ(std::get<TimeTag>(arguments[8]).ntp, 0x1234567890ABCDEFu);
  EXPECT_EQ(packet.messages[2].types, "");
}

TEST(Osc, RejectsWhatItCannotReadAndSaysWhy) {
  EXPECT_EQ(Why(""), "OSC packet is empty");
  EXPECT_NE(Why("/ab\0,i\0"s).find("multiple of 4"), std::string::npos);
  EXPECT_NE(Why("abc\0,\0\0\0"s).find("neither"), std::string::npos);
  EXPECT_NE(Why("/abc"s).find("no end"), std::string::npos);
  EXPECT_NE(Why("/abc\0\0\0\0"s).find("no type tags"), std::string::npos);
  EXPECT_NE(Why("/a\0x,\0\0\0"s).find("padding byte"), std::string::npos);
  EXPECT_NE(Why("/a\0\0,r\0\0\0\0\0\0"s).find("type tag"), std::string::npos);
  EXPECT_NE(Why("/a\0\0,i\0\0"s).find("ends before its arguments"), std::string::npos);
  EXPECT_NE(Why("/a\0\0,\0\0\0\0\0\0\0"s).find("longer than its arguments"), std::string::npos);
  EXPECT_NE(Why("/a\0\0,b\0\0\xff\xff\xff\xff"s).find("a blob reaches beyond"), std::string::npos);
  EXPECT_NE(Why("/\xff\0\0,\0\0\0"s).find("not printable"), std::string::npos);
  EXPECT_NE(Why("#bundle\0\0\0\0\0"s).find("before its time tag"), std::string::npos);
  const std::string head = "#bundle\0\0\0\0\0\0\0\0\1"s;
  EXPECT_EQ(Why(head), "");
  EXPECT_NE(Why(head + "\0\0\0\x08/a\0\0"s).find("beyond its bundle"), std::string::npos);
  EXPECT_NE(Why(head + "\0\0\0\0"s).find("an element is empty"), std::string::npos);
  EXPECT_NE(Why(head + "\0\0\0\x06/a\0\0,\0\0\0"s).find("multiple of 4"), std::string::npos);
}

TEST(Osc, HoldsItsLimits) {
  const std::string message = WriteMessage("/a", {});
  EXPECT_EQ(Why(WriteBundle({}, std::vector<std::string>(kMostMessages, message))), "");
  EXPECT_NE(Why(WriteBundle({}, std::vector<std::string>(kMostMessages + 1, message))), "");
  EXPECT_EQ(Why(WriteMessage("/a", std::vector<Argument>(kMostArguments, Nil{}))), "");
  EXPECT_NE(Why(WriteMessage("/a", std::vector<Argument>(kMostArguments + 1, Nil{}))), "");
  EXPECT_EQ(Why(WriteMessage("/" + std::string(kMostAddressBytes - 1, 'a'), {})), "");
  EXPECT_NE(Why(WriteMessage("/" + std::string(kMostAddressBytes, 'a'), {})), "");
  std::string nested = message;
  for (int i = 0; i < kDeepestBundle; ++i) nested = WriteBundle({}, {&nested, 1});
  EXPECT_EQ(Why(nested), "");
  EXPECT_NE(Why(WriteBundle({}, {&nested, 1})), "");
  EXPECT_NE(Why(std::string(kMostPacketBytes + 1, '\0')), "");
}

TEST(Osc, LeavesNothingOfAPacketThatItRejects) {
  Packet packet;
  const std::string elements[] = {WriteMessage("/a", {}), "/b\0\0"s};
  EXPECT_FALSE(Read(AsBytes(WriteBundle({}, elements)), packet));
  EXPECT_TRUE(packet.messages.empty());
  EXPECT_TRUE(packet.arguments.empty());
}

TEST(Osc, ConvertsNtpTimeAcrossItsEras) {
  // 1970 is 2 208 988 800 s after 1900 (RFC 868).
  EXPECT_EQ(ToTimeTag(0).ntp, 2'208'988'800ull << 32);
  EXPECT_EQ(ToTimeTag(500'000'000).ntp & 0xFFFF'FFFF, 1ull << 31);
  for (const std::int64_t ns :
       {std::int64_t{0}, std::int64_t{1}, std::int64_t{1'790'000'000'123'456'789},
        std::int64_t{2'085'978'496'000'000'001},  // The first ns of 2036's era.
        std::int64_t{3'000'000'000'999'999'999}})
    EXPECT_EQ(ToUnixNs(ToTimeTag(ns)), ns);
  EXPECT_TRUE(TimeTag{}.immediate());
  // The last part of the last second, in 2104: the next second would be in 1968.
  const std::int64_t last_ns = ToUnixNs({0x7FFF'FFFF'FFFF'FFFF});
  EXPECT_EQ(last_ns % 1'000'000'000, 999'999'999);
  EXPECT_EQ(ToUnixNs(ToTimeTag(last_ns)), last_ns);
}

}  // namespace
}  // namespace footing::osc

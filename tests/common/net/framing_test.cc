#include "common/net/framing.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::transport {
namespace {

/// What comes out when `bytes` are fed in pieces of `piece` bytes.
struct Outcome {
  std::vector<std::string> frames;
  bool ok = true;
  std::size_t pending = 0;
};

Outcome FeedInPieces(const std::string& bytes, std::size_t piece, std::uint32_t max = 100) {
  FrameSplitter splitter(max);
  Outcome outcome;
  for (std::size_t at = 0; at < bytes.size() && outcome.ok; at += piece) {
    outcome.ok = splitter
                     .Feed(std::string_view(bytes).substr(at, piece),
                           [&](std::string_view frame) {
                             outcome.frames.emplace_back(frame);
                             return true;
                           })
                     .ok();
  }
  outcome.pending = splitter.pending_bytes();
  return outcome;
}

TEST(Framing, TheLengthIsLittleEndian) {
  EXPECT_EQ(Frame("abc"), std::string("\x03\x00\x00\x00"
                                      "abc",
                                      7));
  EXPECT_EQ(DecodeLength("\x78\x56\x34\x12"), 0x12345678u);
  EXPECT_EQ(DecodeLength(EncodeLength(0xfedcba98u).data()), 0xfedcba98u);
}

TEST(Framing, FramesComeOutWholeHoweverTheBytesAreCut) {
  const std::string bytes = Frame("one") + Frame("") + Frame(std::string(100, 'x')) + Frame("four");
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    const Outcome outcome = FeedInPieces(bytes, piece);
    EXPECT_TRUE(outcome.ok);
    EXPECT_EQ(outcome.frames, (std::vector<std::string>{"one", "", std::string(100, 'x'), "four"}))
        << "pieces of " << piece;
    EXPECT_EQ(outcome.pending, 0u);
  }
}

TEST(Framing, ALengthOverTheLimitIsRefusedAtItsFourthByte) {
  const auto length = EncodeLength(101);
  const std::string bytes(length.begin(), length.end());
  for (std::size_t piece = 1; piece <= 4; ++piece) {
    EXPECT_FALSE(FeedInPieces(bytes, piece).ok);
  }
  EXPECT_TRUE(FeedInPieces(bytes.substr(0, 3), 1).ok);
  EXPECT_FALSE(FeedInPieces(Frame("fine") + bytes, 1000).ok);
}

TEST(Framing, AnIncompleteFrameKeepsNoMoreThanHasArrived) {
  FrameSplitter splitter(1u << 30);
  const auto length = EncodeLength(1u << 30);
  const auto never = [](std::string_view) { return false; };
  ASSERT_TRUE(splitter.Feed(std::string_view(length.data(), length.size()), never).ok());
  ASSERT_TRUE(splitter.Feed("abc", never).ok());
  EXPECT_EQ(splitter.pending_bytes(), 7u);
}

TEST(Framing, AReceiverThatStopsGetsNoFurtherFrame) {
  FrameSplitter splitter(100);
  int frames = 0;
  ASSERT_TRUE(splitter
                  .Feed(Frame("a") + Frame("b"),
                        [&](std::string_view) {
                          ++frames;
                          return false;
                        })
                  .ok());
  EXPECT_EQ(frames, 1);
}

}  // namespace
}  // namespace footing::transport

#include "common/net/tls_channel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace footing::tls {
namespace {

using Verdict = FirstBytes::Verdict;

Verdict VerdictOf(std::string bytes) {
  FirstBytes first;
  bytes.resize(std::min(bytes.size(), first.missing()));
  std::copy(bytes.begin(), bytes.end(), first.next());
  first.Add(bytes.size());
  return first.Check();
}

/// Record header (22, 3, 1, length), handshake header (1, length of three bytes).
std::string ClientHello(unsigned record, unsigned message) {
  const auto byte = [](unsigned value) { return static_cast<char>(value & 0xffu); };
  return {22,
          3,
          1,
          byte(record >> 8),
          byte(record),
          1,
          byte(message >> 16),
          byte(message >> 8),
          byte(message)};
}

TEST(FirstBytes, AClientHelloIsTls) {
  EXPECT_EQ(VerdictOf(ClientHello(260, 256)), Verdict::kTls);
  EXPECT_EQ(VerdictOf(ClientHello(1 << 14, 16 << 10)), Verdict::kTls);
}

TEST(FirstBytes, NothingIsDecidedBeforeItMust) {
  const std::string hello = ClientHello(260, 256);
  for (std::size_t size = 0; size < hello.size(); ++size) {
    EXPECT_EQ(VerdictOf(hello.substr(0, size)), Verdict::kMore) << size;
  }
}

TEST(FirstBytes, AFrameOfOursIsNotTlsWhateverItsLength) {
  for (unsigned length = 0; length <= 1u << 16; ++length) {
    std::string frame{static_cast<char>(length & 0xffu), static_cast<char>(length >> 8 & 0xffu),
                      static_cast<char>(length >> 16), 0};
    frame += "\x0a\x0c\x08\x01\x18";
    if (length == (22u | 3u << 8 | 1u << 16)) continue;  // 66 326: over the limit.
    ASSERT_EQ(VerdictOf(frame), Verdict::kNotTls) << length;
  }
  EXPECT_EQ(VerdictOf("GET / HTTP/1.1\r\n"), Verdict::kNotTls);
}

TEST(FirstBytes, ALongMessageIsRefusedBeforeItComes) {
  EXPECT_EQ(VerdictOf(ClientHello(1 << 14, (16 << 10) + 1)), Verdict::kTooLong);
  EXPECT_EQ(VerdictOf(ClientHello(1 << 14, 0xffffff)), Verdict::kTooLong);
  EXPECT_EQ(VerdictOf(ClientHello(3, 256)), Verdict::kTooLong) << "its length is in the next one";
}

}  // namespace
}  // namespace footing::tls

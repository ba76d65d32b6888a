#include <algorithm>
#include <string>
#include <string_view>

#include "common/net/framing.h"
#include "common/net/tls_channel.h"
#include "tests/fuzz/input.h"
#include "tests/fuzz/pieces.h"

/// A stream of bytes cut into frames: in pieces of any length, stopped behind any frame, it comes
/// to the same frames as at once. Its beginning is looked at as that of TLS, too.
namespace footing::fuzz {
namespace {

constexpr std::uint32_t kMost = 300;

Decoded AtOnce(std::string_view bytes) {
  Decoded cut;
  transport::FrameSplitter splitter(kMost);
  const auto fed = splitter.Feed(bytes, [&](std::string_view frame) {
    cut.messages.emplace_back(frame);
    return true;
  });
  cut.refused = !fed.ok();
  if (fed) Expect(*fed == bytes.size() && splitter.pending_bytes() < 4 + kMost);
  return cut;
}

Decoded InPieces(std::string_view bytes, Input pieces) {
  Decoded cut;
  transport::FrameSplitter splitter(kMost);
  while (!bytes.empty()) {
    const std::uint8_t how = pieces.Byte();
    const std::string_view piece = bytes.substr(0, 1 + how / 2);
    const auto fed = splitter.Feed(piece, [&](std::string_view frame) {
      cut.messages.emplace_back(frame);
      return (how & 1) == 0;
    });
    if (!fed) {
      cut.refused = true;
      break;
    }
    Expect(*fed > 0 && *fed <= piece.size() && splitter.pending_bytes() < 4 + kMost);
    bytes.remove_prefix(*fed);
  }
  return cut;
}

void CheckFirstBytes(std::string_view bytes) {
  using Verdict = tls::FirstBytes::Verdict;
  tls::FirstBytes first;
  for (const char byte : bytes.substr(0, tls::FirstBytes::kSize)) {
    Expect(first.missing() > 0);
    *first.next() = byte;
    first.Add(1);
    if (first.Check() != Verdict::kMore) break;
  }
  if (bytes.size() >= tls::FirstBytes::kSize) Expect(first.Check() != Verdict::kMore);
}

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  const auto [bytes, whole] = fuzz::CheckPieces(data, size, fuzz::AtOnce, fuzz::InPieces);
  std::string again;
  for (const std::string& frame : whole.messages) again += transport::Frame(frame);
  fuzz::Expect(bytes.substr(0, again.size()) == again);
  fuzz::CheckFirstBytes(bytes);
  return 0;
}

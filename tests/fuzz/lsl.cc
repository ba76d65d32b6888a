#include "clients/log/lsl.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/input.h"

namespace {

using namespace footing;  // NOLINT: a fuzz target is one file
namespace lsl = log_client::lsl;

/// A stream of any format whose feed begins as it should, so that the fuzzer reaches its samples.
lsl::Info InfoOf(std::uint8_t byte) {
  lsl::Info info;
  info.name = "name";
  info.uid = "uid";
  info.format = static_cast<lsl::Format>(byte % 7);
  info.channels = 1 + byte / 7 % 5;
  return info;
}

/// In pieces a feed comes to the same samples as the whole.
void CheckFeed(const lsl::Info& info, std::string_view bytes, std::size_t piece) {
  lsl::FeedReader whole(info), in_pieces(info);
  std::vector<lsl::Sample> samples, again;
  const bool good = whole.Take(bytes, samples).ok();
  bool good_again = true;
  for (std::size_t at = 0; at < bytes.size() && good_again; at += piece)
    good_again = in_pieces.Take(bytes.substr(at, piece), again).ok();
  fuzz::Expect(good == good_again && samples.size() == again.size());
  for (const lsl::Sample& sample : samples) {
    fuzz::Expect(!sample.time_s || std::isfinite(*sample.time_s));
    fuzz::Expect(sample.values.size() + sample.texts.size() == info.channels);
  }
}

}  // namespace

// The first two bytes choose a stream and what comes: a query, a datagram, a request, a description
// or a feed.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const lsl::Info info = InfoOf(input.Byte());
  const std::uint8_t kind = input.Byte();
  const fuzz::Bytes rest = input.Rest();
  const std::string text(rest.begin(), rest.end());
  switch (kind % 6) {
    case 0:
      fuzz::Expect(lsl::CheckQuery(text).ok() || text.empty() || !lsl::Matches(info, text) ||
                   text.find_first_not_of(" \t\r\n\v\f") == std::string::npos);
      break;
    case 1:
      if (const auto request = lsl::ParseShortInfoRequest(text))
        fuzz::Expect(lsl::ParseShortInfoRequest(lsl::Encode(*request)).has_value());
      if (const auto exchange = lsl::ParseTimeRequest(text))
        fuzz::Expect(lsl::ParseTimeAnswer(lsl::EncodeTimeAnswer(*exchange)).has_value());
      if (const auto exchange = lsl::ParseTimeAnswer(text))
        fuzz::Expect(lsl::ParseTimeRequest(lsl::EncodeTimeRequest(*exchange)).has_value());
      break;
    case 2: {
      const lsl::Request request = lsl::ParseRequest(text, info);
      fuzz::Expect((request.kind == lsl::Request::Kind::kRefused) == !request.refusal.empty());
      break;
    }
    case 3:
      if (const auto read = lsl::ParseInfo(text)) {
        const auto again = lsl::ParseInfo(lsl::FullInfo(*read));
        fuzz::Expect(again.ok() && lsl::FullInfo(*again) == lsl::FullInfo(*read));
      }
      break;
    case 4:
      CheckFeed(info, text, 1 + kind / 6);
      break;
    case 5:
      CheckFeed(info, lsl::FeedStart(info) + text, 1 + kind / 6);
      break;
  }
  return 0;
}

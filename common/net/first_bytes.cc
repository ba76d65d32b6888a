#include "common/net/first_bytes.h"

namespace footing::tls {
namespace {

// RFC 8446, 5.1 and 4: a record is type, version (3, 1 to 3), length; a handshake message type and
// length of three bytes, the highest first.
constexpr unsigned kHandshakeRecord = 22;
constexpr unsigned kMajorVersion = 3;
constexpr unsigned kClientHello = 1;
constexpr std::size_t kHandshakeHeaderBytes = 4;

}  // namespace

FirstBytes::Verdict FirstBytes::Check() const {
  const auto at = [this](std::size_t i) { return static_cast<unsigned char>(bytes_[i]); };
  if (size_ > 0 && at(0) != kHandshakeRecord) return Verdict::kNotTls;
  if (size_ > 1 && at(1) != kMajorVersion) return Verdict::kNotTls;
  // In a frame of ours this is the third byte of a length that is accepted: 0.
  if (size_ > 2 && at(2) == 0) return Verdict::kNotTls;
  if (size_ < kSize) return Verdict::kMore;
  const std::size_t record = (std::size_t{at(3)} << 8) | at(4);
  const std::size_t message =
      (std::size_t{at(6)} << 16) | (std::size_t{at(7)} << 8) | std::size_t{at(8)};
  if (record < kHandshakeHeaderBytes) return Verdict::kTooLong;
  if (at(5) != kClientHello) return Verdict::kNotTls;
  return message > kLongestClientHello ? Verdict::kTooLong : Verdict::kTls;
}

}  // namespace footing::tls

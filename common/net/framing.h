#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "common/base/result.h"

/// How messages are cut out of a byte stream: u32 little-endian length, then that many bytes.
namespace footing::transport {

inline constexpr std::size_t kLengthBytes = 4;

std::array<char, kLengthBytes> EncodeLength(std::uint32_t length);
std::uint32_t DecodeLength(const char* bytes);

/// One frame: length and payload in one string. The payload is shorter than 4 GiB.
std::string Frame(std::string_view payload);

/// Cuts frames out of the bytes as they arrive.
///
/// A declared length over the limit is refused as soon as its four bytes are there: nothing is
/// allocated for it. What is kept between calls is at most one incomplete frame, and never more
/// than has arrived.
class FrameSplitter {
 public:
  explicit FrameSplitter(std::uint32_t max_payload_bytes) : max_(max_payload_bytes) {}

  /// Calls `on_frame` for every complete frame, in order; it returns false to stop behind that
  /// frame. The view is valid during the call only. Returns how many bytes were taken: all of them
  /// unless it was stopped; the rest may be fed again. InvalidData for a length over the limit;
  /// nothing may be fed after that.
  Result<std::size_t> Feed(std::string_view bytes,
                           const std::function<bool(std::string_view)>& on_frame);

  /// Bytes of a frame that has begun and is not complete.
  std::size_t pending_bytes() const { return pending_.size(); }

 private:
  std::size_t Missing() const;
  Result<void> CheckLength(std::string_view frame) const;

  std::uint32_t max_;
  std::string pending_;
};

}  // namespace footing::transport

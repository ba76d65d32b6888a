#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace footing::crowd {

/// Fields of a tick that a viewer must know.
struct TickHead {
  std::uint64_t sequence = 0;
  std::int64_t host_ns = 0;
  bool live = true;  ///< Neither a snapshot nor out of the ring.
};

enum class FrameKind { kTick, kGap, kPing, kEnd, kOther };

/// One frame's payload. `tick` is set for a tick alone; nothing else is parsed of it.
FrameKind Look(std::string_view payload, TickHead& tick);

/// The frames of one connection, put together of the pieces in which they come.
class FrameReader {
 public:
  /// Calls `on_frame` with each payload that is complete.
  template <typename OnFrame>
  void Take(std::string_view bytes, OnFrame on_frame) {
    if (!rest_.empty()) {
      rest_.append(bytes);
      bytes = rest_;
    }
    while (bytes.size() >= 4) {
      const std::size_t size = Length(bytes);
      if (bytes.size() < 4 + size) break;
      on_frame(bytes.substr(4, size));
      bytes.remove_prefix(4 + size);
    }
    rest_ = std::string(bytes);
  }

 private:
  static std::size_t Length(std::string_view bytes) {
    std::size_t length = 0;
    for (int i = 3; i >= 0; --i) {
      length = length << 8 | static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
    }
    return length;
  }

  std::string rest_;
};

}  // namespace footing::crowd

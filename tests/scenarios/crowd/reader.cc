#include "tests/scenarios/crowd/reader.h"

namespace footing::crowd {
namespace {

std::uint64_t TakeVarint(std::string_view& bytes) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64 && !bytes.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.front());
    bytes.remove_prefix(1);
    value |= std::uint64_t{byte & 0x7fu} << shift;
    if (byte < 0x80) break;
  }
  return value;
}

constexpr std::uint64_t Tag(std::uint64_t field, std::uint64_t wire_type) {
  return field << 3 | wire_type;
}

}  // namespace

FrameKind Look(std::string_view payload, TickHead& tick) {
  const std::uint64_t tag = TakeVarint(payload);
  if (tag == Tag(17, 2)) return FrameKind::kGap;
  if (tag == Tag(6, 2)) return FrameKind::kPing;
  if (tag == Tag(3, 2) || tag == Tag(10, 2)) return FrameKind::kEnd;
  if (tag != Tag(16, 2)) return FrameKind::kOther;
  TakeVarint(payload);  // Its length.
  while (!payload.empty()) {
    const std::uint64_t field = TakeVarint(payload);
    if ((field & 7) != 0 || field > Tag(5, 0)) break;  // The channels.
    const std::uint64_t value = TakeVarint(payload);
    if (field == Tag(2, 0)) tick.sequence = value;
    if (field == Tag(3, 0)) tick.host_ns = static_cast<std::int64_t>(value);
    if (field == Tag(4, 0) || field == Tag(5, 0)) tick.live = false;
  }
  return FrameKind::kTick;
}

}  // namespace footing::crowd

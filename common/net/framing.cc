#include "common/net/framing.h"

#include <algorithm>

namespace footing::transport {

std::array<char, kLengthBytes> EncodeLength(std::uint32_t length) {
  return {static_cast<char>(length & 0xff), static_cast<char>((length >> 8) & 0xff),
          static_cast<char>((length >> 16) & 0xff), static_cast<char>((length >> 24) & 0xff)};
}

std::uint32_t DecodeLength(const char* bytes) {
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) {
    length |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  }
  return length;
}

std::string Frame(std::string_view payload) {
  const auto length = EncodeLength(static_cast<std::uint32_t>(payload.size()));
  std::string frame;
  frame.reserve(kLengthBytes + payload.size());
  frame.append(length.data(), length.size());
  frame.append(payload);
  return frame;
}

Result<void> FrameSplitter::CheckLength(std::string_view frame) const {
  const std::uint32_t length = DecodeLength(frame.data());
  if (length <= max_) return {};
  return InvalidData(
      "a message of " + std::to_string(length) + " bytes was announced, at most " +
      std::to_string(max_) +
      " are accepted; a message begins with its length as four bytes, little-endian: "
      "is the other side speaking Footing's protocol?");
}

std::size_t FrameSplitter::Missing() const {
  if (pending_.size() < kLengthBytes) return kLengthBytes - pending_.size();
  return kLengthBytes + DecodeLength(pending_.data()) - pending_.size();
}

Result<std::size_t> FrameSplitter::Feed(std::string_view bytes,
                                        const std::function<bool(std::string_view)>& on_frame) {
  const std::size_t offered = bytes.size();
  while (!pending_.empty()) {
    const std::size_t taken = std::min(Missing(), bytes.size());
    pending_.append(bytes.substr(0, taken));
    bytes.remove_prefix(taken);
    if (pending_.size() < kLengthBytes) return offered;
    if (auto checked = CheckLength(pending_); !checked) return checked.error();
    if (Missing() > 0) {
      if (bytes.empty()) return offered;
      continue;
    }
    const std::string frame = std::move(pending_);
    pending_.clear();
    if (!on_frame(std::string_view(frame).substr(kLengthBytes))) return offered - bytes.size();
  }
  while (bytes.size() >= kLengthBytes) {
    if (auto checked = CheckLength(bytes); !checked) return checked.error();
    const std::size_t whole = kLengthBytes + DecodeLength(bytes.data());
    if (bytes.size() < whole) break;
    const std::string_view frame = bytes.substr(kLengthBytes, whole - kLengthBytes);
    bytes.remove_prefix(whole);
    if (!on_frame(frame)) return offered - bytes.size();
  }
  pending_.assign(bytes);
  return offered;
}

}  // namespace footing::transport

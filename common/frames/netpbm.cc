#include "common/frames/netpbm.h"

#include <array>
#include <charconv>

namespace footing::frames {
namespace {

constexpr std::size_t kMostHeaderBytes = 4096;
constexpr std::string_view kTime = " time_ns ";

struct Header {
  bool is_colour = false;
  std::array<int, 3> numbers{};  // Width, height, largest value.
  std::optional<std::int64_t> time_ns;
  std::size_t bytes = 0;
};

bool IsBlank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// A whole header at the start of the text; nothing when it is not all there.
Result<std::optional<Header>> ReadHeader(std::string_view text) {
  const Error no_image = InvalidData("frame: not a binary PGM or PPM image (P5 or P6, 8 bits)");
  if (text.size() < 2) return std::optional<Header>();
  if (text[0] != 'P' || (text[1] != '5' && text[1] != '6')) return no_image;
  Header header;
  header.is_colour = text[1] == '6';
  std::size_t at = 2, count = 0;
  while (count < 3) {
    while (at < text.size() && IsBlank(text[at])) ++at;
    if (at < text.size() && text[at] == '#') {
      const std::size_t end = text.find('\n', at);
      if (end == std::string_view::npos) break;
      const std::string_view comment = text.substr(at + 1, end - at - 1);
      std::int64_t time_ns = 0;
      if (comment.starts_with(kTime) &&
          std::from_chars(comment.data() + kTime.size(), comment.data() + comment.size(), time_ns)
                  .ec == std::errc())
        header.time_ns = time_ns;
      at = end + 1;
      continue;
    }
    const char* end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data() + at, end, header.numbers[count]);
    if (next == end) break;
    if (error != std::errc() || !IsBlank(*next)) return no_image;
    at = static_cast<std::size_t>(next - text.data());
    ++count;
  }
  if (count < 3) {
    if (text.size() > kMostHeaderBytes) return no_image;
    return std::optional<Header>();
  }
  header.bytes = at + 1;
  for (std::size_t i = 0; i < 2; ++i) {
    const int size = header.numbers[i];
    if (size < 32 || size > 4096 || size % 2 != 0)
      return InvalidData("frame: sizes must be even, from 32 to 4096, not " + std::to_string(size));
  }
  if (header.numbers[2] != 255) return InvalidData("frame: the largest value must be 255");
  return std::optional<Header>(header);
}

}  // namespace

Result<std::optional<Frame>> NetpbmReader::Next() {
  // Images of a FIFO may be parted by line ends.
  const std::size_t first = pending_.find_first_not_of("\n\r");
  pending_.erase(0, first == std::string::npos ? pending_.size() : first);
  const auto header = ReadHeader(pending_);
  if (!header) return header.error();
  if (!*header) return std::optional<Frame>();
  const Header& head = **header;
  Frame frame;
  frame.width = head.numbers[0];
  frame.height = head.numbers[1];
  frame.time_ns = head.time_ns;
  const auto pixels =
      static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  const std::size_t size = pixels * (head.is_colour ? 3 : 1);
  if (pending_.size() < head.bytes + size) return std::optional<Frame>();
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(pending_.data() + head.bytes);
  if (!head.is_colour) {
    frame.bytes.assign(bytes, bytes + pixels);
  } else {
    frame.bytes.reserve(pixels);
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u, bytes += 3)
        frame.bytes.push_back(bytes[frame.View().Channel(u, v)]);
    }
  }
  pending_.erase(0, head.bytes + size);
  return std::optional<Frame>(std::move(frame));
}

std::string ToPgm(const Frame& frame) {
  std::string text = "P5\n";
  if (frame.time_ns) text += "#" + std::string(kTime) + std::to_string(*frame.time_ns) + "\n";
  text += std::to_string(frame.width) + " " + std::to_string(frame.height) + "\n255\n";
  return text.append(frame.bytes.begin(), frame.bytes.end());
}

}  // namespace footing::frames

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/camera/preview.h"
#include "common/base/result.h"

namespace footing::preview {

/// Why there are no pictures.
struct Refusal {
  std::string why;
};
using Message = std::variant<Picture, Refusal>;

/// Messages out of a stream of bytes. It holds one message at most, of a length within the limits;
/// every number in it is checked.
class PreviewReader {
 public:
  void Add(std::string_view bytes) { pending_.append(bytes); }
  /// The next whole message; nothing when more bytes are needed; an error when they hold none,
  /// after which the reader is of no more use.
  Result<std::optional<Message>> Next();

 private:
  std::string pending_;
};

// The layout, for both directions (docs/camera.md).
enum class Kind : std::uint32_t { kPicture = 1, kRefusal = 2 };
inline constexpr std::string_view kMagic = "FCP1";
inline constexpr std::size_t kFixedBytes = 28, kSphereBytes = 24, kRefusedBytes = 16;
inline constexpr unsigned kHasPose = 1, kSimulated = 2;
inline constexpr unsigned kSaturated = 1, kOccluded = 2;
inline constexpr std::size_t kMaxBodyBytes = kFixedBytes + kSphereBytes * kMaxSpheres +
                                             kRefusedBytes * kMaxRefused +
                                             std::size_t{3} * kMaxSide * kMaxSide;

}  // namespace footing::preview

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/frames/frame.h"
#include "common/base/result.h"

namespace footing::frames {

/// Reads PGM (P5: a mosaic G R / B G) and PPM (P6: of its colours those are taken that a mosaic
/// has), one image after the other as a FIFO delivers them. A comment "# time_ns N" in the header
/// is the time of exposure. Sizes: even, 32 to 4096; 8 bits.
class NetpbmReader {
 public:
  void Add(std::string_view bytes) { pending_.append(bytes); }
  /// The next whole image; nothing when more bytes are needed; an error when they hold no image,
  /// after which the reader is of no more use.
  Result<std::optional<Frame>> Next();
  bool empty() const { return pending_.empty(); }

 private:
  std::string pending_;
};

/// A mosaic as a PGM, with its time where it has one.
std::string ToPgm(const Frame& frame);

}  // namespace footing::frames

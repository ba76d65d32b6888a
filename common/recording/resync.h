#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace footing::mcap {

/// Finds the way on behind bytes that are lost or overwritten, where lengths lead astray: a whole
/// chunk is known by its form and its CRC.
class Resync {
 public:
  explicit Resync(std::string_view file);

  /// Where the next whole chunk begins, if no record can stand at `offset`. Behind a damaged chunk
  /// that begins at `suspect` it may begin before the end that that one claims. CRCs of no more
  /// bytes than eight times the file's are computed in all.
  std::optional<std::uint64_t> WayOn(std::uint64_t offset, std::optional<std::uint64_t> suspect);

 private:
  bool CanBeRecord(std::uint64_t offset) const;
  /// Whether a record that can be decoded, of the kinds that stand behind a chunk, begins there.
  bool IsRecord(std::uint64_t offset) const;
  std::optional<std::uint64_t> NextChunk(std::uint64_t from);

  std::string_view file_;
  std::uint64_t budget_;
};

}  // namespace footing::mcap

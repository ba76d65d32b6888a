#include "common/recording/checks.h"

#include <optional>

#include "common/recording/crc.h"
#include "common/recording/decode.h"

namespace footing::mcap {

std::string ProblemOf(const std::optional<Chunk>& chunk) {
  if (!chunk) return "a damaged chunk";
  if (!chunk->compression.empty()) {
    return "a chunk compressed by " + chunk->compression + ", which is not read here";
  }
  if (chunk->uncompressed_size != chunk->records.size()) return "a chunk whose two sizes differ";
  const bool wrong =
      chunk->uncompressed_crc != 0 && chunk->uncompressed_crc != Crc32(0, chunk->records);
  return wrong ? "a chunk whose CRC is wrong" : "";
}

Closing CheckDataEnd(std::string_view file, std::string_view body, std::uint64_t offset) {
  Cursor in(body);
  const std::uint32_t crc = in.U32();
  if (!in.ok()) return {"a damaged end of the data", ""};
  const bool wrong = crc != 0 && crc != Crc32(0, file.substr(0, offset));
  return {"", wrong ? "the CRC of the data is wrong" : ""};
}

Closing CheckFooter(std::string_view file, std::string_view body, std::uint64_t offset,
                    bool data_ended) {
  const std::optional<Footer> footer = DecodeFooter(body);
  if (!footer || footer->summary_start > offset) return {"a damaged footer", ""};
  if (!data_ended) return {"", "the mark at the end of the data is missing"};
  if (footer->summary_crc == 0) return {};
  // From the summary's start, or from the footer when there is none, to before the CRC.
  const std::uint64_t start = footer->summary_start == 0 ? offset : footer->summary_start;
  const std::uint64_t stop = offset + kRecordHeadBytes + 16;
  const bool wrong = footer->summary_crc != Crc32(0, file.substr(start, stop - start));
  return {"", wrong ? "the CRC of the summary is wrong" : ""};
}

}  // namespace footing::mcap

#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/recording/mcap_records.h"

namespace footing::mcap {

/// Called for each record, in the order of the file. Empty ones are left out.
struct Visitor {
  std::function<void(const Header&)> header;
  std::function<void(const Schema&)> schema;    ///< Once an id.
  std::function<void(const Channel&)> channel;  ///< Once an id, after its schema.
  std::function<void(const Message&)> message;  ///< After its channel.
  std::function<void(const Attachment&)> attachment;
  std::function<void(const Metadata&)> metadata;
  std::function<void()> damage;  ///< Something is left out here, by its CRC or its form.
  /// Called before a whole chunk's records, as the file has it: perhaps compressed.
  std::function<void(const Chunk&)> chunk = {};
  /// Keeps what was unpacked of compressed chunks, so that the bytes of messages stay valid as long
  /// as it; null: they are valid until the call that shows them returns.
  std::deque<std::string>* unpacked = nullptr;
};

/// Behaviour of a walk at damage.
enum class WalkMode {
  kStrict,   ///< Ends at the first thing wrong.
  kSalvage,  ///< Leaves out what is damaged and takes every complete record of a cut file.
};

/// How a walk ended.
struct WalkEnd {
  bool complete = false;  ///< Closing magic reached, and nothing wrong.
  std::string problem;    ///< The first thing wrong, for a person; empty when nothing is.
  std::uint64_t problem_offset = 0;
  std::uint64_t end_offset = 0;  ///< Behind the last complete record of the outermost level.
  std::uint64_t damaged_chunks = 0;
  std::uint64_t damaged_records = 0;  ///< Left out, not counting those in damaged chunks.
  /// Between records that are lost and the chunk from which the walk went on.
  std::uint64_t skipped_bytes = 0;
  bool cut = false;  ///< The file ends within or before a record it needs.
};

/// Visits everything in the file that `file` holds, from its start, without trusting its index. All
/// lengths, references and CRCs are checked; nothing is allocated by a length read from the file.
WalkEnd Walk(std::string_view file, const Visitor& visitor, WalkMode mode);

/// The index at the end of a complete file.
struct Summary {
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<ChunkIndex> chunks;
  std::vector<AttachmentIndex> attachments;
  std::vector<MetadataIndex> metadata;
  Statistics statistics;
};

/// Reads the index through the footer. InvalidData with the byte offset when the file is cut short,
/// has none, or it is damaged or longer than `most_bytes`.
Result<Summary> ReadSummary(std::string_view file,
                            std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

// Reading a file from any place. What is not read is not touched.

/// Checks one chunk: its CRC, and that every record in it is complete. InvalidData with the byte
/// offset when it is damaged or of an unknown compression.
Result<void> CheckChunk(std::string_view file, const ChunkIndex& index);

/// Visits the messages of one chunk that CheckChunk accepts, in its order; its CRC is not checked
/// again. InvalidData with the byte offset, and no message, when its records are damaged. The bytes
/// of a message are valid until the handler returns.
Result<void> VisitChunk(std::string_view file, const ChunkIndex& index,
                        const std::function<void(const Message&)>& handler);

/// The same for the messages of one channel, found through the chunk's message index. Where the
/// file has no such index or it is wrong, the whole chunk is read.
Result<void> VisitChannel(std::string_view file, const ChunkIndex& index, std::uint16_t channel,
                          const std::function<void(const Message&)>& handler);

/// The index of a file that has none.
struct RebuiltIndex {
  Summary summary;  ///< Index of `chunks`, each with its channels; their offsets are 0.
  std::uint64_t end_offset = 0;  ///< Behind the last complete record.
  std::string problem;           ///< Why the file ends there, or what was left out; empty: nothing.
};

/// Reads every record's head, from the file's start to its end or to the first record that is cut.
/// Damaged chunks and messages outside chunks are left out. InvalidData when the file is not MCAP,
/// has more than `most_chunks` chunks, or its chunks, schemas, channels and metadata would take
/// more than `most_bytes` in an index.
Result<RebuiltIndex> RebuildIndex(
    std::string_view file, std::size_t most_chunks,
    std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max());

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

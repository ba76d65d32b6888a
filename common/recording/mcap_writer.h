#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/recording/mcap_records.h"

namespace footing::mcap {

/// A chunk is closed when either is reached. With both, a recorder that dies loses at most the last
/// second, and a reader that seeks unpacks at most 768 KiB.
struct WriterOptions {
  std::uint64_t chunk_bytes = 768 * 1024;
  std::uint64_t chunk_span_ns = 1'000'000'000;  ///< Log time of one chunk.
  bool compress = false;                        ///< By zstd, chunk by chunk.
};

/// Makes the bytes of an MCAP file: chunked, indexed, with all CRCs. The same calls give the same
/// bytes. Whoever owns the file fetches them with Take() and writes them down.
class Writer {
 public:
  Writer(const Header& header, WriterOptions options);

  /// Ids count from 1. A schema or channel stands in the chunk before its first message and again
  /// in the summary.
  std::uint16_t AddSchema(const std::string& name, const std::string& encoding,
                          const std::string& data);
  std::uint16_t AddChannel(std::uint16_t schema_id, const std::string& topic,
                           const std::string& message_encoding, const TextMap& metadata);
  /// Schemas and channels of another file, under their own ids.
  void CopySchema(const Schema& schema);
  void CopyChannel(const Channel& channel);

  void Add(const Message& message);
  void Add(const Attachment& attachment);
  void Add(const Metadata& metadata);

  /// Whether the chunks from the one begun on are compressed.
  void SetCompress(bool compress) { options_.compress = compress; }

  /// Closes the chunk begun, if it holds a message.
  void FlushChunk();
  /// The chunk begun holds a message.
  bool pending() const { return chunk_messages_ != 0; }

  /// Closes the file. Nothing may be added afterwards.
  void Finish();

  /// The bytes made since the last call.
  std::string Take();

  const Statistics& statistics() const { return statistics_; }

 private:
  void Emit(const std::string& record);
  void EmitSummary();

  WriterOptions options_;
  std::string out_;
  std::uint64_t offset_ = 0;  ///< In the file, of the next byte appended to out_.
  std::uint32_t data_crc_ = 0;
  bool finished_ = false;

  std::string chunk_;
  std::uint64_t chunk_messages_ = 0;
  std::uint64_t chunk_start_ns_ = 0;  ///< Smallest.
  std::uint64_t chunk_end_ns_ = 0;    ///< Greatest.
  std::map<std::uint16_t, MessageIndex> chunk_index_;

  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<ChunkIndex> chunks_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<MetadataIndex> metadata_;
  Statistics statistics_;
};

}  // namespace footing::mcap

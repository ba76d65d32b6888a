#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <map>
#include <string>

#include "common/recording/writer.h"
#include "common/recording/output_file.h"
#include "common/base/result.h"

namespace footing::recording {

struct WriterSettings {
  std::string library;   ///< Name and version of the program, e.g. "footing-log 0.1.0".
  bool replace = false;  ///< An existing file may be overwritten.
  mcap::WriterOptions chunks;
};

struct Stamp {
  std::int64_t log_ns = 0;      ///< CLOCK_MONOTONIC of the server: when the tick was made.
  std::int64_t publish_ns = 0;  ///< CLOCK_MONOTONIC of the recorder: when it arrived.
  std::uint32_t sequence = 0;   ///< The tick's, lowest 32 bits.
};

/// Writes protobuf messages to a recording. Every closed chunk is written down and synced at once,
/// so a recorder that dies loses no more than the chunk begun. Nothing is written down before the
/// first message or Finish(): a recording without either leaves the path as it was.
class RecordingWriter {
 public:
  static Result<RecordingWriter> Create(const std::string& path, const WriterSettings& settings);

  /// The topic's channel is made at its first message; a topic keeps its message type.
  Result<void> Write(const std::string& topic, const google::protobuf::Message& message,
                     const Stamp& stamp);
  Result<void> AddMetadata(const std::string& name, const mcap::TextMap& values);
  Result<void> Attach(const std::string& name, const std::string& media_type,
                      const std::string& bytes, std::int64_t log_ns);
  /// Writes down the chunk begun.
  Result<void> Flush();
  /// Writes the index and the end. Nothing may be written afterwards.
  Result<void> Finish();

  /// Something is not yet written down.
  bool pending() const { return writer_.pending(); }
  const mcap::Statistics& statistics() const { return writer_.statistics(); }
  const std::string& path() const { return file_.path(); }
  bool empty() const { return file_.empty(); }  ///< No byte is in the file.

 private:
  RecordingWriter(OutputFile file, const WriterSettings& settings);

  std::uint16_t ChannelOf(const std::string& topic, const google::protobuf::Descriptor& type);
  Result<void> WriteDownOnceBegun();
  Result<void> WriteDown();

  OutputFile file_;
  mcap::Writer writer_;
  std::map<std::string, std::uint16_t> channels_;
  std::map<std::string, std::uint16_t> schemas_;
};

}  // namespace footing::recording

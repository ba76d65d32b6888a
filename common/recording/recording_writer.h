#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/message.h>

#include "common/base/result.h"
#include "common/recording/mcap_records.h"
#include "common/recording/mcap_writer.h"

namespace footing::recording {

/// Whether Create() will do, asked before long work; leaves no file behind.
Result<void> CheckCreatable(const std::string& path, bool replace);

/// A new file that is written from its start to its end, readable by its owner alone: recordings
/// are people's movements. Until the first Write() an existing file keeps its contents, and a file
/// without one leaves the path as it was, as does a new file of which no byte could be written.
class OutputFile {
 public:
  /// An existing file is a usage error that says so, unless `replace`.
  static Result<OutputFile> Create(const std::string& path, bool replace);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Hands all bytes to the kernel: they survive the end of this process. The first call empties
  /// an existing file.
  Result<void> Write(std::string_view bytes);
  /// Waits until the bytes are on the disk: they survive the loss of power.
  Result<void> Sync();

  const std::string& path() const { return path_; }
  /// No byte has been written.
  bool empty() const { return empty_; }

 private:
  OutputFile(std::string path, int descriptor, bool created)
      : path_(std::move(path)), descriptor_(descriptor), created_(created) {}

  std::string path_;
  int descriptor_ = -1;
  bool created_ = false;  ///< Did not exist before.
  bool begun_ = false;    ///< Write() was called.
  bool empty_ = true;
  bool failed_ = false;  ///< A Write() was.
};

/// Settings of a recording's file.
struct WriterSettings {
  std::string library;   ///< Name and version of the program, e.g. "footing-log 0.1.0".
  bool replace = false;  ///< An existing file may be overwritten.
  mcap::WriterOptions chunks;
};

/// Times and number of one message.
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

/// The message's file and all it imports, dependencies first, as a serialised FileDescriptorSet:
/// what `protoc --include_imports --descriptor_set_out` writes.
std::string DescribeWithImports(const google::protobuf::Descriptor& message);

/// Makes messages by the schemas inside a recording, so that any version's recording can be read.
class SchemaPool {
 public:
  SchemaPool();
  ~SchemaPool();
  SchemaPool(const SchemaPool&) = delete;
  SchemaPool& operator=(const SchemaPool&) = delete;

  /// InvalidData when the schema is not a protobuf one or makes no sense.
  Result<void> Add(const mcap::Schema& schema);

  /// The message of these bytes; null when there is no schema of that id or they do not fit it.
  /// Owned by the pool and valid until the next call.
  google::protobuf::Message* Parse(std::uint16_t schema_id, std::string_view bytes);

 private:
  struct Entry;
  std::map<std::uint16_t, std::unique_ptr<Entry>> entries_;
};

/// A file's bytes as they are now, mapped and not copied: a recording may be larger than memory. A
/// file that only grows meanwhile, as one being recorded does, is safe to read.
class MappedFile {
 public:
  static Result<MappedFile> Open(const std::string& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  std::string_view bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::string_view bytes) : bytes_(bytes) {}

  std::string_view bytes_;
};

/// A recording, which may be cut anywhere; an error for a file that does not begin as one.
Result<MappedFile> OpenRecording(const std::string& path);

}  // namespace footing::recording

#include "common/recording/recording_writer.h"

#include <utility>

#include "common/recording/schema.h"

namespace footing::recording {

Result<RecordingWriter> RecordingWriter::Create(const std::string& path,
                                                const WriterSettings& settings) {
  Result<OutputFile> file = OutputFile::Create(path, settings.replace);
  if (!file) return file.error();
  return RecordingWriter(std::move(*file), settings);
}

RecordingWriter::RecordingWriter(OutputFile file, const WriterSettings& settings)
    : file_(std::move(file)), writer_(mcap::Header{"", settings.library}, settings.chunks) {}

Result<void> RecordingWriter::Write(const std::string& topic,
                                    const google::protobuf::Message& message, const Stamp& stamp) {
  mcap::Message record;
  record.channel_id = ChannelOf(topic, *message.GetDescriptor());
  record.sequence = stamp.sequence;
  record.log_time_ns = static_cast<std::uint64_t>(stamp.log_ns);
  record.publish_time_ns = static_cast<std::uint64_t>(stamp.publish_ns);
  const std::string bytes = message.SerializeAsString();
  record.data = bytes;
  writer_.Add(record);
  return WriteDown();
}

Result<void> RecordingWriter::AddMetadata(const std::string& name, const mcap::TextMap& values) {
  writer_.Add(mcap::Metadata{name, values});
  return WriteDownOnceBegun();
}

Result<void> RecordingWriter::Attach(const std::string& name, const std::string& media_type,
                                     const std::string& bytes, std::int64_t log_ns) {
  const auto time = static_cast<std::uint64_t>(log_ns);
  writer_.Add(mcap::Attachment{time, time, name, media_type, bytes});
  return WriteDownOnceBegun();
}

Result<void> RecordingWriter::Flush() {
  writer_.FlushChunk();
  return WriteDownOnceBegun();
}

Result<void> RecordingWriter::Finish() {
  writer_.Finish();
  return WriteDown();
}

std::uint16_t RecordingWriter::ChannelOf(const std::string& topic,
                                         const google::protobuf::Descriptor& type) {
  const auto found = channels_.find(topic);
  if (found != channels_.end()) return found->second;
  const auto [schema, fresh] = schemas_.emplace(type.full_name(), 0);
  if (fresh) {
    schema->second = writer_.AddSchema(type.full_name(), "protobuf", DescribeWithImports(type));
  }
  const std::uint16_t channel = writer_.AddChannel(schema->second, topic, "protobuf", {});
  channels_.emplace(topic, channel);
  return channel;
}

Result<void> RecordingWriter::WriteDownOnceBegun() {
  return statistics().message_count > 0 ? WriteDown() : Result<void>();
}

Result<void> RecordingWriter::WriteDown() {
  const std::string bytes = writer_.Take();
  if (bytes.empty()) return {};
  if (const Result<void> written = file_.Write(bytes); !written) return written;
  return file_.Sync();
}

}  // namespace footing::recording

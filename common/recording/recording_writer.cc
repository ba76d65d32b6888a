#include "common/recording/recording_writer.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <google/protobuf/descriptor.pb.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/recording/mcap_records.h"

namespace footing::recording {
namespace {

Error FileExists(const std::string& path) {
  return UsageError(path + " exists; choose another name, or overwrite it with --force");
}

/// By errno.
Error CannotCreate(const std::string& path) {
  const int error = errno;
  const std::string folder = std::filesystem::path(path).parent_path();
  std::error_code ignored;
  const bool no_folder =
      error == ENOENT && !folder.empty() && !std::filesystem::exists(folder, ignored);
  return Failure("cannot create " + path + ": " + std::strerror(error) +
                 (no_folder ? "; make its folder first: mkdir -p " + folder : ""));
}

/// Whether the path still names the open file.
bool IsAt(const std::string& path, int descriptor) {
  struct stat own, there;
  return ::fstat(descriptor, &own) == 0 && ::lstat(path.c_str(), &there) == 0 &&
         own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

}  // namespace

Result<void> CheckCreatable(const std::string& path, bool replace) {
  const Result<OutputFile> file = OutputFile::Create(path, replace);
  return file ? Result<void>() : file.error();
}

Result<OutputFile> OutputFile::Create(const std::string& path, bool replace) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_CLOEXEC;
  int descriptor = ::open(path.c_str(), kFlags | O_EXCL, 0600);
  if (descriptor >= 0) return OutputFile(path, descriptor, /*created=*/true);
  if (errno == EEXIST && !replace) return FileExists(path);
  if (errno == EEXIST) descriptor = ::open(path.c_str(), kFlags, 0600);
  if (descriptor >= 0) return OutputFile(path, descriptor, /*created=*/false);
  return CannotCreate(path);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      created_(other.created_),
      begun_(other.begun_),
      empty_(other.empty_),
      failed_(other.failed_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(created_, other.created_);
  std::swap(begun_, other.begun_);
  std::swap(empty_, other.empty_);
  std::swap(failed_, other.failed_);
  return *this;
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  const bool vain = !begun_ || (failed_ && empty_);
  if (created_ && vain && IsAt(path_, descriptor_)) ::unlink(path_.c_str());
  ::close(descriptor_);
}

Result<void> OutputFile::Write(std::string_view bytes) {
  // EINVAL: a pipe or a device, which has nothing to empty.
  if (!std::exchange(begun_, true) && ::ftruncate(descriptor_, 0) != 0 && errno != EINVAL)
    return Failure("cannot empty " + path_ + ": " + std::strerror(errno));
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    failed_ = failed_ || written < 0;
    if (written < 0) return Failure("cannot write " + path_ + ": " + std::strerror(errno));
    empty_ = empty_ && written == 0;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> OutputFile::Sync() {
  // EINVAL: a pipe or a device, which has nothing to sync.
  if (::fdatasync(descriptor_) == 0 || errno == EINVAL) return {};
  return Failure("cannot write " + path_ + " to the disk: " + std::strerror(errno));
}

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

namespace {

namespace pb = google::protobuf;

constexpr std::size_t kMostMessageBytes = 64u << 20;

void AddWithImports(const pb::FileDescriptor& file, std::set<std::string>& seen,
                    pb::FileDescriptorSet& files) {
  if (!seen.insert(file.name()).second) return;
  for (int i = 0; i < file.dependency_count(); ++i) {
    AddWithImports(*file.dependency(i), seen, files);
  }
  file.CopyTo(files.add_file());
}

/// Protobuf logs what is wrong with a descriptor unless it collects it.
class FirstError : public pb::DescriptorPool::ErrorCollector {
 public:
  void AddError(const std::string&, const std::string& element, const pb::Message*, ErrorLocation,
                const std::string& message) override {
    if (text.empty()) text = element + ": " + message;
  }
  std::string text;
};

}  // namespace

std::string DescribeWithImports(const pb::Descriptor& message) {
  std::set<std::string> seen;
  pb::FileDescriptorSet files;
  AddWithImports(*message.file(), seen, files);
  return files.SerializeAsString();
}

/// A pool each, for two schemas of a file may hold the same .proto in different versions.
struct SchemaPool::Entry {
  pb::DescriptorPool pool;
  pb::DynamicMessageFactory factory;
  std::unique_ptr<pb::Message> message;
};

SchemaPool::SchemaPool() = default;
SchemaPool::~SchemaPool() = default;

Result<void> SchemaPool::Add(const mcap::Schema& schema) {
  const std::string which = "schema " + schema.name + " (id " + std::to_string(schema.id) + ")";
  if (schema.encoding != "protobuf") {
    return InvalidData(which + " is written in " + schema.encoding + ", not in protobuf");
  }
  pb::FileDescriptorSet files;
  if (!files.ParseFromString(schema.data)) {
    return InvalidData(which + " is not a FileDescriptorSet");
  }
  auto entry = std::make_unique<Entry>();
  for (const pb::FileDescriptorProto& file : files.file()) {
    FirstError error;
    if (entry->pool.BuildFileCollectingErrors(file, &error) == nullptr) {
      return InvalidData(which + " makes no sense: " + error.text);
    }
  }
  const pb::Descriptor* descriptor = entry->pool.FindMessageTypeByName(schema.name);
  if (descriptor == nullptr) return InvalidData(which + " does not describe its own message");
  entry->message.reset(entry->factory.GetPrototype(descriptor)->New());
  entries_[schema.id] = std::move(entry);
  return {};
}

pb::Message* SchemaPool::Parse(std::uint16_t schema_id, std::string_view bytes) {
  const auto found = entries_.find(schema_id);
  if (found == entries_.end() || bytes.size() > kMostMessageBytes) return nullptr;
  pb::Message* message = found->second->message.get();
  const bool fits = message->ParsePartialFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return fits ? message : nullptr;
}

Result<MappedFile> MappedFile::Open(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Failure("cannot open " + path + ": " + std::strerror(errno));
  struct stat status {};
  const bool regular = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const auto size = static_cast<std::size_t>(regular ? status.st_size : 0);
  void* start = size == 0 ? nullptr : ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  const int error = errno;
  ::close(descriptor);
  if (!regular) return Failure("cannot read " + path + ": it is not a regular file");
  if (start == MAP_FAILED) return Failure("cannot read " + path + ": " + std::strerror(error));
  return MappedFile(std::string_view(static_cast<const char*>(start), size));
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

Result<MappedFile> OpenRecording(const std::string& path) {
  Result<MappedFile> file = MappedFile::Open(path);
  if (file && !mcap::BeginsAsMcap(file->bytes())) {
    return InvalidData(path + " is not a recording: this is not an MCAP file");
  }
  return file;
}

}  // namespace footing::recording

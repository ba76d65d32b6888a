#include "common/recording/schema.h"

#include <google/protobuf/descriptor.pb.h>

#include <set>

namespace footing::recording {
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

const pb::Message* SchemaPool::Parse(std::uint16_t schema_id, std::string_view bytes) {
  const auto found = entries_.find(schema_id);
  if (found == entries_.end() || bytes.size() > kMostMessageBytes) return nullptr;
  pb::Message* message = found->second->message.get();
  const bool fits = message->ParsePartialFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return fits ? message : nullptr;
}

}  // namespace footing::recording

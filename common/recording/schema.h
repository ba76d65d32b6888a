#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "common/recording/records.h"
#include "common/base/result.h"

namespace footing::recording {

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
  const google::protobuf::Message* Parse(std::uint16_t schema_id, std::string_view bytes);

 private:
  struct Entry;
  std::map<std::uint16_t, std::unique_ptr<Entry>> entries_;
};

}  // namespace footing::recording

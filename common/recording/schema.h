#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "common/mcap/records.h"
#include "common/result/result.h"

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

  /// InvalidData when the schema is no protobuf one or makes no sense.
  Result<void> Add(const mcap::Schema& schema);

  /// An empty message of the schema; null when there is none of that id. Owned by the pool and
  /// shared between calls.
  google::protobuf::Message* MessageOf(std::uint16_t schema_id);

 private:
  struct Entry;
  std::map<std::uint16_t, std::unique_ptr<Entry>> entries_;
};

}  // namespace footing::recording

#include "common/recording/shift_stamps.h"

#include <google/protobuf/descriptor.h>

#include <string>
#include <vector>

#include "common/base/instant.h"

namespace footing::playback {
namespace {

namespace pb = google::protobuf;

bool IsStamp(const pb::FieldDescriptor& field) {
  const std::string& name = field.name();
  return field.cpp_type() == pb::FieldDescriptor::CPPTYPE_INT64 && !field.is_repeated() &&
         name.ends_with("_ns") && name != "age_ns" && name != "true_ns" && name != "wall_time_ns";
}

}  // namespace

void ShiftStamps(pb::Message& message, std::int64_t shift_ns) {
  const pb::Reflection& fields = *message.GetReflection();
  std::vector<const pb::FieldDescriptor*> present;
  fields.ListFields(message, &present);  // Fields of value zero are not among them.
  for (const pb::FieldDescriptor* field : present) {
    if (IsStamp(*field)) {
      const std::int64_t stamp_ns = fields.GetInt64(message, field);
      if (IsInstant(stamp_ns)) fields.SetInt64(&message, field, stamp_ns + shift_ns);
    } else if (field->message_type() == nullptr) {
      continue;
    } else if (field->is_repeated()) {
      const int count = fields.FieldSize(message, field);
      for (int i = 0; i < count; ++i) {
        ShiftStamps(*fields.MutableRepeatedMessage(&message, field, i), shift_ns);
      }
    } else {
      ShiftStamps(*fields.MutableMessage(&message, field), shift_ns);
    }
  }
}

}  // namespace footing::playback

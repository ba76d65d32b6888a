#include "common/net/channels_of.h"

#include <google/protobuf/descriptor.h>

#include <cstdint>

namespace footing::transport {

std::vector<ChannelBytes> ChannelsOf(const v1::Tick& tick) {
  std::vector<ChannelBytes> channels;
  std::vector<const google::protobuf::FieldDescriptor*> present;
  const google::protobuf::Reflection& fields = *tick.GetReflection();
  fields.ListFields(tick, &present);
  for (const google::protobuf::FieldDescriptor* field : present) {
    if (field->message_type() == nullptr) continue;
    channels.push_back({static_cast<std::uint32_t>(field->number()),
                        fields.GetMessage(tick, field).SerializeAsString()});
  }
  return channels;
}

}  // namespace footing::transport

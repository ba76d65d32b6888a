#pragma once

#include <string>
#include <type_traits>

#include "common/wire/scalar.h"
#include "common/wire/wire.h"

/// A message is described once: `Fields(way, value)` lists its fields with the macros below, and
/// FOOTING_BOTH_WAYS makes ToProto and FromProto of the list. A field follows the rules of wire.h
/// by its type. It has the same name on both sides; the macros that end in _OF name a member that
/// is called otherwise, or lies deeper, in the struct. What has a rule of its own (presence,
/// something checked elsewhere) is written out in the list, or both ways.
///
/// Other modules list structs of their own for messages of their own: there `using wire::ToProto;
/// using wire::FromProto;` stands before the lists.
namespace footing::wire {

/// From the struct into the message.
template <typename Value, typename Message>
struct Out {
  static constexpr bool kOut = true;
  const Value& value;
  Message& message;

  template <typename Part>
  Out<Part, Message> PartOf(const Part& part) const {
    return {part, message};
  }
};

/// From the message into the struct.
template <typename Value, typename Message>
struct In {
  static constexpr bool kOut = false;
  Value& value;
  const Message& message;

  template <typename Part>
  In<Part, Message> PartOf(Part& part) const {
    return {part, message};
  }
};

template <typename T>
decltype(auto) Sent(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return Finite(value);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return Utf8(value);
  } else {
    return T(value);
  }
}

template <typename T>
decltype(auto) Received(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    return Finite(value);
  } else {
    return T(value);
  }
}

/// A number, a flag or a text.
#define FOOTING_FIELD_OF(member, name)                               \
  if constexpr (Way::kOut)                                           \
    way.message.set_##name(::footing::wire::Sent(way.value.member)); \
  else                                                               \
    way.value.member = ::footing::wire::Received(way.message.name())
#define FOOTING_FIELD(name) FOOTING_FIELD_OF(name, name)

/// An enum, with the same numbers in footing.v1, where it is called Wire, and common/stream.
#define FOOTING_ENUM_AS(Wire, Type, member, name)                          \
  if constexpr (Way::kOut)                                                 \
    way.message.set_##name(static_cast<v1::Wire>(way.value.member));       \
  else                                                                     \
    way.value.member = v1::Wire##_IsValid(way.message.name())              \
                           ? static_cast<stream::Type>(way.message.name()) \
                           : stream::Type::kUnspecified
#define FOOTING_ENUM_OF(Type, member, name) FOOTING_ENUM_AS(Type, Type, member, name)
#define FOOTING_ENUM(Type, name) FOOTING_ENUM_OF(Type, name, name)

/// A vector, a quaternion or another message.
#define FOOTING_MESSAGE_OF(member, name)                       \
  if constexpr (Way::kOut)                                     \
    *way.message.mutable_##name() = ToProto(way.value.member); \
  else                                                         \
    way.value.member = FromProto(way.message.name())
#define FOOTING_MESSAGE(name) FOOTING_MESSAGE_OF(name, name)

/// Bytes: std::vector<std::uint8_t> in the struct.
#define FOOTING_BYTES(name)                                                      \
  if constexpr (Way::kOut) {                                                     \
    way.message.set_##name(way.value.name.data(), way.value.name.size());        \
  } else {                                                                       \
    way.value.name.assign(way.message.name().begin(), way.message.name().end()); \
  }

/// A message that may be missing: std::optional in the struct.
#define FOOTING_OPTIONAL(name)                                                    \
  if constexpr (Way::kOut) {                                                      \
    if (way.value.name) *way.message.mutable_##name() = ToProto(*way.value.name); \
  } else {                                                                        \
    if (way.message.has_##name()) way.value.name = FromProto(way.message.name()); \
  }

/// A message that may be missing: a flag in the struct says whether it is there.
#define FOOTING_FLAGGED(flag, name)                                              \
  if constexpr (Way::kOut) {                                                     \
    if (way.value.flag) *way.message.mutable_##name() = ToProto(way.value.name); \
  } else {                                                                       \
    way.value.flag = way.message.has_##name();                                   \
    way.value.name = FromProto(way.message.name());                              \
  }

/// A struct within the struct whose fields are in the same message.
#define FOOTING_PART(member) Fields(way.PartOf(way.value.member), way.value.member)

/// Messages, as many as there are: std::vector in the struct.
#define FOOTING_REPEATED(name)                                                           \
  if constexpr (Way::kOut) {                                                             \
    for (const auto& one : way.value.name) *way.message.add_##name() = ToProto(one);     \
  } else {                                                                               \
    for (const auto& one : way.message.name()) way.value.name.push_back(FromProto(one)); \
  }

/// Both functions of a message and its struct.
#define FOOTING_BOTH_WAYS_OF(Value, Message)                             \
  Message ToProto(const Value& value) {                                  \
    Message message;                                                     \
    Fields(::footing::wire::Out<Value, Message>{value, message}, value); \
    return message;                                                      \
  }                                                                      \
  Value FromProto(const Message& message) {                              \
    Value value;                                                         \
    Fields(::footing::wire::In<Value, Message>{value, message}, value);  \
    return value;                                                        \
  }
/// The same of a message of footing.v1 that has the name of its struct in common/stream.
#define FOOTING_BOTH_WAYS(Type) FOOTING_BOTH_WAYS_OF(stream::Type, v1::Type)

}  // namespace footing::wire

#pragma once

#include <string>
#include <type_traits>

#include "common/wire/scalar.h"
#include "common/wire/wire.h"

/// A message is described once: `Fields(way, value)` lists its fields with the macros below, and
/// FOOTING_BOTH_WAYS makes ToProto and FromProto of the list. A field has the same name on both
/// sides and follows the rules of wire.h by its type. What has a rule of its own (presence,
/// something checked elsewhere) is written out in the list, or both ways.
namespace footing::wire {

/// From the struct into the message.
template <typename Value, typename Message>
struct Out {
  static constexpr bool kOut = true;
  const Value& value;
  Message& message;
};

/// From the message into the struct.
template <typename Value, typename Message>
struct In {
  static constexpr bool kOut = false;
  Value& value;
  const Message& message;
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
#define FOOTING_FIELD(name)                       \
  if constexpr (Way::kOut)                        \
    way.message.set_##name(Sent(way.value.name)); \
  else                                            \
    way.value.name = Received(way.message.name())

/// An enum of this type in footing.v1 and common/stream, with the same numbers.
#define FOOTING_ENUM(Type, name)                                   \
  if constexpr (Way::kOut)                                         \
    way.message.set_##name(static_cast<v1::Type>(way.value.name)); \
  else if (v1::Type##_IsValid(way.message.name()))                 \
  way.value.name = static_cast<stream::Type>(way.message.name())

/// A vector, a quaternion or another message.
#define FOOTING_MESSAGE(name)                                \
  if constexpr (Way::kOut)                                   \
    *way.message.mutable_##name() = ToProto(way.value.name); \
  else                                                       \
    way.value.name = FromProto(way.message.name())

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

/// Several of them.
#define FOOTING_REPEATED(name)                                                           \
  if constexpr (Way::kOut) {                                                             \
    for (const auto& one : way.value.name) *way.message.add_##name() = ToProto(one);     \
  } else {                                                                               \
    for (const auto& one : way.message.name()) way.value.name.push_back(FromProto(one)); \
  }

/// Both functions of a message that has the same name as its struct.
#define FOOTING_BOTH_WAYS(Type)                                 \
  v1::Type ToProto(const stream::Type& value) {                 \
    v1::Type message;                                           \
    Fields(Out<stream::Type, v1::Type>{value, message}, value); \
    return message;                                             \
  }                                                             \
  stream::Type FromProto(const v1::Type& message) {             \
    stream::Type value;                                         \
    Fields(In<stream::Type, v1::Type>{value, message}, value);  \
    return value;                                               \
  }

}  // namespace footing::wire

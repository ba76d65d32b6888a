#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/result.h"

/// Open Sound Control 1.0 (opensoundcontrol.org/spec-1_0), from and to bytes. Every number is big
/// endian, every string ends in NUL and is padded with NULs to a multiple of four bytes.
namespace footing::osc {

using Bytes = std::span<const std::uint8_t>;

inline constexpr std::size_t kMostPacketBytes = 65'507;  ///< Largest UDP datagram over IPv4.
inline constexpr std::size_t kMostMessages = 256;  ///< Messages in a packet, all bundles together.
inline constexpr std::size_t kMostArguments = 32;  ///< Arguments of a message.
inline constexpr std::size_t kMostAddressBytes = 128;
inline constexpr int kDeepestBundle = 4;  ///< Bundles inside of bundles.

/// First bytes of a bundle, with the terminating NULs.
inline constexpr std::string_view kBundle("#bundle\0", 8);

/// NTP time: seconds since 1900-01-01 in the upper half, parts of 2^-32 s in the lower.
struct TimeTag {
  std::uint64_t ntp = 1;  ///< 1 means "at once": no time is given. Some senders write 0.

  bool immediate() const { return ntp <= 1; }
  bool operator==(const TimeTag&) const = default;
};

/// Converts from and to nanoseconds since 1970, to the nearest. NTP seconds start again at 0 in
/// 2036: tags before 1968 are taken as after 2036.
TimeTag ToTimeTag(std::int64_t unix_ns);
std::int64_t ToUnixNs(TimeTag tag);

/// Arguments without bytes of their own: type tags N and I.
struct Nil {
  bool operator==(const Nil&) const = default;
};
struct Impulse {
  bool operator==(const Impulse&) const = default;
};

/// One argument: i, h, f, d, T or F, s or S, b, t, N, I. Texts and blobs are views of the packet.
using Argument = std::variant<std::int32_t, std::int64_t, float, double, bool, std::string_view,
                              Bytes, TimeTag, Nil, Impulse>;

/// One message of a packet, with the time tag of the bundle that it is in.
struct Message {
  TimeTag time;
  std::string_view address = {};  ///< Begins with '/', printable.
  std::string_view types = {};    ///< Without the comma; as many as there are arguments.
  std::size_t first_argument = 0;
};

/// The messages of a packet, in order; bundles are flattened. Views of the packet's bytes.
struct Packet {
  std::vector<Message> messages;
  std::vector<Argument> arguments;

  std::span<const Argument> Of(const Message& message) const {
    return {arguments.data() + message.first_argument, message.types.size()};
  }
};

/// Reads a packet; `packet` is cleared and its memory reused. InvalidData says what is wrong and at
/// which byte: a length that is not a multiple of four or reaches beyond its packet, an address or
/// text without an end, a padding byte that is not 0, an unknown type, no type tags, a limit
/// exceeded. Limits hold before memory is taken.
Result<void> Read(Bytes bytes, Packet& packet);

/// A message as bytes. The address begins with '/'; neither it nor a text contains a NUL.
std::string WriteMessage(std::string_view address, std::span<const Argument> arguments);
/// A bundle of messages and bundles, each as bytes.
std::string WriteBundle(TimeTag time, std::span<const std::string> elements);

/// The bytes of a string, as Read takes them.
inline Bytes AsBytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace footing::osc

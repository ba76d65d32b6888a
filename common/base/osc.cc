#include "common/base/osc.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/base/units.h"

namespace footing::osc {
namespace {

constexpr std::string_view kTypes = "ihfdTFsSbtNI";

class Reader {
 public:
  Reader(Bytes bytes, Packet& packet) : bytes_(bytes), packet_(packet) {}

  Result<void> ReadAll() {
    if (bytes_.empty()) return InvalidData("OSC packet is empty");
    if (bytes_.size() > kMostPacketBytes) {
      return InvalidData("OSC packet has " + std::to_string(bytes_.size()) + " bytes, at most " +
                         std::to_string(kMostPacketBytes) + " are read");
    }
    return Element(0, bytes_.size(), TimeTag{}, 0);
  }

 private:
  Error Wrong(const std::string& what) const {
    return InvalidData("OSC packet, byte " + std::to_string(at_) + ": " + what);
  }

  /// A message or a bundle in [at_, end).
  Result<void> Element(std::size_t begin, std::size_t end, TimeTag time, int depth) {
    at_ = begin;
    end_ = end;
    if ((end - begin) % 4 != 0) return Wrong("a length is not a multiple of 4");
    if (end - begin >= kBundle.size() && View(begin, kBundle.size()) == kBundle)
      return Bundle(end, depth);
    return ReadMessage(time);
  }

  Result<void> Bundle(std::size_t end, int depth) {
    if (depth >= kDeepestBundle) return Wrong("bundles are nested too deep");
    at_ += kBundle.size();
    if (end - at_ < 8) return Wrong("a bundle ends before its time tag");
    const TimeTag time{Number<std::uint64_t>()};
    while (at_ < end) {
      if (end - at_ < 4) return Wrong("a bundle ends before the length of its element");
      const auto size = Number<std::uint32_t>();
      if (size == 0) return Wrong("an element is empty");
      if (size > end - at_) return Wrong("an element reaches beyond its bundle");
      const std::size_t element_end = at_ + size;
      if (auto read = Element(at_, element_end, time, depth + 1); !read) return read;
      at_ = element_end;
      end_ = end;
    }
    return {};
  }

  Result<void> ReadMessage(TimeTag time) {
    if (packet_.messages.size() >= kMostMessages) return Wrong("too many messages");
    Message message{.time = time, .first_argument = packet_.arguments.size()};
    if (at_ == end_ || bytes_[at_] != '/')
      return Wrong("neither a message nor a bundle begins here");
    const auto address = Text();
    if (!address) return address.error();
    message.address = *address;
    if (message.address.size() > kMostAddressBytes) return Wrong("an address is too long");
    if (!std::all_of(message.address.begin(), message.address.end(),
                     [](char c) { return c > ' ' && c <= '~'; })) {
      return Wrong("an address is not printable");
    }
    if (at_ == end_ || bytes_[at_] != ',') return Wrong("a message has no type tags");
    const auto types = Text();
    if (!types) return types.error();
    message.types = types->substr(1);
    if (message.types.size() > kMostArguments) return Wrong("a message has too many arguments");
    for (const char type : message.types) {
      if (auto read = ReadArgument(type); !read) return read;
    }
    if (at_ != end_) return Wrong("a message is longer than its arguments");
    packet_.messages.push_back(message);
    return {};
  }

  Result<void> ReadArgument(char type) {
    if (kTypes.find(type) == std::string_view::npos)
      return Wrong("a type tag is none of " + std::string(kTypes));
    const std::size_t size = SizeOf(type);
    if (end_ - at_ < size) return Wrong("a message ends before its arguments");
    switch (type) {
      case 'i':
        Add(std::bit_cast<std::int32_t>(Number<std::uint32_t>()));
        break;
      case 'h':
        Add(std::bit_cast<std::int64_t>(Number<std::uint64_t>()));
        break;
      case 'f':
        Add(std::bit_cast<float>(Number<std::uint32_t>()));
        break;
      case 'd':
        Add(std::bit_cast<double>(Number<std::uint64_t>()));
        break;
      case 't':
        Add(TimeTag{Number<std::uint64_t>()});
        break;
      case 'T':
      case 'F':
        Add(type == 'T');
        break;
      case 'N':
        Add(Nil{});
        break;
      case 'I':
        Add(Impulse{});
        break;
      case 'b':
        return Blob();
      default: {  // s and S.
        const auto text = Text();
        if (!text) return text.error();
        Add(*text);
      }
    }
    return {};
  }

  static std::size_t SizeOf(char type) {
    if (type == 'i' || type == 'f' || type == 'b') return 4;
    return type == 'h' || type == 'd' || type == 't' ? 8 : 0;
  }

  Result<void> Blob() {
    const auto size = Number<std::uint32_t>();
    if (size > end_ - at_) return Wrong("a blob reaches beyond its message");
    const Bytes blob = bytes_.subspan(at_, size);
    at_ += size;
    if (auto padded = Padding(); !padded) return padded;
    Add(blob);
    return {};
  }

  Result<std::string_view> Text() {
    const std::size_t begin = at_;
    while (at_ < end_ && bytes_[at_] != 0) ++at_;
    if (at_ == end_) return Wrong("a text has no end");
    const std::string_view text = View(begin, at_ - begin);
    ++at_;
    if (auto padded = Padding(); !padded) return padded.error();
    return text;
  }

  /// Elements begin at multiples of four of the packet, so its offsets are theirs.
  Result<void> Padding() {
    for (; at_ % 4 != 0; ++at_) {
      if (at_ >= end_) return Wrong("padding is missing");
      if (bytes_[at_] != 0) return Wrong("a padding byte is not 0");
    }
    return {};
  }

  template <typename T>
  T Number() {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<T>(value << 8) | bytes_[at_++];
    return value;
  }

  void Add(const Argument& argument) { packet_.arguments.push_back(argument); }

  std::string_view View(std::size_t begin, std::size_t size) const {
    return {reinterpret_cast<const char*>(bytes_.data()) + begin, size};
  }

  Bytes bytes_;
  Packet& packet_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;  // End of the current message in bytes_.
};

constexpr std::int64_t kUnixInNtpS = 2'208'988'800;  // 1970 in seconds since 1900.
constexpr std::uint64_t kEraS = 1ull << 32;

}  // namespace

Result<void> Read(Bytes bytes, Packet& packet) {
  packet.messages.clear();
  packet.arguments.clear();
  auto read = Reader(bytes, packet).ReadAll();
  if (!read) {
    packet.messages.clear();
    packet.arguments.clear();
  }
  return read;
}

TimeTag ToTimeTag(std::int64_t unix_ns) {
  std::int64_t seconds = unix_ns / kNanosecondsPerSecond;
  std::int64_t rest_ns = unix_ns % kNanosecondsPerSecond;
  if (rest_ns < 0) {
    --seconds;
    rest_ns += kNanosecondsPerSecond;
  }
  const auto whole = static_cast<std::uint64_t>(seconds + kUnixInNtpS) % kEraS;
  const std::uint64_t part =
      ((static_cast<std::uint64_t>(rest_ns) << 32) + kNanosecondsPerSecond / 2) /
      static_cast<std::uint64_t>(kNanosecondsPerSecond);
  return {(whole << 32) + part};
}

std::int64_t ToUnixNs(TimeTag tag) {
  const auto whole = static_cast<std::int64_t>(tag.ntp >> 32);
  const std::uint64_t part = tag.ntp & 0xFFFF'FFFF;
  const std::int64_t era_s = whole < (1ll << 31) ? static_cast<std::int64_t>(kEraS) : 0;
  // A fraction never rounds up to the next second: after the last second comes another era.
  const auto rest_ns =
      std::min(static_cast<std::int64_t>((part * 1'000'000'000ull + (1ull << 31)) >> 32),
               kNanosecondsPerSecond - 1);
  return (whole + era_s - kUnixInNtpS) * kNanosecondsPerSecond + rest_ns;
}

namespace {

template <typename T>
void AppendNumber(std::string& bytes, T value) {
  for (std::size_t i = sizeof(T); i-- > 0;)
    bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xFF));
}

void Pad(std::string& bytes) { bytes.resize((bytes.size() + 3) / 4 * 4, '\0'); }

void AppendText(std::string& bytes, std::string_view text) {
  bytes += text;
  bytes.push_back('\0');
  Pad(bytes);
}

/// Appends the type's letter and the argument's bytes.
struct Append {
  std::string& types;
  std::string& bytes;

  void operator()(std::int32_t value) const {
    types += 'i';
    AppendNumber(bytes, std::bit_cast<std::uint32_t>(value));
  }
  void operator()(std::int64_t value) const {
    types += 'h';
    AppendNumber(bytes, std::bit_cast<std::uint64_t>(value));
  }
  void operator()(float value) const {
    types += 'f';
    AppendNumber(bytes, std::bit_cast<std::uint32_t>(value));
  }
  void operator()(double value) const {
    types += 'd';
    AppendNumber(bytes, std::bit_cast<std::uint64_t>(value));
  }
  void operator()(bool value) const { types += value ? 'T' : 'F'; }
  void operator()(std::string_view value) const {
    types += 's';
    AppendText(bytes, value);
  }
  void operator()(Bytes value) const {
    types += 'b';
    AppendNumber(bytes, static_cast<std::uint32_t>(value.size()));
    bytes.append(reinterpret_cast<const char*>(value.data()), value.size());
    Pad(bytes);
  }
  void operator()(TimeTag value) const {
    types += 't';
    AppendNumber(bytes, value.ntp);
  }
  void operator()(Nil) const { types += 'N'; }
  void operator()(Impulse) const { types += 'I'; }
};

}  // namespace

std::string WriteMessage(std::string_view address, std::span<const Argument> arguments) {
  std::string types = ",", bytes;
  for (const Argument& argument : arguments) std::visit(Append{types, bytes}, argument);
  std::string message;
  AppendText(message, address);
  AppendText(message, types);
  return message + bytes;
}

std::string WriteBundle(TimeTag time, std::span<const std::string> elements) {
  std::string bundle(kBundle);
  AppendNumber(bundle, time.ntp);
  for (const std::string& element : elements) {
    AppendNumber(bundle, static_cast<std::uint32_t>(element.size()));
    bundle += element;
  }
  return bundle;
}

}  // namespace footing::osc

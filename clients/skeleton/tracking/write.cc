#include <bit>

#include "clients/skeleton/tracking/osc.h"

namespace footing::osc {
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

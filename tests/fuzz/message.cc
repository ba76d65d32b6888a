#include "tests/fuzz/message.h"

#include <google/protobuf/descriptor.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace footing::fuzz {
namespace {

namespace pb = google::protobuf;
using Kind = pb::FieldDescriptor::CppType;

constexpr int kDeepest = 5, kMostFields = 12, kMostRepeated = 6;

/// Small, at a border, or any bits.
std::uint64_t Bits(Input& input) {
  constexpr std::array<std::uint64_t, 8> kBorders{
      0x7fffffffffffffff, 0x8000000000000000, ~std::uint64_t{0}, 0x7fffffff,
      0xffffffff,         0x80000000,         1'000'000'000,     1'000'000'000'000};
  const std::uint8_t way = input.Byte();
  if (way < 160) return input.Byte();
  if (way < 208) return kBorders[way % kBorders.size()];
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) bits = bits << 8 | input.Byte();
  return bits;
}

double Number(Input& input) {
  constexpr std::array<double, 5> kSpecial{
      std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
      -std::numeric_limits<double>::infinity(), 1e308, -1e-308};
  const std::uint8_t way = input.Byte();
  if (way < 200) return (input.Byte() - 128) / 16.0;
  if (way < 240) return kSpecial[way % kSpecial.size()];
  return std::bit_cast<double>(Bits(input));
}

std::string Text(Input& input, bool any_bytes) {
  const Bytes bytes = input.String();
  std::string text(bytes.begin(), bytes.end());
  if (any_bytes) return text;
  for (char& c : text) c = static_cast<char>(c & 0x7f);
  return text;
}

void FillOne(Input& input, pb::Message& message, const pb::FieldDescriptor* field, int depth) {
  const pb::Reflection& by = *message.GetReflection();
  const bool many = field->is_repeated();
#define FOOTING_FUZZ_SET(Type, value) \
  many ? by.Add##Type(&message, field, value) : by.Set##Type(&message, field, value)
  switch (field->cpp_type()) {
    case Kind::CPPTYPE_BOOL:
      return FOOTING_FUZZ_SET(Bool, (input.Byte() & 1) != 0);
    case Kind::CPPTYPE_INT32:
      return FOOTING_FUZZ_SET(Int32, static_cast<std::int32_t>(Bits(input)));
    case Kind::CPPTYPE_INT64:
      return FOOTING_FUZZ_SET(Int64, static_cast<std::int64_t>(Bits(input)));
    case Kind::CPPTYPE_UINT32:
      return FOOTING_FUZZ_SET(UInt32, static_cast<std::uint32_t>(Bits(input)));
    case Kind::CPPTYPE_UINT64:
      return FOOTING_FUZZ_SET(UInt64, Bits(input));
    case Kind::CPPTYPE_FLOAT: {
      const double number = Number(input);
      return FOOTING_FUZZ_SET(Float, std::abs(number) < 3e38 ? static_cast<float>(number) : NAN);
    }
    case Kind::CPPTYPE_DOUBLE:
      return FOOTING_FUZZ_SET(Double, Number(input));
    case Kind::CPPTYPE_ENUM:
      return FOOTING_FUZZ_SET(EnumValue, input.Byte() % 40);
    case Kind::CPPTYPE_STRING:
      return FOOTING_FUZZ_SET(String,
                              Text(input, field->type() == pb::FieldDescriptor::Type::TYPE_BYTES));
    case Kind::CPPTYPE_MESSAGE:
      if (depth >= kDeepest) return;
      return Fill(input,
                  many ? *by.AddMessage(&message, field) : *by.MutableMessage(&message, field),
                  depth + 1);
  }
#undef FOOTING_FUZZ_SET
}

}  // namespace

void Fill(Input& input, pb::Message& message, int depth) {
  const pb::Descriptor& type = *message.GetDescriptor();
  if (type.field_count() == 0) return;
  const int fields = input.Byte() % (kMostFields + 1);
  for (int i = 0; i < fields && !input.empty(); ++i) {
    const pb::FieldDescriptor* field = type.field(input.Byte() % type.field_count());
    const int times = field->is_repeated() ? 1 + input.Byte() % kMostRepeated : 1;
    for (int n = 0; n < times; ++n) FillOne(input, message, field, depth);
  }
}

bool IsFinite(const pb::Message& message) {
  const pb::Reflection& by = *message.GetReflection();
  std::vector<const pb::FieldDescriptor*> fields;
  by.ListFields(message, &fields);
  for (const pb::FieldDescriptor* field : fields) {
    const int count = field->is_repeated() ? by.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      const bool many = field->is_repeated();
      if (field->cpp_type() == Kind::CPPTYPE_DOUBLE &&
          !std::isfinite(many ? by.GetRepeatedDouble(message, field, i)
                              : by.GetDouble(message, field)))
        return false;
      if (field->cpp_type() == Kind::CPPTYPE_FLOAT &&
          !std::isfinite(many ? by.GetRepeatedFloat(message, field, i)
                              : by.GetFloat(message, field)))
        return false;
      if (field->cpp_type() == Kind::CPPTYPE_MESSAGE &&
          !IsFinite(many ? by.GetRepeatedMessage(message, field, i)
                         : by.GetMessage(message, field)))
        return false;
    }
  }
  return true;
}

}  // namespace footing::fuzz

#include "clients/log/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/base/text.h"

namespace footing::log_client {
namespace {

namespace pb = google::protobuf;

template <typename T>
void AppendNumber(T value, std::string& out) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
  out.append(text, end);
}

void AppendText(const std::string& text, std::string& out) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

void AppendHex(const std::string& bytes, std::string& out) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    out += kDigits[value >> 4];
    out += kDigits[value & 0xF];
  }
}

void AppendEnum(const pb::EnumDescriptor& type, int number, std::string& out) {
  const pb::EnumValueDescriptor* value = type.FindValueByNumber(number);
  if (value != nullptr) {
    out += value->name();
  } else {
    AppendNumber(number, out);
  }
}

/// Calls `use` with the value of a field that is not a message, enums as their number; `index`
/// counts in a list and is -1 elsewhere.
template <typename Use>
void UseValue(const pb::Message& message, const pb::FieldDescriptor& field, int index, Use use) {
  const pb::Reflection& r = *message.GetReflection();
  const bool list = index >= 0;
  switch (field.cpp_type()) {
    case pb::FieldDescriptor::CPPTYPE_INT32:
      return use(list ? r.GetRepeatedInt32(message, &field, index) : r.GetInt32(message, &field));
    case pb::FieldDescriptor::CPPTYPE_INT64:
      return use(list ? r.GetRepeatedInt64(message, &field, index) : r.GetInt64(message, &field));
    case pb::FieldDescriptor::CPPTYPE_UINT32:
      return use(list ? r.GetRepeatedUInt32(message, &field, index) : r.GetUInt32(message, &field));
    case pb::FieldDescriptor::CPPTYPE_UINT64:
      return use(list ? r.GetRepeatedUInt64(message, &field, index) : r.GetUInt64(message, &field));
    case pb::FieldDescriptor::CPPTYPE_DOUBLE:
      return use(list ? r.GetRepeatedDouble(message, &field, index) : r.GetDouble(message, &field));
    case pb::FieldDescriptor::CPPTYPE_FLOAT:
      return use(list ? r.GetRepeatedFloat(message, &field, index) : r.GetFloat(message, &field));
    case pb::FieldDescriptor::CPPTYPE_BOOL:
      return use(list ? r.GetRepeatedBool(message, &field, index) : r.GetBool(message, &field));
    case pb::FieldDescriptor::CPPTYPE_ENUM:
      return use(list ? r.GetRepeatedEnumValue(message, &field, index)
                      : r.GetEnumValue(message, &field));
    case pb::FieldDescriptor::CPPTYPE_STRING:
      return use(list ? r.GetRepeatedString(message, &field, index) : r.GetString(message, &field));
    case pb::FieldDescriptor::CPPTYPE_MESSAGE:
      return;
  }
}

void AppendValue(const pb::Message& message, const pb::FieldDescriptor& field, int index,
                 std::optional<int> decimals, std::string& out) {
  UseValue(message, field, index, [&](const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::string>) {
      field.type() == pb::FieldDescriptor::TYPE_BYTES ? AppendHex(value, out)
                                                      : AppendText(value, out);
    } else if constexpr (std::is_same_v<Value, bool>) {
      out += value ? '1' : '0';
    } else if constexpr (std::is_floating_point_v<Value>) {
      if (!std::isfinite(value)) return;
      decimals ? text::AppendFixed(out, static_cast<double>(value), *decimals)
               : AppendNumber(value, out);
    } else if (field.enum_type() != nullptr) {
      AppendEnum(*field.enum_type(), static_cast<int>(value), out);
    } else {
      AppendNumber(value, out);
    }
  });
}

double NumberOf(const pb::Message& message, const pb::FieldDescriptor& field, int index) {
  double number = std::numeric_limits<double>::quiet_NaN();
  UseValue(message, field, index, [&number](const auto& value) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      number = static_cast<double>(value);
    }
  });
  return number;
}

/// How many entries of the field the message has: of a list its length, else 1 or 0.
std::size_t Entries(const pb::Message& message, const pb::FieldDescriptor& field) {
  const pb::Reflection& r = *message.GetReflection();
  if (field.is_repeated()) return static_cast<std::size_t>(r.FieldSize(message, &field));
  return !field.has_presence() || r.HasField(message, &field) ? 1 : 0;
}

const pb::Message& Entry(const pb::Message& message, const pb::FieldDescriptor& field,
                         std::size_t index) {
  const pb::Reflection& r = *message.GetReflection();
  return field.is_repeated() ? r.GetRepeatedMessage(message, &field, static_cast<int>(index))
                             : r.GetMessage(message, &field);
}

/// A hash or an epoch is a name of 64 bits, and no number.
bool IsNumber(const pb::FieldDescriptor& field) {
  if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_STRING) return false;
  return field.cpp_type() != pb::FieldDescriptor::CPPTYPE_UINT64 ||
         !(field.name().ends_with("_hash") || field.name().ends_with("epoch"));
}

const pb::FieldDescriptor* FirstList(const pb::Descriptor& type) {
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->is_repeated() && type.field(i)->message_type() != nullptr) {
      return type.field(i);
    }
  }
  return nullptr;
}

}  // namespace

CsvTable::CsvTable(const pb::Descriptor& type)
    : rows_(FirstList(type)), outer_(NodesOf(type, rows_)) {
  if (rows_ != nullptr) inner_ = NodesOf(*rows_->message_type(), nullptr);
}

std::vector<CsvTable::Node> CsvTable::NodesOf(const pb::Descriptor& type,
                                              const pb::FieldDescriptor* without) {
  std::vector<Node> nodes;
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i) != without) nodes.push_back({type.field(i), 0, {}});
  }
  return nodes;
}

void CsvTable::LearnFields(const pb::Message& message, std::vector<Node>& nodes) {
  for (Node& node : nodes) {
    const std::size_t entries = Entries(message, *node.field);
    node.entries = std::max(node.entries, entries);
    if (node.field->message_type() == nullptr || entries == 0) continue;
    if (node.children.empty()) node.children = NodesOf(*node.field->message_type(), nullptr);
    for (std::size_t k = 0; k < entries; ++k) {
      LearnFields(Entry(message, *node.field, k), node.children);
    }
  }
}

Result<void> CsvTable::Learn(const pb::Message& message) {
  LearnFields(message, outer_);
  if (rows_ != nullptr) {
    for (std::size_t k = 0; k < Entries(message, *rows_); ++k) {
      LearnFields(Entry(message, *rows_, k), inner_);
    }
  }
  if (Columns(outer_) + Columns(inner_) <= kMostColumns) return {};
  return InvalidData("a message of type " + message.GetDescriptor()->full_name() +
                     " would need more than " + std::to_string(kMostColumns) + " columns");
}

std::size_t CsvTable::Columns(const std::vector<Node>& nodes) {
  std::size_t columns = 0;
  for (const Node& node : nodes) {
    const std::size_t each = node.field->message_type() == nullptr ? 1 : Columns(node.children);
    columns = std::min(columns + std::min(node.entries, kMostColumns + 1) * each, kMostColumns + 1);
  }
  return columns;
}

void CsvTable::Names(const std::vector<Node>& nodes, const std::string& prefix,
                     std::vector<Column>& columns) {
  for (const Node& node : nodes) {
    for (std::size_t k = 0; k < node.entries; ++k) {
      std::string name = prefix + node.field->name();
      if (node.field->is_repeated()) name.append(1, '_').append(std::to_string(k));
      if (node.field->message_type() == nullptr) {
        columns.push_back({name, node.field, IsNumber(*node.field)});
      } else {
        Names(node.children, name + "_", columns);
      }
    }
  }
}

std::vector<CsvTable::Column> CsvTable::AllColumns() const {
  std::vector<Column> columns;
  Names(outer_, "", columns);
  std::vector<Column> inner;
  Names(inner_, "", inner);
  for (Column& column : inner) {
    const bool taken = std::any_of(columns.begin(), columns.end(), [&column](const Column& other) {
      return other.name == column.name;
    });
    if (taken) column.name = rows_->name() + "_" + column.name;
    columns.push_back(std::move(column));
  }
  return columns;
}

std::string CsvTable::Header() const {
  std::string header;
  for (const Column& column : AllColumns()) {
    if (!header.empty()) header += ',';
    header += column.name;
  }
  return header;
}

void CsvTable::Cells(const pb::Message* message, const std::vector<Node>& nodes,
                     std::optional<int> decimals, std::string& out) {
  for (const Node& node : nodes) {
    const std::size_t here = message == nullptr ? 0 : Entries(*message, *node.field);
    for (std::size_t k = 0; k < node.entries; ++k) {
      if (node.field->message_type() != nullptr) {
        Cells(k < here ? &Entry(*message, *node.field, k) : nullptr, node.children, decimals, out);
        continue;
      }
      if (k < here) {
        AppendValue(*message, *node.field, node.field->is_repeated() ? static_cast<int>(k) : -1,
                    decimals, out);
      }
      out += ',';
    }
  }
}

void CsvTable::AppendRows(const pb::Message& message, const RowEnd& begin, const RowEnd& end,
                          std::string& out, std::optional<int> decimals) const {
  const auto append = [&](const pb::Message* entry) {
    out += begin(entry);
    Cells(&message, outer_, decimals, out);
    Cells(entry, inner_, decimals, out);
    if (out.back() == ',') out.pop_back();  // Each cell ends in a comma; the last one needs none.
    out += end(entry);
    out += '\n';
  };
  for (const pb::Message* entry : Rows(message)) append(entry);
}

std::vector<const pb::Message*> CsvTable::Rows(const pb::Message& message) const {
  if (rows_ == nullptr) return {nullptr};
  std::vector<const pb::Message*> rows;
  for (std::size_t k = 0; k < Entries(message, *rows_); ++k) {
    rows.push_back(&Entry(message, *rows_, k));
  }
  return rows;
}

std::vector<std::string> CsvTable::NumberNames() const {
  std::vector<std::string> names;
  for (Column& column : AllColumns()) {
    if (column.is_number) names.push_back(std::move(column.name));
  }
  return names;
}

void CsvTable::NumberCells(const pb::Message* message, const std::vector<Node>& nodes,
                           std::vector<double>& out) {
  for (const Node& node : nodes) {
    if (node.field->message_type() == nullptr && !IsNumber(*node.field)) continue;
    const std::size_t here = message == nullptr ? 0 : Entries(*message, *node.field);
    for (std::size_t k = 0; k < node.entries; ++k) {
      if (node.field->message_type() != nullptr) {
        NumberCells(k < here ? &Entry(*message, *node.field, k) : nullptr, node.children, out);
      } else {
        const int index = node.field->is_repeated() ? static_cast<int>(k) : -1;
        out.push_back(k < here ? NumberOf(*message, *node.field, index)
                               : std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
}

std::vector<double> CsvTable::Numbers(const pb::Message& message, const pb::Message* entry) const {
  std::vector<double> numbers;
  NumberCells(&message, outer_, numbers);
  NumberCells(entry, inner_, numbers);
  return numbers;
}

namespace {

/// Units at the end of a field's name, and how others write them (UCUM).
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"m", "m"},         {"mps", "m/s"},       {"mps2", "m/s2"}, {"m2", "m2"},  {"rad", "rad"},
    {"radps", "rad/s"}, {"deg", "deg"},       {"n", "N"},       {"nm", "N.m"}, {"ns", "ns"},
    {"us", "us"},       {"ms", "ms"},         {"s", "s"},       {"hz", "Hz"},  {"kg", "kg"},
    {"c", "Cel"},       {"kgm2ps", "kg.m2/s"}};

/// Where the unit's word begins in a name, and the unit; npos where it has none.
std::pair<std::size_t, std::string_view> FindUnit(std::string_view name) {
  const auto word_at = [&name](std::size_t end) {
    const std::size_t line = end == 0 ? std::string_view::npos : name.rfind('_', end - 1);
    return line == std::string_view::npos ? 0 : line + 1;
  };
  std::size_t end = name.size();
  std::size_t begin = word_at(end);
  std::string_view word = name.substr(begin, end - begin);
  // An axis, or the place of an entry, stands behind it.
  const bool is_part = word == "x" || word == "y" || word == "z" || word == "w" ||
                       (!word.empty() && word.find_first_not_of("0123456789") == word.npos);
  if (is_part && begin > 0) {
    end = begin - 1;
    begin = word_at(end);
    word = name.substr(begin, end - begin);
  }
  for (const auto& [suffix, unit] : kUnits) {
    if (word == suffix && begin > 0) return {begin, unit};
  }
  return {std::string_view::npos, ""};
}

}  // namespace

std::string UnitOf(const std::string& column) { return std::string(FindUnit(column).second); }

std::string UnitLast(const std::string& column) {
  const std::size_t begin = FindUnit(column).first;
  if (begin == std::string::npos) return column;
  const std::size_t end = column.find('_', begin);
  if (end == std::string::npos) return column;
  return column.substr(0, begin) + column.substr(end + 1) + "_" + column.substr(begin, end - begin);
}

}  // namespace footing::log_client

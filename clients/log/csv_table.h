#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::log_client {

/// Any protobuf message as rows of a table, in CSV (RFC 4180) or as numbers.
///
/// The message's first list of messages gives the rows: one an entry, beside the message's own
/// fields; a message type without such a list gives one row. A field inside a message is named
/// OUTER_FIELD, an entry of any other list LIST_INDEX or LIST_INDEX_FIELD, from 0. Units stand in
/// the fields' own names. Enums are their names, flags 0 or 1, bytes hexadecimal; what a message
/// does not have is an empty cell.
///
/// The columns are those that any message shown to Learn() has, so a table takes two passes.
class CsvTable {
 public:
  explicit CsvTable(const google::protobuf::Descriptor& type);

  /// InvalidData when a list would give the table more than kMostColumns.
  Result<void> Learn(const google::protobuf::Message& message);

  struct Column {
    std::string name;
    const google::protobuf::FieldDescriptor* field = nullptr;
    bool is_number = false;  ///< A number, flag or enum that a double can hold.
  };
  std::vector<Column> AllColumns() const;
  /// Column names, separated by commas, without a line's end.
  std::string Header() const;
  /// Names of the columns that hold numbers, flags or enums. Hashes and epochs are none: they are
  /// names of 64 bits, which a double cannot hold.
  std::vector<std::string> NumberNames() const;

  /// The entries of a message's rows; one null for a message that has one row.
  std::vector<const google::protobuf::Message*> Rows(
      const google::protobuf::Message& message) const;
  /// Values of a row in the columns of NumberNames(): flags are 0 or 1, enums their number, fields
  /// that the message does not have are NaN.
  std::vector<double> Numbers(const google::protobuf::Message& message,
                              const google::protobuf::Message* entry) const;

  /// Adds to a row's line; null is the entry of a message that has one row.
  using RowEnd = std::function<std::string(const google::protobuf::Message* entry)>;

  /// Appends a line for each row: what `begin` says of it (itself ending in a comma, or empty), the
  /// cells, and what `end` says (itself beginning with a comma, or empty). Numbers that are not
  /// whole have as many digits as they need to be read again, or this many decimals.
  void AppendRows(const google::protobuf::Message& message, const RowEnd& begin, const RowEnd& end,
                  std::string& out, std::optional<int> decimals = std::nullopt) const;

  /// The type of a row's entry; null when a message has one row.
  const google::protobuf::Descriptor* row_type() const {
    return rows_ == nullptr ? nullptr : rows_->message_type();
  }

  /// The list whose entries are the rows; null when a message has one row.
  const google::protobuf::FieldDescriptor* row_list() const { return rows_; }

  static constexpr std::size_t kMostColumns = 4096;

 private:
  /// A field, and as many entries of it as any message has.
  struct Node {
    const google::protobuf::FieldDescriptor* field = nullptr;
    std::size_t entries = 0;
    std::vector<Node> children;  ///< Fields of a nested message.
  };

  static std::vector<Node> NodesOf(const google::protobuf::Descriptor& type,
                                   const google::protobuf::FieldDescriptor* without);
  static void LearnFields(const google::protobuf::Message& message, std::vector<Node>& nodes);
  static std::size_t Columns(const std::vector<Node>& nodes);
  static void Names(const std::vector<Node>& nodes, const std::string& prefix,
                    std::vector<Column>& columns);
  /// A null message: its cells are empty.
  static void Cells(const google::protobuf::Message* message, const std::vector<Node>& nodes,
                    std::optional<int> decimals, std::string& out);
  static void NumberCells(const google::protobuf::Message* message, const std::vector<Node>& nodes,
                          std::vector<double>& out);

  const google::protobuf::FieldDescriptor* rows_ = nullptr;
  std::vector<Node> outer_;
  std::vector<Node> inner_;
};

/// The unit that stands in the name of a column, as UCUM has it: "m/s2" for "velocity_mps2_x",
/// "filtered_mps2"; empty where the name has none.
std::string UnitOf(const std::string& column);

/// The name with its unit at the end: "position_x_m" for "position_m_x".
std::string UnitLast(const std::string& column);

}  // namespace footing::log_client

#pragma once

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cstddef>
#include <functional>
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

  /// Column names, separated by commas, without a line's end.
  std::string Header() const;
  /// Names of the columns that hold numbers, flags or enums.
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

  /// Appends a line for each row: `prefix` (itself ending in a comma, or empty), the cells, and
  /// what `end` says of the row (itself beginning with a comma, or empty).
  void AppendRows(const google::protobuf::Message& message, const std::string& prefix,
                  const RowEnd& end, std::string& out) const;

  /// The type of a row's entry; null when a message has one row.
  const google::protobuf::Descriptor* row_type() const {
    return rows_ == nullptr ? nullptr : rows_->message_type();
  }

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
  struct Column {
    std::string name;
    bool is_number = false;
  };
  static void Names(const std::vector<Node>& nodes, const std::string& prefix,
                    std::vector<Column>& columns);
  std::vector<Column> AllColumns() const;
  /// A null message: its cells are empty.
  static void Cells(const google::protobuf::Message* message, const std::vector<Node>& nodes,
                    std::string& out);
  static void NumberCells(const google::protobuf::Message* message, const std::vector<Node>& nodes,
                          std::vector<double>& out);

  const google::protobuf::FieldDescriptor* rows_ = nullptr;
  std::vector<Node> outer_;
  std::vector<Node> inner_;
};

}  // namespace footing::log_client

#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "clients/log/csv_table.h"
#include "clients/log/row_notes.h"
#include "common/recording/walk.h"
#include "common/recording/schema.h"
#include "common/base/result.h"

namespace footing::log_client {

/// One topic of a recording, whose messages are rows of a table.
struct TopicTable {
  std::string topic;
  std::uint16_t schema_id = 0;
  std::optional<CsvTable> table;  ///< Nothing when the topic has no message.
};

/// The messages of a recording as rows of tables, one table a topic, in two passes: the first
/// learns the columns, roles and names, the second visits the messages in their order.
class Tables {
 public:
  /// `bytes` of the recording stay valid as long as this; `path` names it in errors.
  Tables(std::string_view bytes, std::string path) : bytes_(bytes), path_(std::move(path)) {}

  /// The first pass. InvalidData where the recording is cut short or damaged, or a message does not
  /// fit its schema.
  Result<void> Learn();

  /// Ends at the first failure. `channel` is the topic's key in topics().
  using Visit = std::function<Result<void>(std::uint16_t channel, const mcap::Message& record,
                                           const google::protobuf::Message& message)>;
  Result<void> Walk(const Visit& visit);

  /// By channel.
  const std::map<std::uint16_t, TopicTable>& topics() const { return topics_; }
  /// Of the whole recording after Learn(); while Walk() goes on, of what it has passed.
  const RowNotes& notes() const { return notes_; }

 private:
  const google::protobuf::Message* Parse(const TopicTable& topic, const mcap::Message& record);
  /// Keeps the first failure.
  void Fail(Result<void> result) {
    if (!result && first_failure_) first_failure_ = std::move(result);
  }

  std::string_view bytes_;
  std::string path_;
  recording::SchemaPool pool_;
  RowNotes notes_;
  std::map<std::uint16_t, TopicTable> topics_;
  Result<void> first_failure_;
};

}  // namespace footing::log_client

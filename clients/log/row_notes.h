#pragma once

#include <google/protobuf/message.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/recording/records.h"

namespace footing::log_client {

/// What an exported row says beside its message: its time in seconds and as wall time, the role of
/// the device that it is about, the names of a character's links and contact points, the stated
/// standard deviation of a reconstructed person's links. They come from other messages of the same
/// server, as far as the recording has been read.
class RowNotes {
 public:
  /// A session of a server: its metadata relates the server's clock to wall time.
  void TakeSession(const mcap::TextMap& values);
  /// Remembers the roles in .../status and the names in .../skeletons; of other topics nothing.
  void Take(const std::string& topic, std::string_view bytes);
  /// Seconds count from the earliest time taken.
  void TakeTime(std::uint64_t log_time_ns);

  /// The names of the columns for rows of this type (null: the message has one row).
  std::vector<std::string> Columns(const google::protobuf::Descriptor* row) const;
  /// The role of the device that a row is about, such as "left_board"; empty where none is known.
  std::string Role(const std::string& topic, const google::protobuf::Descriptor* row,
                   const google::protobuf::Message* entry) const;
  /// The stated standard deviations of the orientations in a table of a reconstructed person's
  /// rows, as text; empty for every other table.
  std::string DeviationNote(const std::string& topic,
                            const google::protobuf::Descriptor* row) const;
  /// The cells of a row, each with a comma in front. `entry` is null for a message with one row.
  std::string Cells(const std::string& topic, const google::protobuf::Descriptor* row,
                    const google::protobuf::Message* entry, std::uint64_t log_time_ns) const;

 private:
  struct Server {
    bool has_wall_time = false;
    std::int64_t wall_minus_host_ns = 0;
    std::map<std::uint32_t, std::string> roles;
    std::vector<std::string> links;
    std::vector<std::string> contacts;
    std::vector<double> orientation_sd_rad;  ///< Of a reconstructed person, as many as links.
  };

  const Server& ServerAt(const std::string& topic) const;

  std::map<std::string, Server> servers_;
  std::uint64_t first_ns_ = UINT64_MAX;
  std::size_t most_links_ = 0;
  std::size_t most_contacts_ = 0;
  std::size_t most_deviations_ = 0;
};

}  // namespace footing::log_client

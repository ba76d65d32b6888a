#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <google/protobuf/message.h>

#include "clients/log/csv_table.h"
#include "common/base/result.h"
#include "common/recording/mcap_reader.h"
#include "common/recording/mcap_records.h"
#include "common/recording/recording_writer.h"

namespace footing::log_client {

/// One exported table.
struct ExportedFile {
  std::string topic;
  std::string path;
  std::uint64_t rows = 0;
  std::uint64_t mended_times = 0;  ///< Rows that were given a later time (RisingTimes).
};

/// Makes the times of one series of samples rise strictly, as readers of other programs require.
///
/// A device sends the sample that its sensor holds more than once, and recordings of before
/// footingd dated the frames of one burst have hands that go back by some milliseconds. Such a
/// sample gets the earliest later time: 1 us behind the one before, which a double holds for
/// decades after the host's boot.
class RisingTimes {
 public:
  std::int64_t Next(std::int64_t time_ns) {
    const bool rises = !newest_ns_ || time_ns > *newest_ns_;
    mended_ += rises ? 0 : 1;
    newest_ns_ = rises ? time_ns : *newest_ns_ + kStepNs;
    return *newest_ns_;
  }
  /// Times that were not later than the one before.
  std::uint64_t mended() const { return mended_; }

 private:
  static constexpr std::int64_t kStepNs = 1000;

  std::optional<std::int64_t> newest_ns_;
  std::uint64_t mended_ = 0;
};

/// Writes one CSV file a topic into `folder` (made if it is not there): log_time_ns,
/// publish_time_ns, sequence, then the columns of CsvTable. The times `sampled_ns` of each source
/// rise strictly. A recording that is cut short or
/// damaged is InvalidData that names the repair, and nothing is written; an existing file is a
/// usage error, unless `replace`.
///
/// `tidy` writes fewer columns for statistics programs: time_s (of the sample, from the recording's
/// start), sequence, device_role, and the message's own, with the names of joints in place of their
/// numbers and the unit last ("lfemur_position_x_m"), rounded to 1e-6. Beside the tables stands
/// codebook.json, which has the unit, the type and the levels of each column.
Result<std::vector<ExportedFile>> ExportCsv(const std::string& recording, const std::string& folder,
                                            bool replace, bool tidy = false);

/// Makes the folder of an export, and those above it, where they are not there. Failure says why.
inline Result<void> MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Failure("cannot make the folder " + folder + ": " + error.message());
  return {};
}

/// The folder as a shell's completion leaves it, without the slashes at its end.
inline std::string WithoutEndSlashes(std::string folder) {
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  return folder;
}

/// Columns of an exported row beside its message: its time in seconds and as wall time, the role of
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
  /// The column's name with the joint or contact point that it is about in place of its number.
  std::string Named(const std::string& topic, const std::string& column) const;
  /// Time since the earliest one taken, in whole microseconds, ns.
  std::int64_t SinceFirstNs(std::int64_t time_ns) const;

 private:
  struct Server {
    bool has_wall_time = false;
    std::int64_t wall_minus_host_ns = 0;
    std::map<std::uint32_t, std::string> roles;
    std::vector<std::string> links;
    std::vector<std::string> contacts;
    std::vector<double> orientation_sd_rad;  ///< One per link of a reconstructed person.
  };

  const Server& ServerAt(const std::string& topic) const;

  std::map<std::string, Server> servers_;
  std::uint64_t first_ns_ = UINT64_MAX;
  std::size_t most_links_ = 0;
  std::size_t most_contacts_ = 0;
  std::size_t most_deviations_ = 0;
};

/// When a row was, ns of the server's clock: the sample's own time where it has one, else the
/// tick's. Null is the row of a message that has one row.
std::int64_t TimeOf(const mcap::Message& record, const google::protobuf::Message* row);

/// One topic of a recording, whose messages are rows of a table.
struct TopicTable {
  std::string topic;
  std::uint16_t schema_id = 0;
  std::optional<CsvTable> table;  ///< Nothing when the topic has no message.
  std::uint64_t messages = 0;     ///< Found by the first pass, ...
  std::uint64_t shown = 0;        ///< ... and by the second.
  std::uint64_t newest_ns = 0;
  /// Messages that are older than one before them: their place in the topic, and their time.
  std::map<std::uint64_t, std::uint64_t> steps_back = {};
};

/// The messages of a recording as rows of tables, one table a topic, in two passes: the first
/// learns the columns, roles and names, the second visits the messages of each topic in the order
/// of their log times. A recording of a server's ring begins with the server's present state: it
/// comes where the ring reaches it, and once if the ring has it, too.
class Tables {
 public:
  /// `bytes` of the recording stay valid as long as this; `path` names it in errors.
  Tables(std::string_view bytes, std::string path) : bytes_(bytes), path_(std::move(path)) {}

  /// The first pass. InvalidData where the recording is cut short or damaged, or a message does not
  /// fit its schema.
  Result<void> Learn();

  /// Ends at the first failure. `channel` is the topic's key in topics().
  using Visit = std::function<Result<void>(std::uint16_t channel, const mcap::Message& record,
                                           google::protobuf::Message& message)>;
  Result<void> Walk(const Visit& visit);

  /// Topics by MCAP channel id.
  const std::map<std::uint16_t, TopicTable>& topics() const { return topics_; }
  /// Notes on the whole recording after Learn(); during Walk(), on the part read so far.
  const RowNotes& notes() const { return notes_; }
  /// Descriptions of the streams of LSL, XML, by topic; after Learn().
  const std::map<std::string, std::string>& lsl() const { return lsl_; }

 private:
  /// A message that waits for older ones of its topic.
  struct Held {
    mcap::Message record;
    std::string data;
  };

  google::protobuf::Message* Parse(const TopicTable& topic, const mcap::Message& record);
  void Show(const mcap::Message& record, const Visit& visit);
  /// Shows those of one topic that are older than this.
  void ShowHeld(std::vector<Held>& held, std::uint64_t before_ns, const Visit& visit);
  /// Keeps the first failure.
  void Fail(Result<void> result) {
    if (!result && first_failure_) first_failure_ = std::move(result);
  }

  std::string_view bytes_;
  std::string path_;
  recording::SchemaPool pool_;
  RowNotes notes_;
  std::map<std::uint16_t, TopicTable> topics_;
  std::map<std::uint16_t, std::vector<Held>> held_;
  std::map<std::string, std::string> lsl_;
  Result<void> first_failure_;
};

/// Options of an export in the form of BIDS-motion.
struct BidsOptions {
  std::string subject;  ///< Letters and digits; empty: "01".
  std::string task;     ///< Letters and digits; empty: those of the recording's name.
  bool replace = false;
  std::string version;
};

/// Exported motion of one tracking system.
struct ExportedTable {
  std::string path;  ///< Path of the motion file.
  std::string tracking_system;
  std::size_t channels = 0;
  std::size_t samples = 0;
  std::size_t mended_times = 0;  ///< Samples that were given a later time.
};

/// Result of an export in the form of BIDS-motion.
struct ExportedBids {
  std::vector<ExportedTable> tables;
  std::size_t events = 0;
};

/// Adds a recording to the data set `folder`, in the form of BIDS-motion, as one task of one
/// subject: samples of the devices, frames of footing-sim, events. Makes the data set where there
/// is none; other subjects and tasks in it stay. A label that has other signs than letters and
/// digits is a usage error, and so is a file that exists, unless `replace`. InvalidData where the
/// recording has nothing of this.
Result<ExportedBids> ExportBids(const std::string& recording, const std::string& folder,
                                const BidsOptions& options);

/// One topic of a recording; times in ns on the recorder's clock.
struct Topic {
  std::string name;
  std::string schema;
  std::uint64_t messages = 0;
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;

  /// Mean rate between the first and the last message, Hz; 0 for fewer than two.
  double RateHz() const;
};

/// One attachment of a recording, without its bytes.
struct AttachmentNote {
  std::string name;
  std::string media_type;
  std::uint64_t bytes = 0;
};

/// Summary of a recording: topics, attachments, time span and gaps.
struct Contents {
  std::string path;
  std::uint64_t bytes = 0;
  std::string library;
  std::vector<Topic> topics;  ///< By name.
  std::vector<AttachmentNote> attachments;
  std::vector<mcap::Metadata> metadata;
  std::uint64_t messages = 0;
  std::uint64_t start_ns = 0;
  std::uint64_t end_ns = 0;
  /// Some device or input of a character was simulated; nothing when no message says.
  std::optional<bool> simulated;
  /// Last EffectiveConfig that each footing-sim reported, JSON.
  std::vector<std::string> configs;
  std::uint64_t gaps = 0;
  std::uint64_t missing_ticks = 0;
  /// Gaps over a restart of a server: nobody knows how many ticks are missing there.
  std::uint64_t restarts = 0;
  double missing_s = 0;  ///< Time of the missing ticks.
  double restart_s = 0;  ///< From the last tick before each restart to the first one after it.
  mcap::WalkEnd end;
};

/// Reads a whole recording, cut ones as far as they go. InvalidData only when it is none at all.
Result<Contents> ReadContents(const std::string& path);

/// Error that describes an incomplete recording; nothing when it is complete.
std::optional<Error> Incomplete(const std::string& path, const mcap::WalkEnd& end);

}  // namespace footing::log_client

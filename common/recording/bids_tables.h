#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/recording/recorded_session.h"
#include "common/rig/follower.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/session.pb.h"

/// The files of a data set in the form of BIDS-motion (Brain Imaging Data Structure 1.9.0): tables
/// are tab-separated, what is missing is "n/a".
namespace footing::bids {

/// A row of channels.tsv, in the words of the standard.
struct Channel {
  std::string name;
  std::string component;      ///< "x", "quat_w", ...; "n/a".
  std::string type;           ///< "POS", "ORNT", "ACCEL", "GYRO", "VEL", "LATENCY", "MISC".
  std::string tracked_point;  ///< Role of the device, "body", or a joint.
  std::string units;
};

/// Measurements of one tracking system: a device, or the simulation.
struct MotionTable {
  std::string tracksys;      ///< Letters and digits.
  std::string manufacturer;  ///< Kind of the device; "Footing" for the simulation.
  std::vector<Channel> channels;
  std::vector<double> cells;  ///< Row by row, as many as channels; NaN: missing.
  /// More fields of motion.json.
  nlohmann::ordered_json notes = nlohmann::ordered_json::object();
  std::size_t mended_times = 0;  ///< Rows whose time was not later than the one before.
};

/// The time of each row, s.
Channel Latency();
/// Channels NAME_x, NAME_y, NAME_z.
void AddVector(const std::string& name, const std::string& type, const std::string& point,
               const std::string& units, MotionTable& table);
void Append(std::initializer_list<double> values, MotionTable& table);
/// The time of the next row of a table whose first channel is Latency(), s: this, or one step of
/// the file's resolution behind the last row where it would not be later in the file.
double RisingTime(double time_s, MotionTable& table);

/// Something that happened at an instant.
struct Event {
  double onset_s = 0;      ///< On the time of the column latency.
  std::string trial_type;  ///< Such as "failure_curve".
  bool counts = true;      ///< False: a failure that was undone.
  /// A client's marker, whose text is the type, and its value.
  bool is_marker = false;
  std::optional<double> value = std::nullopt;
  double duration_s = 0;
};

/// Text of a table: cells that are empty become "n/a", tabs and line ends blanks.
std::string Tsv(const std::vector<std::vector<std::string>>& rows);

/// Contents of channels.tsv: name, type, tracked point and units of every channel.
std::string ChannelsTsv(const MotionTable& table);
/// Without a header, as the standard asks.
std::string MotionTsv(const MotionTable& table);
/// Rows over the time between the first and the last of them, Hz; 0 for fewer than two.
double SamplingRateHz(const MotionTable& table);
nlohmann::ordered_json MotionJson(const MotionTable& table, const std::string& task,
                                  const std::string& task_description);

/// A file of a data set.
struct File {
  std::string name;
  std::string text;
};
/// The three files of a table, of which the first has the motion: "sub-01_task-walk" and "_run-1"
/// give "sub-01_task-walk_tracksys-sim_run-1_motion.tsv", "..._motion.json", "..._channels.tsv".
std::vector<File> MotionFiles(const MotionTable& table, const std::string& stem,
                              const std::string& run, const std::string& task,
                              const std::string& task_description);
/// "dataset_description.json", written by a `program` of this version.
File DescriptionFile(const std::string& name, const std::string& program,
                     const std::string& version);
/// Events by time in which a marker "begin NAME" and the next "end NAME" are one event NAME, which
/// lasts from one to the other.
std::vector<Event> WithSpans(const std::vector<Event>& events);

/// With a column `value` where there are markers.
std::string EventsTsv(const std::vector<Event>& events);
/// STEM_events.tsv, and STEM_events.json that says what its columns mean.
std::vector<File> EventFiles(const std::vector<Event>& events, const std::string& stem);
/// A column of a codebook; without units where `units` is empty.
nlohmann::ordered_json Column(const std::string& description, const std::string& units = "");

/// With letters and digits alone, as names of files need it: "wrist.straight1" is "wriststraight1".
std::string LabelOf(const std::string& name);
/// Instants in a data set count from the start of 1900, so that nobody takes them for real ones:
/// "1900-01-01T00:01:30" after 90 s.
std::string ShiftedTime(double seconds);

/// An instant of a server's clock on the wall clock of the recorder's host, on which all servers
/// agree; 0 where the recording's times are not those of a host.
std::int64_t WallNs(const recording::RecordedServer& server, std::int64_t host_ns);

/// Seconds since the start of a data set's run, of an instant on a server's clock.
class RunClock {
 public:
  /// InvalidData where the recording's times are not those of a host.
  static Result<RunClock> Of(const recording::RecordedServer& server, std::int64_t zero_wall_ns);
  /// NaN for an instant that no clock can show.
  double operator()(std::int64_t host_ns) const;

 private:
  std::int64_t offset_ns_ = 0;
};

/// The samples of devices, a table for each of what they are: a Wiimote and its Nunchuk have one
/// each, and so has each hand that a tracker sees. They are named by their roles, of another rig
/// than "main" with its name before; never by their serials. A device without a role is named by
/// its kind and its number in the recording.
class DeviceTables {
 public:
  /// `with_role` leaves out devices that have no role.
  explicit DeviceTables(bool with_role) : with_role_(with_role) {}

  /// From now on all data are of this start of a server, which gives devices its own numbers.
  /// Samples of before the run are left out.
  void Start(const RunClock& clock);
  void Add(const rig::Tick& tick);

  const std::map<std::string, MotionTable>& tables() const { return tables_; }

 private:
  /// Null: a device that is left out, or a sample of before the run. Sets `point_` and `time_s_`:
  /// of the sample, or of its tick where it does not say.
  MotionTable* Find(std::uint32_t device, std::int64_t sampled_ns, const std::string& part);
  MotionTable* Find(const std::string& point, const std::string& maker, std::int64_t sampled_ns,
                    const std::string& part);
  void AddMotion(const stream::MotionSample& one);
  void AddBoard(const stream::BoardSample& one);
  void AddStick(const stream::NunchukSample& one);
  void AddHand(const stream::HandSample& one);

  bool with_role_;
  RunClock clock_;
  std::map<std::string, MotionTable> tables_;
  rig::Follower sensors_;
  std::int64_t tick_ns_ = 0;
  double time_s_ = 0;
  std::string point_;
};

/// The frames of footing-sim: "sim" for a character of the gaits, "body" for a reconstructed person
/// from the T-pose on. Of several characters the first.
class CharacterTables {
 public:
  void Add(double time_s, const v1::Tick& tick);
  /// Those with a row, without their contents: once.
  std::vector<MotionTable> Take();

 private:
  void AddBody(double time_s, const v1::Character& character);

  v1::Skeleton skeleton_;
  MotionTable sim_, body_;
};

/// Appends what a data set needs of a tick's events; `undone` has the failures that do not count.
void AddEvents(const v1::Tick& tick, const RunClock& clock, const std::set<std::uint64_t>& undone,
               std::vector<Event>& events);

}  // namespace footing::bids

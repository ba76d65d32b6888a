#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

/// What one tracking system measured: a device, or the simulation.
struct MotionTable {
  std::string tracksys;      ///< Letters and digits.
  std::string manufacturer;  ///< Kind of the device; "Footing" for the simulation.
  std::vector<Channel> channels;
  std::vector<double> cells;  ///< Row by row, as many as channels; NaN: missing.
  /// More fields of motion.json.
  nlohmann::ordered_json notes = nlohmann::ordered_json::object();
};

/// The time of each row, s.
Channel Latency();
/// Channels NAME_x, NAME_y, NAME_z.
void AddVector(const std::string& name, const std::string& type, const std::string& point,
               const std::string& units, MotionTable& table);
void Append(std::initializer_list<double> values, MotionTable& table);

/// Something that happened at an instant.
struct Event {
  double onset_s = 0;      ///< On the time of the column latency.
  std::string trial_type;  ///< Such as "failure_curve".
  bool counts = true;      ///< False: a failure that was undone.
};

/// Text of a table: cells that are empty become "n/a", tabs and line ends blanks.
std::string Tsv(const std::vector<std::vector<std::string>>& rows);

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

}  // namespace footing::bids

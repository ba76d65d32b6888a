#include "clients/log/contents.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <nlohmann/json.hpp>

#include "clients/log/lsl_in.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/angle_deviation.h"
#include "common/foxglove/scene.h"
#include "common/recording/bids_tables.h"
#include "common/recording/recorded_motion.h"
#include "common/recording/recorded_session.h"
#include "common/recording/recording_writer.h"
#include "common/runtime/files.h"
#include "common/stream/device.h"
#include "footing/v1/character.pb.h"
#include "footing/v1/device.pb.h"

namespace footing::log_client {
namespace {

constexpr std::size_t kWriteBytes = 1u << 20;

/// The topic's name as a file's: what is not a letter, a digit or '-' becomes '_'.
std::string FileName(const std::string& topic) {
  std::string name;
  for (const char c : topic.substr(
           topic.find_first_not_of('/') == std::string::npos ? 0 : topic.find_first_not_of('/'))) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
    name += plain ? c : '_';
  }
  return name.empty() ? "topic" : name;
}

/// One topic on its way into a file.
struct Sheet {
  std::optional<recording::OutputFile> file;
  std::string text;
  ExportedFile exported;
  std::map<std::string, RisingTimes> times;  ///< By what the samples are of.
  std::map<std::string, RisingTimes> tidy_times;
};

/// Source of a sample, as far as its row names it: a device, or a hand that a tracker sees.
std::string SeriesOf(const google::protobuf::Message& row) {
  std::string series;
  const google::protobuf::Reflection& fields = *row.GetReflection();
  for (const char* name : {"device", "rig", "role", "joint", "tracker", "source", "body"}) {
    const auto* field = row.GetDescriptor()->FindFieldByName(name);
    if (field == nullptr || field->is_repeated()) continue;
    using Field = google::protobuf::FieldDescriptor;
    if (field->cpp_type() == Field::CPPTYPE_UINT32) {
      series += std::to_string(fields.GetUInt32(row, field));
    } else if (field->cpp_type() == Field::CPPTYPE_ENUM) {
      series += std::to_string(fields.GetEnumValue(row, field));
    } else if (field->cpp_type() == Field::CPPTYPE_STRING) {
      series += fields.GetString(row, field);
    }
    series += '/';
  }
  return series;
}

/// Sets the times `sampled_ns` of a message's rows so that those of each source rise.
void Mend(const CsvTable& table, google::protobuf::Message& message, Sheet& sheet) {
  const auto* list = table.row_list();
  if (list == nullptr) return;
  const auto* time = list->message_type()->FindFieldByName("sampled_ns");
  if (time == nullptr || time->is_repeated() ||
      time->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_INT64) {
    return;
  }
  const google::protobuf::Reflection& fields = *message.GetReflection();
  for (int i = 0; i < fields.FieldSize(message, list); ++i) {
    google::protobuf::Message& row = *fields.MutableRepeatedMessage(&message, list, i);
    const std::int64_t time_ns = row.GetReflection()->GetInt64(row, time);
    if (time_ns == 0) continue;  // Not stated.
    const std::int64_t risen_ns = sheet.times[SeriesOf(row)].Next(time_ns);
    if (risen_ns == time_ns) continue;
    row.GetReflection()->SetInt64(&row, time, risen_ns);
    ++sheet.exported.mended_times;
  }
}

class CsvExporter {
 public:
  CsvExporter(std::string_view bytes, const std::string& path, bool tidy)
      : tables_(bytes, path), tidy_(tidy) {}

  Result<std::vector<ExportedFile>> Run(const std::string& folder, bool replace) {
    if (const Result<void> learned = tables_.Learn(); !learned) return learned.error();
    if (const Result<void> opened = Open(folder, replace); !opened) return opened.error();
    const Result<void> written =
        tables_.Walk([this](std::uint16_t channel, const mcap::Message& record,
                            google::protobuf::Message& message) {
          return WriteRows(tables_.topics().at(channel), record, message, sheets_[channel]);
        });
    if (!written) return written.error();
    std::vector<ExportedFile> files;
    for (auto& [channel, sheet] : sheets_) {
      if (const Result<void> end = sheet.file->Write(sheet.text); !end) return end.error();
      files.push_back(sheet.exported);
    }
    if (!tidy_) return files;
    const std::string path = folder + "/codebook.json";
    Result<recording::OutputFile> codebook = recording::OutputFile::Create(path, replace);
    if (!codebook) return codebook.error();
    if (const auto end = codebook->Write(codebook_.dump(2) + "\n"); !end) return end.error();
    files.push_back({"", path, 0, 0});
    return files;
  }

 private:
  Result<void> Open(const std::string& folder, bool replace) {
    if (const Result<void> made = MakeFolder(folder); !made) return made.error();
    std::set<std::string> taken;
    for (const auto& [channel, topic] : tables_.topics()) {
      if (!topic.table) continue;
      Sheet& sheet = sheets_[channel];
      std::string name = FileName(topic.topic);
      while (!taken.insert(name).second) name += "_";
      const std::string path = folder + "/" + name + ".csv";
      Result<recording::OutputFile> file = recording::OutputFile::Create(path, replace);
      if (!file) return file.error();
      sheet.file.emplace(std::move(*file));
      sheet.exported = {topic.topic, path, 0, 0};
      if (tidy_) {
        sheet.text = TidyHeader(topic, name + ".csv");
        continue;
      }
      const std::string columns = topic.table->Header();
      sheet.text = "log_time_ns,publish_time_ns,sequence" + (columns.empty() ? "" : "," + columns);
      for (const std::string& column : tables_.notes().Columns(topic.table->row_type())) {
        // The message's own column of that name comes first; ours says that it is a note.
        const bool is_own = ("," + columns + ",").find("," + column + ",") != std::string::npos;
        sheet.text += "," + (is_own ? "note_" + column : column);
      }
      sheet.text += "\n";
    }
    return {};
  }

  Result<void> WriteRows(const TopicTable& topic, const mcap::Message& record,
                         google::protobuf::Message& message, Sheet& sheet) {
    Mend(*topic.table, message, sheet);
    const std::size_t before = sheet.text.size();
    if (tidy_) {
      const auto begin = [&](const google::protobuf::Message* entry) {
        const std::string series = entry == nullptr ? "" : SeriesOf(*entry);
        const std::int64_t time_ns =
            sheet.tidy_times[series].Next(tables_.notes().SinceFirstNs(TimeOf(record, entry)));
        std::string cells = text::Fixed(NanosecondsToSeconds(time_ns), 6) + "," +
                            std::to_string(record.sequence) + ",";
        if (topic.table->row_type() == nullptr || !HasRole(topic)) return cells;
        return cells + tables_.notes().Role(topic.topic, topic.table->row_type(), entry) + ",";
      };
      topic.table->AppendRows(
          message, begin, [](const auto*) { return std::string(); }, sheet.text, kTidyDecimals);
    } else {
      const std::string prefix = std::to_string(record.log_time_ns) + "," +
                                 std::to_string(record.publish_time_ns) + "," +
                                 std::to_string(record.sequence) + ",";
      const auto end = [&](const google::protobuf::Message* entry) {
        return tables_.notes().Cells(topic.topic, topic.table->row_type(), entry,
                                     record.log_time_ns);
      };
      topic.table->AppendRows(
          message, [&prefix](const auto*) { return prefix; }, end, sheet.text);
    }
    sheet.exported.rows += static_cast<std::uint64_t>(std::count(
        sheet.text.begin() + static_cast<std::ptrdiff_t>(before), sheet.text.end(), '\n'));
    if (sheet.text.size() < kWriteBytes) return {};
    Result<void> written = sheet.file->Write(sheet.text);
    sheet.text.clear();
    return written;
  }

  bool HasRole(const TopicTable& topic) const {
    const std::vector<std::string> notes = tables_.notes().Columns(topic.table->row_type());
    return std::find(notes.begin(), notes.end(), "device_role") != notes.end();
  }

  /// The first line of a tidy table, whose columns go into the codebook.
  std::string TidyHeader(const TopicTable& topic, const std::string& file) {
    using Json = nlohmann::ordered_json;
    Json& columns = codebook_[file];
    std::string line;
    const auto add = [&](const std::string& name, const char* type, const std::string& what) {
      line += (line.empty() ? "" : ",") + name;
      columns[name] = {{"description", what}, {"type", type}};
      if (const std::string unit = UnitOf(name); !unit.empty()) columns[name]["unit"] = unit;
    };
    add("time_s", "number", "Time of the sample, or of its tick, from the recording's start");
    add("sequence", "integer", "Number of the tick: rows of one tick have the same");
    if (HasRole(topic)) add("device_role", "text", "Role of the device then");
    for (const CsvTable::Column& column : topic.table->AllColumns()) {
      using Field = google::protobuf::FieldDescriptor;
      const Field& field = *column.field;
      const bool is_real =
          field.cpp_type() == Field::CPPTYPE_DOUBLE || field.cpp_type() == Field::CPPTYPE_FLOAT;
      std::string name = UnitLast(tables_.notes().Named(topic.topic, column.name));
      while (columns.contains(name)) name = "message_" + name;
      add(name,
          field.enum_type() != nullptr              ? "category"
          : field.cpp_type() == Field::CPPTYPE_BOOL ? "flag"
          : is_real                                 ? "number"
          : column.is_number                        ? "integer"
                                                    : "text",
          field.full_name() + " (" + column.name + ")");
      if (field.enum_type() == nullptr) continue;
      Json& levels = columns[name]["levels"] = Json::array();
      for (int i = 0; i < field.enum_type()->value_count(); ++i) {
        levels.push_back(field.enum_type()->value(i)->name());
      }
    }
    return line + "\n";
  }

  static constexpr int kTidyDecimals = 6;

  Tables tables_;
  const bool tidy_;
  std::map<std::uint16_t, Sheet> sheets_;
  nlohmann::ordered_json codebook_ = nlohmann::ordered_json::object();  ///< By file and column.
};

}  // namespace

Result<std::vector<ExportedFile>> ExportCsv(const std::string& recording, const std::string& folder,
                                            bool replace, bool tidy) {
  Result<recording::MappedFile> file = recording::OpenRecording(recording);
  if (!file) return file.error();
  return CsvExporter(file->bytes(), recording, tidy).Run(folder, replace);
}

namespace {

namespace pb = google::protobuf;

/// SERVER of a topic "/SERVER/CHANNEL"; empty when the topic has another form.
std::string ServerOf(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos || slash == 0 ? "" : topic.substr(1, slash - 1);
}

std::int64_t NumberOf(const mcap::TextMap& values, const std::string& key) {
  const auto found = values.find(key);
  std::int64_t number = 0;
  if (found != values.end()) {
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
  }
  return number;
}

/// Rows of this type are about a device and do not say its role themselves.
const pb::FieldDescriptor* DeviceField(const pb::Descriptor* row) {
  if (row == nullptr || row->FindFieldByName("role") != nullptr) return nullptr;
  const pb::FieldDescriptor* field = row->FindFieldByName("device");
  const bool number = field != nullptr && !field->is_repeated() &&
                      field->cpp_type() == pb::FieldDescriptor::CPPTYPE_UINT32;
  return number ? field : nullptr;
}

bool IsCharacter(const pb::Descriptor* row) {
  return row != nullptr && row->full_name() == "footing.v1.Character";
}

void AppendNames(const std::vector<std::string>& names, std::size_t count, std::string& out) {
  for (std::size_t i = 0; i < count; ++i) {
    out += ',';
    if (i >= names.size()) continue;
    // A name comes from a motion file: what would break the row is left out.
    for (const char c : names[i]) {
      if (c != ',' && c != '"' && c != '\n' && c != '\r') out += c;
    }
  }
}

/// The stated deviations of the links of a reconstructed person; of others, whose orientations are
/// not estimates, none. A row does not say how far the knees are bent: the larger one counts.
std::vector<double> OrientationDeviations(const v1::Skeleton& skeleton) {
  std::vector<double> deviations;
  if (skeleton.name() != "person") return deviations;
  std::vector<std::string> names;
  std::vector<int> parents;
  for (const v1::Link& link : skeleton.links()) {
    names.push_back(link.name());
    parents.push_back(link.parent());
  }
  for (const body::AngleDeviation& link : body::DeviationsOfLinks(names, parents)) {
    deviations.push_back(DegreesToRadians(std::max(link.upright_deg, link.bent_deg)));
  }
  return deviations;
}

bool IsValid(const pb::Message* character) {
  if (character == nullptr) return false;
  const pb::FieldDescriptor* field = character->GetDescriptor()->FindFieldByName("valid");
  return field != nullptr && !field->is_repeated() &&
         field->cpp_type() == pb::FieldDescriptor::CPPTYPE_BOOL &&
         character->GetReflection()->GetBool(*character, field);
}

void AppendDeviations(const std::vector<double>& deviations, std::size_t count, bool valid,
                      std::string& out) {
  for (std::size_t i = 0; i < count; ++i) {
    out += ',';
    if (valid && i < deviations.size()) text::AppendFixed(out, deviations[i], 3);
  }
}

}  // namespace

void RowNotes::TakeSession(const mcap::TextMap& values) {
  const auto name = values.find("server");
  const std::int64_t wall_ns = NumberOf(values, "server_wall_time_ns");
  const std::int64_t host_ns = NumberOf(values, "server_host_ns");
  if (name == values.end() || wall_ns == 0 || !IsInstant(wall_ns) || !IsInstant(host_ns)) return;
  Server& server = servers_[name->second];
  server.has_wall_time = true;
  server.wall_minus_host_ns = wall_ns - host_ns;
}

void RowNotes::Take(const std::string& topic, std::string_view bytes) {
  const int size = static_cast<int>(bytes.size());
  if (topic.ends_with("/status")) {
    v1::DeviceStatusList list;
    if (!list.ParseFromArray(bytes.data(), size)) return;
    for (const v1::DeviceStatus& status : list.devices()) {
      const auto role = static_cast<stream::DeviceRole>(status.role());
      servers_[ServerOf(topic)].roles[status.device()] =
          status.role() == v1::DEVICE_ROLE_UNSPECIFIED ? "" : stream::Name(role);
    }
  } else if (topic.ends_with("/skeletons")) {
    v1::Skeletons skeletons;
    if (!skeletons.ParseFromArray(bytes.data(), size) || skeletons.skeletons_size() == 0) return;
    Server& server = servers_[ServerOf(topic)];
    const v1::Skeleton& skeleton = skeletons.skeletons(0);
    server.links.clear();
    for (const v1::Link& link : skeleton.links()) server.links.push_back(link.name());
    server.contacts.assign(skeleton.contact_points().begin(), skeleton.contact_points().end());
    server.orientation_sd_rad = OrientationDeviations(skeleton);
    most_deviations_ = std::max(most_deviations_, server.orientation_sd_rad.size());
    most_links_ = std::max(most_links_, server.links.size());
    most_contacts_ = std::max(most_contacts_, server.contacts.size());
  }
}

void RowNotes::TakeTime(std::uint64_t log_time_ns) { first_ns_ = std::min(first_ns_, log_time_ns); }

std::vector<std::string> RowNotes::Columns(const pb::Descriptor* row) const {
  std::vector<std::string> names = {"recording_time_s", "wall_time"};
  if (DeviceField(row) != nullptr) names.push_back("device_role");
  if (!IsCharacter(row)) return names;
  for (std::size_t i = 0; i < most_links_; ++i) {
    names.push_back("links_" + std::to_string(i) + "_name");
  }
  for (std::size_t i = 0; i < most_contacts_; ++i) {
    names.push_back("contacts_" + std::to_string(i) + "_name");
  }
  for (std::size_t i = 0; i < most_deviations_; ++i) {
    names.push_back("links_" + std::to_string(i) + "_orientation_sd_rad");
  }
  return names;
}

const RowNotes::Server& RowNotes::ServerAt(const std::string& topic) const {
  static const Server kUnknown;
  const auto found = servers_.find(ServerOf(topic));
  return found == servers_.end() ? kUnknown : found->second;
}

std::string RowNotes::Role(const std::string& topic, const pb::Descriptor* row,
                           const pb::Message* entry) const {
  const pb::FieldDescriptor* field = DeviceField(row);
  if (field == nullptr || entry == nullptr) return "";
  const Server& server = ServerAt(topic);
  const auto role = server.roles.find(entry->GetReflection()->GetUInt32(*entry, field));
  return role == server.roles.end() ? "" : role->second;
}

std::string RowNotes::DeviationNote(const std::string& topic, const pb::Descriptor* row) const {
  const Server& server = ServerAt(topic);
  if (!IsCharacter(row) || server.orientation_sd_rad.empty()) return "";
  std::string note = "orientation_sd_rad of links 0, 1, ...: ";
  for (std::size_t i = 0; i < server.orientation_sd_rad.size(); ++i) {
    if (i > 0) note += ", ";
    text::AppendFixed(note, server.orientation_sd_rad[i], 3);
  }
  return note + "; " + std::string(body::AngleDeviationSource());
}

std::string RowNotes::Cells(const std::string& topic, const pb::Descriptor* row,
                            const pb::Message* entry, std::uint64_t log_time_ns) const {
  const Server& server = ServerAt(topic);
  char seconds[40];
  std::snprintf(seconds, sizeof seconds, ",%.9f,",
                1e-9 * static_cast<double>(log_time_ns - std::min(first_ns_, log_time_ns)));
  std::string cells = seconds;
  if (server.has_wall_time && IsInstant(log_time_ns)) {
    cells += text::Utc(static_cast<std::int64_t>(log_time_ns) + server.wall_minus_host_ns, 6);
  }
  if (DeviceField(row) != nullptr) cells += ',' + Role(topic, row, entry);
  if (IsCharacter(row)) {
    AppendNames(server.links, most_links_, cells);
    AppendNames(server.contacts, most_contacts_, cells);
    AppendDeviations(server.orientation_sd_rad, most_deviations_, IsValid(entry), cells);
  }
  return cells;
}

std::string RowNotes::Named(const std::string& topic, const std::string& column) const {
  const Server& server = ServerAt(topic);
  for (const auto& [list, names] :
       {std::pair("links_", &server.links), std::pair("contacts_", &server.contacts)}) {
    if (!column.starts_with(list)) continue;
    const std::size_t begin = std::string_view(list).size();
    std::size_t number = 0;
    const auto [end, error] =
        std::from_chars(column.data() + begin, column.data() + column.size(), number);
    if (error != std::errc() || number >= names->size() || (*names)[number].empty()) continue;
    // A name comes from a motion file.
    std::string name;
    for (const char c : (*names)[number]) {
      name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    }
    return name + std::string(end, column.data() + column.size());
  }
  return column;
}

std::int64_t RowNotes::SinceFirstNs(std::int64_t time_ns) const {
  return (time_ns - static_cast<std::int64_t>(first_ns_)) / 1000 * 1000;
}

Result<void> Tables::Learn() {
  mcap::Visitor visitor;
  visitor.schema = [this](const mcap::Schema& schema) {
    if (const Result<void> added = pool_.Add(schema); !added) {
      Fail(InvalidData(path_ + ": " + added.error().message));
    }
  };
  visitor.channel = [this](const mcap::Channel& channel) {
    TopicTable& topic = topics_[channel.id];
    topic.topic = channel.topic;
    topic.schema_id = channel.schema_id;
  };
  visitor.metadata = [this](const mcap::Metadata& metadata) {
    if (metadata.name == "session") notes_.TakeSession(metadata.values);
    if (metadata.name != lsl::kStreamMetadata) return;
    const auto topic = metadata.values.find("topic"), info = metadata.values.find("info");
    if (topic != metadata.values.end() && info != metadata.values.end())
      lsl_.emplace(topic->second, info->second);
  };
  visitor.message = [this](const mcap::Message& record) {
    TopicTable& topic = topics_[record.channel_id];
    if (topic.topic.starts_with(foxglove_scene::kTopics)) return;
    if (record.log_time_ns < topic.newest_ns) {
      topic.steps_back[topic.messages] = record.log_time_ns;
    }
    topic.newest_ns = std::max(topic.newest_ns, record.log_time_ns);
    ++topic.messages;
    const google::protobuf::Message* parsed = Parse(topic, record);
    if (parsed == nullptr) return;
    notes_.TakeTime(record.log_time_ns);
    notes_.Take(topic.topic, record.data);
    if (!topic.table) topic.table.emplace(*parsed->GetDescriptor());
    Fail(topic.table->Learn(*parsed));
  };
  const mcap::WalkEnd end = mcap::Walk(bytes_, visitor, mcap::WalkMode::kStrict);
  if (!first_failure_) return first_failure_.error();
  if (const std::optional<Error> incomplete = Incomplete(path_, end)) return *incomplete;
  return {};
}

Result<void> Tables::Walk(const Visit& visit) {
  mcap::Visitor visitor;
  visitor.message = [&](const mcap::Message& record) {
    if (!first_failure_) return;
    TopicTable& topic = topics_[record.channel_id];
    if (topic.topic.starts_with(foxglove_scene::kTopics)) return;
    const auto& later = topic.steps_back;
    std::vector<Held>& held = held_[record.channel_id];
    const bool waits =
        std::any_of(later.upper_bound(topic.shown++), later.end(),
                    [&record](const auto& step) { return step.second < record.log_time_ns; });
    if (waits) {
      held.push_back({record, std::string(record.data)});
      return;
    }
    std::erase_if(held, [&record](const Held& one) {
      return one.record.log_time_ns == record.log_time_ns && one.record.sequence == record.sequence;
    });
    ShowHeld(held, record.log_time_ns, visit);
    Show(record, visit);
  };
  mcap::Walk(bytes_, visitor, mcap::WalkMode::kStrict);
  for (auto& [channel, held] : held_) ShowHeld(held, UINT64_MAX, visit);
  return first_failure_;
}

void Tables::ShowHeld(std::vector<Held>& held, std::uint64_t before_ns, const Visit& visit) {
  std::stable_sort(held.begin(), held.end(), [](const Held& one, const Held& other) {
    return one.record.log_time_ns < other.record.log_time_ns;
  });
  while (!held.empty() && held.front().record.log_time_ns < before_ns) {
    mcap::Message record = held.front().record;
    record.data = held.front().data;
    Show(record, visit);
    held.erase(held.begin());
  }
}

void Tables::Show(const mcap::Message& record, const Visit& visit) {
  const TopicTable& topic = topics_[record.channel_id];
  google::protobuf::Message* parsed = Parse(topic, record);
  if (parsed == nullptr) return;
  notes_.Take(topic.topic, record.data);
  Fail(visit(record.channel_id, record, *parsed));
}

google::protobuf::Message* Tables::Parse(const TopicTable& topic, const mcap::Message& record) {
  google::protobuf::Message* parsed = pool_.Parse(topic.schema_id, record.data);
  if (parsed == nullptr) {
    Fail(InvalidData(path_ + ": a message on " + topic.topic + " does not fit its schema"));
  }
  return parsed;
}

namespace {

constexpr const char* kReadme =
    "Motion and events of recordings, written by footing-log.\n"
    "\n"
    "Each recording is a task of a subject. The tracking system body is the reconstructed person:\n"
    "a place and an orientation of each joint; sim is a simulated character (gaits: 1 step, 2 "
    "walk,\n"
    "3 run, 4 jump). Hands whose names end in tracked were seen by a tracker. All of these have x\n"
    "forward, y left, z up, right-handed. Every other tracking system is a device, in its own "
    "frame\n"
    "(x left, y front, z down), named by where it was worn. The channel latency has the time of\n"
    "each sample from the start of the recording; all systems of a recording share it, and so do\n"
    "the events.\n";

class DataSet {
 public:
  DataSet(std::string folder, const BidsOptions& options)
      : folder_(std::move(folder)), options_(options) {}

  Result<ExportedBids> Add(const bids::RecordedMotion& motion, const std::string& label,
                           const std::string& task, const std::string& recording) {
    const std::string subject = "sub-" + label;
    const std::string stem = subject + "_task-" + task;
    const std::string motions = folder_ + "/" + subject + "/motion";
    if (const auto made = MakeFolder(motions); !made) return made.error();
    ExportedBids exported;
    exported.events = motion.events.size();
    for (const bids::MotionTable& table : motion.tables) {
      const auto files = bids::MotionFiles(table, stem, "", task, "Recording " + recording);
      for (const bids::File& file : files) {
        if (const auto done = Write(motions, file, options_.replace); !done) return done.error();
      }
      exported.tables.push_back({motions + "/" + files.front().name, table.tracksys,
                                 table.channels.size(), table.cells.size() / table.channels.size(),
                                 table.mended_times});
    }
    for (const bids::File& file : bids::EventFiles(motion.events, stem)) {
      if (const auto done = Write(motions, file, options_.replace); !done) return done.error();
    }
    if (const auto done = WriteTop(subject); !done) return done.error();
    return exported;
  }

 private:
  static Result<void> Write(const std::string& folder, const bids::File& file, bool replace) {
    auto out = recording::OutputFile::Create(folder + "/" + file.name, replace);
    if (!out) return out.error();
    return out->Write(file.text);
  }

  /// The files of the whole data set, where they are missing, and the subject in its list.
  Result<void> WriteTop(const std::string& subject) const {
    for (const bids::File& file :
         {bids::DescriptionFile("Recordings", "footing-log", options_.version),
          bids::File{"README", kReadme}}) {
      if (std::filesystem::exists(folder_ + "/" + file.name)) continue;
      if (const auto done = Write(folder_, file, false); !done) return done.error();
    }
    const std::string list = folder_ + "/participants.tsv";
    std::string text = "participant_id\n";
    if (std::filesystem::exists(list)) {
      const auto read = config::ReadTextFile(list);
      if (!read) return read.error();
      text = *read;
    }
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.substr(0, line.find('\t')) == subject) return {};
    }
    if (!text.ends_with('\n')) text += '\n';
    const std::string header = text.substr(0, text.find('\n'));
    const auto more = std::count(header.begin(), header.end(), '\t');  // Columns added by somebody.
    text += subject;
    for (auto i = more; i > 0; --i) text += "\tn/a";
    return Write(folder_, {"participants.tsv", text + "\n"}, true);
  }

  std::string folder_;
  const BidsOptions& options_;
};

}  // namespace

Result<ExportedBids> ExportBids(const std::string& recording, const std::string& folder,
                                const BidsOptions& options) {
  const std::string name = std::filesystem::path(recording).stem().string();
  const std::string subject = options.subject.empty() ? "01" : options.subject;
  const std::string task = options.task.empty() ? bids::LabelOf(name) : options.task;
  for (const auto& [option, label] : {std::pair("--subject", subject), {"--task", task}}) {
    if (label.empty() || bids::LabelOf(label) != label) {
      return UsageError(std::string(option) + " '" + label +
                        "' cannot be a label of a data set: use letters and digits");
    }
  }
  const auto session = recording::RecordedSession::Open(recording);
  if (!session) return session.error();
  const auto motion = bids::ReadMotion(*session, {.markers = true});
  if (!motion) return motion.error();
  if (motion->tables.empty()) {
    return InvalidData(recording +
                       " has no samples of devices or tracked hands and no frame of footing-sim");
  }
  return DataSet(folder, options).Add(*motion, subject, task, name);
}

namespace {

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The value of the flags named `simulated` or `simulated_input` in the list of the message:
/// nothing without such a flag, true if any is set.
std::optional<bool> FindSimulated(const pb::Message& message) {
  std::optional<bool> found;
  const pb::Descriptor& type = *message.GetDescriptor();
  const pb::Reflection& fields = *message.GetReflection();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor* list = type.field(i);
    if (!list->is_repeated() || list->message_type() == nullptr) continue;
    for (int k = 0; k < fields.FieldSize(message, list); ++k) {
      const pb::Message& entry = fields.GetRepeatedMessage(message, list, k);
      for (const char* name : {"simulated", "simulated_input"}) {
        const pb::FieldDescriptor* flag = entry.GetDescriptor()->FindFieldByName(name);
        if (flag == nullptr || flag->is_repeated() ||
            flag->cpp_type() != pb::FieldDescriptor::CPPTYPE_BOOL) {
          continue;
        }
        found = found.value_or(false) || entry.GetReflection()->GetBool(entry, flag);
      }
    }
  }
  return found;
}

std::uint64_t Unsigned(const pb::Message& message, const char* name) {
  const pb::FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated() ||
      field->cpp_type() != pb::FieldDescriptor::CPPTYPE_UINT64) {
    return 0;
  }
  return message.GetReflection()->GetUInt64(message, field);
}

std::string Text(const pb::Message& message, const char* name) {
  const pb::FieldDescriptor* field = message.GetDescriptor()->FindFieldByName(name);
  if (field == nullptr || field->is_repeated() ||
      field->cpp_type() != pb::FieldDescriptor::CPPTYPE_STRING) {
    return "";
  }
  return message.GetReflection()->GetString(message, field);
}

/// How long the gaps of one server are, from the ticks around them, in the order of the file.
class Losses {
 public:
  void OnMessage(std::uint64_t time_ns, std::uint32_t sequence) {
    if (time_ns == newest_.time_ns && sequence == newest_.sequence) return;
    previous_ = std::exchange(newest_, {time_ns, sequence});
    // Behind a snapshot of the present come the ticks of the ring, which are older.
    if (open_ && time_ns > before_ns_ && (after_ns_ == 0 || time_ns < after_ns_)) {
      after_ns_ = time_ns;
    }
  }

  void OnGap(std::uint64_t time_ns, std::uint64_t from, std::uint64_t to) {
    Close();
    // The last tick before it has the sequence before the first missing one; a snapshot may have
    // come in between, which is then the first tick after it.
    const auto last = static_cast<std::uint32_t>(from - 1);
    const Tick& before =
        newest_.sequence != last && previous_.sequence == last ? previous_ : newest_;
    before_ns_ = before.time_ns;
    after_ns_ = time_ns > before_ns_ ? time_ns : 0;
    missing_ = to >= from ? to - from + 1 : 0;
    open_ = before_ns_ > 0;
  }

  /// Adds the last gap to the sums.
  void Close() {
    if (!std::exchange(open_, false) || after_ns_ <= before_ns_) return;
    const double between_s =
        NanosecondsToSeconds(static_cast<std::int64_t>(after_ns_ - before_ns_));
    if (missing_ == 0) {
      restart_s_ += between_s;
    } else {
      missing_s_ += between_s * static_cast<double>(missing_) / static_cast<double>(missing_ + 1);
    }
  }

  double missing_s() const { return missing_s_; }
  double restart_s() const { return restart_s_; }

 private:
  struct Tick {
    std::uint64_t time_ns = 0;
    std::uint32_t sequence = 0;
  };

  Tick newest_, previous_;
  bool open_ = false;
  std::uint64_t before_ns_ = 0, after_ns_ = 0, missing_ = 0;
  double missing_s_ = 0, restart_s_ = 0;
};

/// The beginning of a topic: "/footingd" for "/footingd/motion".
std::string BeforeChannel(const std::string& topic) { return topic.substr(0, topic.find('/', 1)); }

/// Fills Contents as the walk shows it.
class Collector {
 public:
  explicit Collector(Contents& contents) : contents_(contents) {}

  mcap::Visitor Visitor() {
    mcap::Visitor visitor;
    visitor.header = [this](const mcap::Header& h) { contents_.library = h.library; };
    visitor.schema = [this](const mcap::Schema& schema) {
      names_[schema.id] = schema.name;
      // A schema that makes no sense is export's matter: its messages are only counted here.
      if (!pool_.Add(schema)) names_[schema.id] += " (unreadable)";
    };
    visitor.channel = [this](const mcap::Channel& channel) {
      Topic topic;
      topic.name = channel.topic;
      topic.schema = names_[channel.schema_id];
      topics_[channel.id] = {topic, channel.schema_id};
    };
    visitor.message = [this](const mcap::Message& message) { Count(message); };
    visitor.attachment = [this](const mcap::Attachment& a) {
      contents_.attachments.push_back({a.name, a.media_type, a.data.size()});
    };
    visitor.metadata = [this](const mcap::Metadata& m) { contents_.metadata.push_back(m); };
    return visitor;
  }

  void Finish() {
    for (auto& [server, losses] : losses_) {
      losses.Close();
      contents_.missing_s += losses.missing_s();
      contents_.restart_s += losses.restart_s();
    }
    for (auto& [topic, config] : configs_) contents_.configs.push_back(std::move(config));
    for (const auto& [id, entry] : topics_) contents_.topics.push_back(entry.topic);
    std::sort(contents_.topics.begin(), contents_.topics.end(),
              [](const Topic& a, const Topic& b) { return a.name < b.name; });
  }

 private:
  struct Entry {
    Topic topic;
    std::uint16_t schema_id = 0;
    Losses* losses = nullptr;  ///< Those of its server.
  };

  void Count(const mcap::Message& message) {
    Entry& entry = topics_[message.channel_id];
    Topic& topic = entry.topic;
    const std::uint64_t time = message.log_time_ns;
    topic.first_ns = topic.messages == 0 ? time : std::min(topic.first_ns, time);
    topic.last_ns = std::max(topic.last_ns, time);
    ++topic.messages;
    contents_.start_ns = contents_.messages == 0 ? time : std::min(contents_.start_ns, time);
    contents_.end_ns = std::max(contents_.end_ns, time);
    ++contents_.messages;
    if (entry.losses == nullptr) entry.losses = &losses_[BeforeChannel(topic.name)];
    const bool is_gap = EndsWith(topic.name, "/gaps");
    if (!is_gap) entry.losses->OnMessage(time, message.sequence);
    if (EndsWith(topic.name, "/status") || EndsWith(topic.name, "/characters")) {
      if (const pb::Message* parsed = Parse(entry, message)) {
        const std::optional<bool> simulated = FindSimulated(*parsed);
        if (simulated) contents_.simulated = contents_.simulated.value_or(false) || *simulated;
      }
    } else if (EndsWith(topic.name, "/config")) {
      if (const pb::Message* parsed = Parse(entry, message)) {
        configs_[topic.name] = Text(*parsed, "json");
      }
    } else if (is_gap) {
      ++contents_.gaps;
      if (const pb::Message* parsed = Parse(entry, message)) {
        const std::uint64_t from = Unsigned(*parsed, "from_sequence");
        const std::uint64_t to = Unsigned(*parsed, "to_sequence");
        entry.losses->OnGap(time, from, to);
        if (to >= from)
          contents_.missing_ticks += to - from + 1;
        else
          ++contents_.restarts;
      }
    }
  }

  const pb::Message* Parse(const Entry& entry, const mcap::Message& message) {
    return pool_.Parse(entry.schema_id, message.data);
  }

  Contents& contents_;
  recording::SchemaPool pool_;
  std::map<std::uint16_t, std::string> names_;
  std::map<std::uint16_t, Entry> topics_;
  std::map<std::string, std::string> configs_;  ///< By topic.
  std::map<std::string, Losses> losses_;        ///< By server.
};

}  // namespace

double Topic::RateHz() const {
  if (messages < 2 || last_ns <= first_ns) return 0;
  return 1e9 * static_cast<double>(messages - 1) / static_cast<double>(last_ns - first_ns);
}

std::optional<Error> Incomplete(const std::string& path, const mcap::WalkEnd& end) {
  if (end.complete) return std::nullopt;
  const std::string what = end.cut ? " is cut short" : " is damaged";
  return InvalidData(path + what + " at byte " + std::to_string(end.problem_offset) + " (" +
                     end.problem + "); 'footing-log repair " + path +
                     " --out NEW.mcap' keeps every complete message");
}

Result<Contents> ReadContents(const std::string& path) {
  Result<recording::MappedFile> file = recording::OpenRecording(path);
  if (!file) return file.error();
  Contents contents;
  contents.path = path;
  contents.bytes = file->bytes().size();
  Collector collector(contents);
  contents.end = mcap::Walk(file->bytes(), collector.Visitor(), mcap::WalkMode::kSalvage);
  collector.Finish();
  return contents;
}

}  // namespace footing::log_client

#include "common/recording/bids_tables.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/body/angle_deviation.h"
#include "common/stream/device.h"
#include "common/stream/gait.h"
#include "common/stream/trial.h"
#include "common/wire/wire.h"

namespace footing::bids {
namespace {

using nlohmann::ordered_json;

constexpr const char* kNotAvailable = "n/a";
constexpr int kDecimals = 6;
constexpr double kSteps = 1e6;  // In a unit, of that many decimals.

}  // namespace

Channel Latency() { return {"latency", "n/a", "LATENCY", "n/a", "s"}; }

void AddVector(const std::string& name, const std::string& type, const std::string& point,
               const std::string& units, MotionTable& table) {
  for (const char* component : {"x", "y", "z"}) {
    table.channels.push_back({name + "_" + component, component, type, point, units});
  }
}

void Append(std::initializer_list<double> values, MotionTable& table) {
  table.cells.insert(table.cells.end(), values);
}

double RisingTime(double time_s, MotionTable& table) {
  if (table.cells.empty()) return time_s;
  const double last_s = table.cells[table.cells.size() - table.channels.size()];
  const double next = std::round(last_s * kSteps) + 1;
  if (!(std::round(time_s * kSteps) < next)) return time_s;
  ++table.mended_times;
  return next / kSteps;
}

std::string Tsv(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += '\t';
      if (row[i].empty()) text += kNotAvailable;
      for (const char c : row[i]) text += c == '\t' || c == '\n' || c == '\r' ? ' ' : c;
    }
    text += '\n';
  }
  return text;
}

std::string ChannelsTsv(const MotionTable& table) {
  const std::string rate_hz = text::Fixed(SamplingRateHz(table), 3);
  std::vector<std::vector<std::string>> rows = {
      {"name", "component", "type", "tracked_point", "units", "sampling_frequency"}};
  for (const Channel& one : table.channels) {
    rows.push_back({one.name, one.component, one.type, one.tracked_point, one.units, rate_hz});
  }
  return Tsv(rows);
}

std::string MotionTsv(const MotionTable& table) {
  std::string text;
  const std::size_t columns = table.channels.size();
  for (std::size_t i = 0; i < table.cells.size(); ++i) {
    if (std::isfinite(table.cells[i])) {
      text::AppendFixed(text, table.cells[i], kDecimals);
    } else {
      text += kNotAvailable;
    }
    text += (i + 1) % columns == 0 ? '\n' : '\t';
  }
  return text;
}

double SamplingRateHz(const MotionTable& table) {
  const std::size_t columns = table.channels.size();
  if (columns == 0 || table.cells.size() < 2 * columns) return 0;
  const double passed_s = table.cells[table.cells.size() - columns] - table.cells.front();
  return passed_s > 0 ? static_cast<double>(table.cells.size() / columns - 1) / passed_s : 0;
}

ordered_json MotionJson(const MotionTable& table, const std::string& task,
                        const std::string& task_description) {
  std::map<std::string, std::size_t> of_type;
  std::map<std::string, bool> points;
  for (const Channel& one : table.channels) {
    ++of_type[one.type];
    if (one.tracked_point != kNotAvailable) points[one.tracked_point] = true;
  }
  ordered_json json = {{"TaskName", task},
                       {"TaskDescription", task_description},
                       {"SamplingFrequency", SamplingRateHz(table)},
                       {"TrackingSystemName", table.tracksys},
                       {"Manufacturer", table.manufacturer},
                       {"MotionChannelCount", table.channels.size()},
                       {"TrackedPointsCount", points.size()}};
  for (const auto& [type, count] : of_type) json[type + "ChannelCount"] = count;
  if (table.mended_times > 0) {
    json["MendedTimes"] = table.mended_times;
    json["MendedTimesDescription"] =
        "Samples whose time was not later than the one before, such as one that the device sent "
        "twice; each has the earliest later time of the file";
  }
  json.update(table.notes);
  return json;
}

namespace {

bool HasMarkers(const std::vector<Event>& events) {
  return std::any_of(events.begin(), events.end(), [](const Event& one) { return one.is_marker; });
}

/// The name behind this word of a marker's text; empty: it is another marker.
std::string NameBehind(const std::string& word, const Event& event) {
  return event.is_marker && event.trial_type.starts_with(word)
             ? event.trial_type.substr(word.size())
             : "";
}

}  // namespace

std::vector<Event> WithSpans(const std::vector<Event>& events) {
  std::vector<Event> joined;
  for (const Event& event : events) {
    const std::string ended = NameBehind("end ", event);
    const auto begun = std::find_if(joined.rbegin(), joined.rend(), [&](const Event& one) {
      return !ended.empty() && NameBehind("begin ", one) == ended;
    });
    if (begun == joined.rend()) {
      joined.push_back(event);
      continue;
    }
    begun->trial_type = ended;
    begun->duration_s = event.onset_s - begun->onset_s;
  }
  return joined;
}

std::string EventsTsv(const std::vector<Event>& events) {
  std::vector<std::vector<std::string>> rows = {{"onset", "duration", "trial_type", "counts"}};
  const bool has_markers = HasMarkers(events);
  if (has_markers) rows[0].push_back("value");
  for (const Event& one : events) {
    rows.push_back({text::Fixed(one.onset_s, 3),
                    one.duration_s > 0 ? text::Fixed(one.duration_s, 3) : "0", one.trial_type,
                    one.counts ? "yes" : "no"});
    if (has_markers) rows.back().push_back(one.value ? text::Shortest(*one.value) : "");
  }
  return Tsv(rows);
}

ordered_json Column(const std::string& description, const std::string& units) {
  ordered_json column = {{"Description", description}};
  if (!units.empty()) column["Units"] = units;
  return column;
}

std::vector<File> EventFiles(const std::vector<Event>& events, const std::string& stem) {
  ordered_json codebook = {
      {"onset", Column("On the time of the channel latency", "s")},
      {"duration", Column("0: an instant", "s")},
      {"trial_type",
       Column("trial_ready, trial_running (start line), trial_finished (finish line), "
              "trial_stopped; failure_KIND; put_back, put_back_by_operator; task_done; "
              "gait_NAME: the character has changed to this gait")},
      {"counts", Column("no: a failure that was undone, by mistake of the detection")}};
  if (HasMarkers(events)) {
    codebook["value"] = Column(
        "Number that a program gave its marker; the trial_type of a marker is its text, and of a "
        "pair \"begin NAME\" and \"end NAME\" the NAME");
  }
  return {{stem + "_events.tsv", EventsTsv(events)},
          {stem + "_events.json", codebook.dump(2) + "\n"}};
}

std::vector<File> MotionFiles(const MotionTable& table, const std::string& stem,
                              const std::string& run, const std::string& task,
                              const std::string& task_description) {
  const std::string name = stem + "_tracksys-" + table.tracksys + run + "_";
  return {{name + "motion.tsv", MotionTsv(table)},
          {name + "motion.json", MotionJson(table, task, task_description).dump(2) + "\n"},
          {name + "channels.tsv", ChannelsTsv(table)}};
}

File DescriptionFile(const std::string& name, const std::string& program,
                     const std::string& version) {
  const ordered_json json = {{"Name", name},
                             {"BIDSVersion", "1.9.0"},
                             {"DatasetType", "raw"},
                             {"GeneratedBy", {{{"Name", program}, {"Version", version}}}}};
  return {"dataset_description.json", json.dump(2) + "\n"};
}

std::string LabelOf(const std::string& name) {
  std::string label;
  std::copy_if(name.begin(), name.end(), std::back_inserter(label),
               [](unsigned char c) { return std::isalnum(c) != 0; });
  return label;
}

std::string ShiftedTime(double seconds) {
  using namespace std::chrono;
  const sys_seconds time = sys_days(January / 1 / 1900) +
                           std::chrono::seconds(static_cast<std::int64_t>(std::floor(seconds)));
  const sys_days day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  char text[32];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
                static_cast<int>(clock.seconds().count()));
  return text;
}

namespace {

bool IsOfAHost(const recording::RecordedServer& server) {
  return IsInstant(server.wall_time_ns) && IsInstant(server.host_ns);
}

}  // namespace

std::int64_t WallNs(const recording::RecordedServer& server, std::int64_t host_ns) {
  return IsOfAHost(server) ? host_ns + server.wall_time_ns - server.host_ns : 0;
}

Result<RunClock> RunClock::Of(const recording::RecordedServer& server, std::int64_t zero_wall_ns) {
  const bool known = IsOfAHost(server) && IsInstant(zero_wall_ns);
  RunClock clock;
  if (known) clock.offset_ns_ = server.wall_time_ns - server.host_ns - zero_wall_ns;
  if (!known || !IsInstant(clock.offset_ns_)) {
    return InvalidData("the times of " + server.name + " are not those of a host");
  }
  return clock;
}

double RunClock::operator()(std::int64_t host_ns) const {
  return IsInstant(host_ns) ? NanosecondsToSeconds(host_ns + offset_ns_)
                            : std::numeric_limits<double>::quiet_NaN();
}

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::string PointOf(const std::string& rig, stream::DeviceRole role) {
  const std::string name = stream::Name(role);
  return rig.empty() || rig == "main" ? name : rig + "_" + name;
}

}  // namespace

void DeviceTables::Start(const RunClock& clock) {
  clock_ = clock;
  sensors_ = rig::Follower();
}

void DeviceTables::Add(const rig::Tick& tick) {
  sensors_.Take(tick);
  tick_ns_ = tick.host_ns;
  for (const stream::MotionSample& one : tick.motion) AddMotion(one);
  for (const stream::BoardSample& one : tick.boards) AddBoard(one);
  for (const stream::NunchukSample& one : tick.nunchuks) AddStick(one);
  for (const stream::HandSample& one : tick.hands) AddHand(one);
}

MotionTable* DeviceTables::Find(std::uint32_t device, std::int64_t sampled_ns,
                                const std::string& part) {
  const stream::DeviceStatus* status = sensors_.Find(device);
  if (status == nullptr) return nullptr;
  const std::string kind = stream::Name(status->kind);
  if (status->role != stream::DeviceRole::kUnspecified) {
    return Find(PointOf(status->rig, status->role), kind, sampled_ns, part);
  }
  return with_role_ ? nullptr : Find(kind + std::to_string(device), kind, sampled_ns, part);
}

MotionTable* DeviceTables::Find(const std::string& point, const std::string& maker,
                                std::int64_t sampled_ns, const std::string& part) {
  time_s_ = clock_(sampled_ns != 0 ? sampled_ns : tick_ns_);
  if (!(time_s_ >= 0)) return nullptr;
  point_ = point;
  MotionTable& table = tables_[point_ + part];
  if (table.channels.empty()) {
    table.tracksys = LabelOf(point_ + part);
    table.manufacturer = maker;
    table.channels.push_back(Latency());
  }
  time_s_ = RisingTime(time_s_, table);
  return &table;
}

void DeviceTables::AddMotion(const stream::MotionSample& one) {
  MotionTable* table = Find(one.device, one.sampled_ns, "");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    AddVector("accel", "ACCEL", point_, "m/s^2", *table);
    AddVector("gyro", "GYRO", point_, "rad/s", *table);
  }
  const Eigen::Vector3d &a = one.specific_force_mps2, &w = one.angular_velocity_radps;
  const double turned = one.has_angular_velocity ? 0 : kMissing;
  Append({time_s_, a.x(), a.y(), a.z(), w.x() + turned, w.y() + turned, w.z() + turned}, *table);
}

void DeviceTables::AddBoard(const stream::BoardSample& one) {
  MotionTable* table = Find(one.device, one.sampled_ns, "");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    for (const char* corner : {"top_left", "top_right", "bottom_left", "bottom_right"}) {
      table->channels.push_back({corner, "n/a", "MISC", point_, "N"});
    }
  }
  Append({time_s_, one.top_left_n, one.top_right_n, one.bottom_left_n, one.bottom_right_n}, *table);
}

void DeviceTables::AddStick(const stream::NunchukSample& one) {
  MotionTable* table = Find(one.device, one.sampled_ns, "_nunchuk");
  if (table == nullptr) return;
  if (table->cells.empty()) {
    for (const char* axis : {"x", "y"}) {
      table->channels.push_back({std::string("stick_") + axis, axis, "MISC", point_, "n/a"});
    }
    AddVector("accel", "ACCEL", point_, "m/s^2", *table);
  }
  const Eigen::Vector3d& a = one.specific_force_mps2;
  Append({time_s_, one.stick_x, one.stick_y, a.x(), a.y(), a.z()}, *table);
}

void DeviceTables::AddHand(const stream::HandSample& one) {
  if (one.role == stream::DeviceRole::kUnspecified) return;  // A joint of a skeleton.
  const std::string point = PointOf(one.rig, one.role);
  std::string part = "_tracked";
  // Another tracker of the same hand sees it in its own time.
  const auto first = tables_.find(point + part);
  if (first != tables_.end() && first->second.manufacturer != one.tracker) {
    part += "_" + one.tracker;
  }
  MotionTable* table = Find(point, one.tracker, one.sampled_ns, part);
  if (table == nullptr) return;
  if (table->cells.empty()) {
    AddVector("position", "POS", point_, "m", *table);
    table->channels.push_back({"confidence", "n/a", "MISC", point_, "n/a"});
  }
  const Eigen::Vector3d& p = one.position_m;
  const double seen = one.confidence > 0 ? 0 : kMissing;
  Append({time_s_, p.x() + seen, p.y() + seen, p.z() + seen, one.confidence}, *table);
}

namespace {

void AddTurn(const std::string& name, const std::string& point, MotionTable& table) {
  for (const char* component : {"quat_x", "quat_y", "quat_z", "quat_w"}) {
    table.channels.push_back({name + "_" + component, component, "ORNT", point, "n/a"});
  }
}

MotionTable SimulationTable() {
  MotionTable table{"sim", "Footing", {Latency()}, {}};
  AddVector("body", "POS", "body", "m", table);
  AddTurn("body", "body", table);
  AddVector("com_velocity", "VEL", "com", "m/s", table);
  for (const auto& [name, units] :
       {std::pair("distance", "m"), std::pair("lateral_offset", "m"),
        std::pair("heading_error", "rad"), std::pair("on_track", "n/a"), std::pair("gait", "n/a"),
        std::pair("commanded_gait", "n/a"), std::pair("commanded_speed", "m/s"),
        std::pair("commanded_turn", "rad")}) {
    table.channels.push_back({name, "n/a", "MISC", "body", units});
  }
  return table;
}

/// How exact the orientations of the links are, rad.
nlohmann::ordered_json OrientationNotes(const v1::Skeleton& skeleton) {
  std::vector<std::string> names;
  std::vector<int> parents;
  for (const v1::Link& link : skeleton.links()) {
    names.push_back(link.name());
    parents.push_back(link.parent());
  }
  nlohmann::ordered_json notes = nlohmann::ordered_json::object();
  const auto deviations = body::DeviationsOfLinks(names, parents);
  if (deviations.empty()) return notes;
  nlohmann::ordered_json& all = notes["OrientationStandardDeviation"];
  all["Description"] = body::AngleDeviationSource();
  all["Units"] = "rad";
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    all["TrackedPoints"][names[i]] = {{"Upright", DegreesToRadians(deviations[i].upright_deg)},
                                      {"Bent", DegreesToRadians(deviations[i].bent_deg)}};
  }
  return notes;
}

/// A joint for each link, and whether the frame is trusted.
MotionTable BodyTable(const v1::Skeleton& skeleton) {
  MotionTable table{"body", "Footing", {Latency()}, {}, OrientationNotes(skeleton)};
  for (const v1::Link& link : skeleton.links()) {
    AddVector(link.name(), "POS", link.name(), "m", table);
    AddTurn(link.name(), link.name(), table);
  }
  AddVector("com", "POS", "com", "m", table);
  for (const char* flag : {"valid", "momentum_valid"}) {
    table.channels.push_back({flag, "n/a", "MISC", "body", "n/a"});
  }
  return table;
}

void AddSimulation(double time_s, const v1::Character& character, MotionTable& table) {
  const v1::LinkPose body = character.links_size() > 0 ? character.links(0) : v1::LinkPose();
  const v1::Vector3 &p = body.position_m(), &v = character.com_velocity_mps();
  const v1::Quaternion& q = body.orientation();
  const v1::TrialState& trial = character.trial();
  const v1::GaitState& gait = character.gait();
  Append({time_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), v.x(), v.y(), v.z(),
          trial.distance_m(), trial.lateral_offset_m(), trial.heading_error_rad(),
          trial.on_track() ? 1.0 : 0.0, static_cast<double>(gait.gait()),
          static_cast<double>(gait.commanded_gait()), gait.commanded_speed_mps(),
          gait.commanded_turn_rad()},
         table);
}

/// Empty: nothing that a data set needs.
std::string TypeOf(const v1::Event& event) {
  switch (event.kind()) {
    case v1::Event::KIND_FALL:
      return std::string("failure_") +
             stream::Name(static_cast<stream::FailureCause>(event.failure_cause()));
    case v1::Event::KIND_PUT_BACK:
      return event.by_operator() ? "put_back_by_operator" : "put_back";
    case v1::Event::KIND_GAIT_CHANGED:
      return std::string("gait_") + stream::Name(stream::GaitNumbered(event.gait()));
    case v1::Event::KIND_TRIAL:
      return std::string("trial_") + stream::Name(wire::FromProto(event.trial()).progress.phase);
    case v1::Event::KIND_TASK:
      return "task_done";
    case v1::Event::KIND_MARKER:
      return event.text();
    default:
      return "";
  }
}

}  // namespace

void CharacterTables::Add(double time_s, const v1::Tick& tick) {
  if (body_.cells.empty() && tick.skeletons().skeletons_size() > 0) {
    skeleton_ = tick.skeletons().skeletons(0);
  }
  if (tick.characters().characters_size() == 0) return;
  const v1::Character& character = tick.characters().characters(0);
  if (character.has_body()) return AddBody(time_s, character);
  if (sim_.channels.empty()) sim_ = SimulationTable();
  AddSimulation(RisingTime(time_s, sim_), character, sim_);
}

void CharacterTables::AddBody(double time_s, const v1::Character& character) {
  const bool fits = character.links_size() == skeleton_.links_size() && character.links_size() > 0;
  if (!fits || !character.body().calibrated()) return;
  if (body_.channels.empty()) body_ = BodyTable(skeleton_);
  Append({RisingTime(time_s, body_)}, body_);
  for (const v1::LinkPose& link : character.links()) {
    const v1::Vector3& p = link.position_m();
    const v1::Quaternion& q = link.orientation();
    Append({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}, body_);
  }
  const v1::Vector3& com = character.com_m();
  Append({com.x(), com.y(), com.z(), character.valid() ? 1.0 : 0.0,
          character.body().momentum_valid() ? 1.0 : 0.0},
         body_);
}

std::vector<MotionTable> CharacterTables::Take() {
  std::vector<MotionTable> tables;
  for (MotionTable* one : {&sim_, &body_}) {
    if (!one->cells.empty()) tables.push_back(std::exchange(*one, {}));
  }
  return tables;
}

void AddEvents(const v1::Tick& tick, const RunClock& clock, const std::set<std::uint64_t>& undone,
               std::vector<Event>& events) {
  for (const v1::Event& event : tick.events().events()) {
    const std::string type = TypeOf(event);
    const bool counts =
        event.kind() != v1::Event::KIND_FALL || undone.count(event.failure().number()) == 0;
    const double onset_s = clock(event.host_ns());
    if (type.empty() || !std::isfinite(onset_s)) continue;
    events.push_back({onset_s, type, counts});
    events.back().is_marker = event.kind() == v1::Event::KIND_MARKER;
    if (event.marker().has_value()) events.back().value = event.marker().value();
  }
}

}  // namespace footing::bids

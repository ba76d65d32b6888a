#include "clients/study/bundle/trial_tables.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "common/stream/device.h"
#include "common/stream/gait.h"
#include "common/stream/trial.h"
#include "common/units/units.h"
#include "common/wire/wire.h"

namespace footing::study::bundle {
namespace {

using recording::RecordedServer;
using v1::Tick;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Seconds since the first frame of the trial, of an instant on a server's clock.
class TrialClock {
 public:
  TrialClock(const RecordedServer& server, std::int64_t zero_wall_ns)
      : offset_ns_(server.wall_time_ns - server.host_ns - zero_wall_ns) {}
  double operator()(std::int64_t host_ns) const {
    return NanosecondsToSeconds(host_ns + offset_ns_);
  }

 private:
  std::int64_t offset_ns_;
};

Channel Latency() { return {"latency", "n/a", "LATENCY", "n/a", "s"}; }

/// Channels NAME_x, NAME_y, NAME_z.
void AddVector(const std::string& name, const std::string& type, const std::string& point,
               const std::string& units, MotionTable& table) {
  for (const char* component : {"x", "y", "z"}) {
    table.channels.push_back({name + "_" + component, component, type, point, units});
  }
}

MotionTable SimulationTable() {
  MotionTable table{"sim", "Footing", {Latency()}, {}};
  AddVector("body", "POS", "body", "m", table);
  for (const char* component : {"quat_x", "quat_y", "quat_z", "quat_w"}) {
    table.channels.push_back({std::string("body_") + component, component, "ORNT", "body", "n/a"});
  }
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

void Append(std::initializer_list<double> values, MotionTable& table) {
  table.cells.insert(table.cells.end(), values);
}

void AddFrame(double time_s, const v1::Character& character, MotionTable& table) {
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
    default:
      return "";
  }
}

void AddEvents(const Tick& tick, const TrialClock& clock, const std::set<std::uint64_t>& undone,
               std::vector<TrialEvent>& events) {
  for (const v1::Event& event : tick.events().events()) {
    const std::string type = TypeOf(event);
    const bool counts =
        event.kind() != v1::Event::KIND_FALL || undone.count(event.failure().number()) == 0;
    if (!type.empty()) events.push_back({clock(event.host_ns()), type, counts});
  }
}

/// The tables of devices, by what they are: a Wiimote and its Nunchuk have one each.
class DeviceTables {
 public:
  explicit DeviceTables(const TrialClock& clock) : clock_(clock) {}

  void Add(const Tick& tick) {
    for (const v1::DeviceStatus& one : tick.status().devices()) {
      const stream::DeviceStatus status = wire::FromProto(one);
      if (status.role != stream::DeviceRole::kUnspecified) devices_[status.device] = status;
    }
    for (const v1::MotionSample& one : tick.motion().samples()) AddMotion(one);
    for (const v1::BoardSample& one : tick.boards().samples()) AddBoard(one);
    for (const v1::NunchukSample& one : tick.nunchuk().samples()) AddStick(one);
  }

  std::map<std::string, MotionTable> tables;

 private:
  /// Null: a device without a role, or a sample from before the trial.
  MotionTable* Find(std::uint32_t device, std::int64_t sampled_ns, const std::string& part) {
    const auto found = devices_.find(device);
    if (found == devices_.end() || clock_(sampled_ns) < 0) return nullptr;
    point_ = stream::Name(found->second.role);
    MotionTable& table = tables[point_ + part];
    if (table.channels.empty()) {
      table.tracksys = LabelOf(point_ + part);
      table.manufacturer = stream::Name(found->second.kind);
      table.channels.push_back(Latency());
    }
    return &table;
  }

  void AddMotion(const v1::MotionSample& one) {
    MotionTable* table = Find(one.device(), one.sampled_ns(), "");
    if (table == nullptr) return;
    if (table->cells.empty()) {
      AddVector("accel", "ACCEL", point_, "m/s^2", *table);
      AddVector("gyro", "GYRO", point_, "rad/s", *table);
    }
    const v1::Vector3 &a = one.specific_force_mps2(), &w = one.angular_velocity_radps();
    const double turned = one.has_angular_velocity_radps() ? 0 : kMissing;
    Append({clock_(one.sampled_ns()), a.x(), a.y(), a.z(), w.x() + turned, w.y() + turned,
            w.z() + turned},
           *table);
  }

  void AddBoard(const v1::BoardSample& one) {
    MotionTable* table = Find(one.device(), one.sampled_ns(), "");
    if (table == nullptr) return;
    if (table->cells.empty()) {
      for (const char* corner : {"top_left", "top_right", "bottom_left", "bottom_right"}) {
        table->channels.push_back({corner, "n/a", "MISC", point_, "N"});
      }
    }
    Append({clock_(one.sampled_ns()), one.top_left_n(), one.top_right_n(), one.bottom_left_n(),
            one.bottom_right_n()},
           *table);
  }

  void AddStick(const v1::NunchukSample& one) {
    MotionTable* table = Find(one.device(), one.sampled_ns(), "_nunchuk");
    if (table == nullptr) return;
    if (table->cells.empty()) {
      for (const char* axis : {"x", "y"}) {
        table->channels.push_back({std::string("stick_") + axis, axis, "MISC", point_, "n/a"});
      }
      AddVector("accel", "ACCEL", point_, "m/s^2", *table);
    }
    const v1::Vector3& a = one.specific_force_mps2();
    Append({clock_(one.sampled_ns()), one.stick_x(), one.stick_y(), a.x(), a.y(), a.z()}, *table);
  }

  const TrialClock& clock_;
  std::map<std::uint32_t, stream::DeviceStatus> devices_;
  std::string point_;
};

std::string IdOf(const recording::RecordedSession& session) {
  for (const mcap::Metadata& one : session.metadata()) {
    const auto id = one.values.find("trial");
    if (one.name == "trial" && id != one.values.end()) return id->second;
  }
  return "";
}

}  // namespace

Result<TrialTables> ReadTrial(const recording::RecordedSession& session,
                              const records::Trial& trial) {
  const std::string id = IdOf(session);
  if (id.empty()) return InvalidData(session.path() + ": it has no trial marks");
  const RecordedServer* simulation = session.Find("footing-sim");
  if (simulation == nullptr) return InvalidData(session.path() + " has no messages of footing-sim");
  const auto ticks = ReadTicks(*simulation, {Tick::kCharactersFieldNumber, Tick::kEventsFieldNumber,
                                             Tick::kConfigFieldNumber});
  if (!ticks) return ticks.error();
  std::set<std::uint64_t> undone;
  for (const records::Failure& one : trial.failures) {
    if (one.undone) undone.insert(one.number);
  }
  TrialTables result;
  MotionTable frames = SimulationTable();
  std::optional<std::int64_t> zero_wall_ns;
  for (const Tick& tick : *ticks) {
    if (tick.has_config()) result.config = tick.config().json();
    const bool of_trial = tick.characters().characters_size() > 0 &&
                          tick.characters().characters(0).trial().trial() == id;
    if (of_trial && !zero_wall_ns) {
      zero_wall_ns = tick.host_ns() + simulation->wall_time_ns - simulation->host_ns;
    }
    if (!zero_wall_ns) continue;
    const TrialClock clock(*simulation, *zero_wall_ns);
    if (of_trial) AddFrame(clock(tick.host_ns()), tick.characters().characters(0), frames);
    AddEvents(tick, clock, undone, result.events);
  }
  if (!zero_wall_ns) return InvalidData(session.path() + ": no frame of trial " + id);
  result.tables.push_back(std::move(frames));
  const RecordedServer* sensors = session.Find("footingd");
  if (sensors == nullptr) return result;
  const auto sampled = ReadTicks(*sensors);
  if (!sampled) return sampled.error();
  const TrialClock clock(*sensors, *zero_wall_ns);
  DeviceTables devices(clock);
  for (const Tick& tick : *sampled) devices.Add(tick);
  for (auto& [name, table] : devices.tables) result.tables.push_back(std::move(table));
  return result;
}

}  // namespace footing::study::bundle

#include "common/recording/character_tables.h"

#include <cmath>
#include <utility>

#include "common/body/angle_deviation.h"
#include "common/stream/gait.h"
#include "common/stream/trial.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::bids {
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
  AddSimulation(time_s, character, sim_);
}

void CharacterTables::AddBody(double time_s, const v1::Character& character) {
  const bool fits = character.links_size() == skeleton_.links_size() && character.links_size() > 0;
  if (!fits || !character.body().calibrated()) return;
  if (body_.channels.empty()) body_ = BodyTable(skeleton_);
  Append({time_s}, body_);
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
    if (!type.empty() && std::isfinite(onset_s)) events.push_back({onset_s, type, counts});
  }
}

}  // namespace footing::bids

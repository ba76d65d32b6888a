#include "common/recording/recorded_motion.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/recording/bids_tables.h"
#include "common/wire/wire.h"

namespace footing::bids {
namespace {

using recording::RecordedServer;
using v1::Tick;

class Reader {
 public:
  explicit Reader(const Choice& choice) : choice_(choice), devices_(choice.with_role) {}

  Result<RecordedMotion> Run(const recording::RecordedSession& session) {
    path_ = session.path();
    if (choice_.trial.empty()) zero_wall_ns_ = FirstTick(session);
    for (const RecordedServer& server : session.servers()) {
      if (server.server_id != "footing-sim") continue;
      if (const auto done = ReadSimulation(server); !done) return done.error();
    }
    if (!zero_wall_ns_) {
      return InvalidData(session.path() + (choice_.trial.empty()
                                               ? " has no ticks"
                                               : ": no frame of trial " + choice_.trial));
    }
    for (const RecordedServer& server : session.servers()) {
      if (server.server_id != "footingd") continue;
      if (const auto done = ReadDevices(server); !done) return done.error();
    }
    motion_.tables = characters_.Take();
    for (const auto& [name, table] : devices_.tables()) motion_.tables.push_back(table);
    OrderEvents();
    return std::move(motion_);
  }

 private:
  static std::optional<std::int64_t> FirstTick(const recording::RecordedSession& session) {
    std::optional<std::int64_t> first_ns;
    for (const RecordedServer& server : session.servers()) {
      for (const recording::RecordedTick& tick : server.ticks) {
        const std::int64_t wall_ns = WallNs(server, tick.host_ns);
        first_ns = std::min(first_ns.value_or(wall_ns), wall_ns);
      }
    }
    return first_ns;
  }

  bool IsChosen(const Tick& tick) const {
    return choice_.trial.empty() ||
           (tick.characters().characters_size() > 0 &&
            tick.characters().characters(0).trial().trial() == choice_.trial);
  }

  /// The rows of a table are those of one person.
  Result<void> CheckSubject(const Tick& tick) {
    if (tick.characters().characters_size() == 0) return {};
    const v1::Character& character = tick.characters().characters(0);
    if (!character.has_body() || !character.body().calibrated()) return {};
    const std::string& subject = character.body().subject();
    if (!subject_) subject_ = subject;
    if (*subject_ == subject) return {};
    return InvalidData(path_ + ": the bodies of " + *subject_ + " and " + subject +
                       " are in one recording, and a table of BIDS is of one person; record each "
                       "person by themselves, or export bvh, trc, mot or c3d");
  }

  Result<void> ReadSimulation(const RecordedServer& server) {
    const auto ticks = ReadTicks(server, {Tick::kSkeletonsFieldNumber, Tick::kCharactersFieldNumber,
                                          Tick::kEventsFieldNumber, Tick::kConfigFieldNumber});
    if (!ticks) return ticks.error();
    std::optional<RunClock> clock;
    for (const Tick& tick : *ticks) {
      if (tick.has_config()) motion_.config = tick.config().json();
      const bool chosen = IsChosen(tick);
      if (chosen && !zero_wall_ns_) zero_wall_ns_ = WallNs(server, tick.host_ns());
      if (!zero_wall_ns_) continue;
      if (!clock) {
        const auto of_server = RunClock::Of(server, *zero_wall_ns_);
        if (!of_server) return of_server.error();
        clock = *of_server;
      }
      if (chosen) {
        if (const auto done = CheckSubject(tick); !done) return done;
        characters_.Add((*clock)(tick.host_ns()), tick);
      }
      AddEvents(tick, *clock, choice_.undone, motion_.events);
    }
    return {};
  }

  Result<void> ReadDevices(const RecordedServer& server) {
    const auto ticks = ReadTicks(
        server, {Tick::kStatusFieldNumber, Tick::kMotionFieldNumber, Tick::kBoardsFieldNumber,
                 Tick::kNunchukFieldNumber, Tick::kHandsFieldNumber, Tick::kEventsFieldNumber,
                 Tick::kConfigFieldNumber});
    if (!ticks) return ticks.error();
    const auto clock = RunClock::Of(server, *zero_wall_ns_);
    if (!clock) return clock.error();
    devices_.Start(*clock);
    for (const Tick& tick : *ticks) {
      if (tick.has_config()) motion_.sensor_config = tick.config().json();
      devices_.Add(wire::SensorTick(tick));
      AddEvents(tick, *clock, choice_.undone, motion_.events);
    }
    return {};
  }

  /// A marker has the time of its sender, which is before that of its tick.
  void OrderEvents() {
    std::vector<Event>& events = motion_.events;
    if (!choice_.markers) {
      events.erase(std::remove_if(events.begin(), events.end(),
                                  [](const Event& one) { return one.is_marker; }),
                   events.end());
    }
    const bool any_marker =
        std::any_of(events.begin(), events.end(), [](const Event& one) { return one.is_marker; });
    if (!any_marker) return;
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& a, const Event& b) { return a.onset_s < b.onset_s; });
    events = WithSpans(events);
  }

  const Choice& choice_;
  std::string path_;
  std::optional<std::int64_t> zero_wall_ns_;
  std::optional<std::string> subject_;  ///< Subject of the bodies.
  CharacterTables characters_;
  DeviceTables devices_;
  RecordedMotion motion_;
};

}  // namespace

Result<RecordedMotion> ReadMotion(const recording::RecordedSession& session, const Choice& choice) {
  return Reader(choice).Run(session);
}

}  // namespace footing::bids

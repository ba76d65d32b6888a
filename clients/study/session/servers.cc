#include "clients/study/session/servers.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "clients/study/session/server_link.h"
#include "common/base/units.h"
#include "common/net/address.h"
#include "common/rig/follower.h"
#include "common/stream/leg_turn.h"
#include "common/wire/wire.h"

namespace footing::study {
namespace {

constexpr double kLongestTickS = 0.5;  // A longer interval is a gap: ticks come 100 times a second.

}  // namespace

void ActiveTime::Add(std::int64_t host_ns, bool moving) {
  const double passed_s = NanosecondsToSeconds(host_ns - last_ns_);
  if (moving && passed_s > 0 && passed_s <= kLongestTickS) seconds_ += passed_s;
  last_ns_ = host_ns;
}

namespace {

constexpr double kConnectS = 5;
constexpr double kAnswerS = 5;
constexpr double kShownS = 5;
constexpr double kTrialShownS = 1;
constexpr double kReleasedS = 1;
// The lease of a session that is gone has run out by then.
constexpr double kLeaseWithinS = 7;
bool AnyMoves(const v1::FeatureFrame& frame) {
  return std::any_of(frame.rigs().begin(), frame.rigs().end(), [](const v1::RigFeatures& rig) {
    return std::any_of(rig.devices().begin(), rig.devices().end(),
                       [](const v1::DeviceFeatures& device) { return device.moving(); });
  });
}

}  // namespace

class Servers::Implementation {
 public:
  Implementation(Console& console, const Options& options, ActiveTime& active)
      : console_(console),
        active_(active),
        sensor_(console, {"footingd", options.sensor, {"status", "features"}, options.holder},
                {[this](const v1::Tick& tick) {
                   sensors_.Take(wire::SensorTick(tick));
                   OnTick(tick);
                   sensor_ticked_ = true;
                 },
                 [] {}}),
        simulation_(
            console,
            {"footing-sim", options.simulation, {"characters", "events", "track"}, options.holder},
            {[this](const v1::Tick& tick) {
               OnTick(tick);
               // The snapshot has no frame yet, and without one nothing is known of it.
               simulation_ticked_ = simulation_ticked_ || tick.has_characters();
             },
             [this] { in_force_.clear(); }}) {}

  ~Implementation() {
    const auto released = std::make_shared<int>(0);
    int held = 0;
    for (ServerLink* link : {&sensor_, &simulation_}) {
      if (!link->lease().held()) continue;
      ++held;
      link->lease().Release([released] { ++*released; });
    }
    if (held > 0) console_.RunUntil([&] { return *released == held; }, kReleasedS);
  }

  void OnTick(const v1::Tick& tick) {
    if (tick.has_features()) active_.Add(tick.host_ns(), AnyMoves(tick.features()));
    if (tick.has_track()) track_ = wire::FromProto(tick.track());
    // The snapshot repeats what was before this program came.
    if (!tick.snapshot() && on_event_) {
      for (const v1::Event& event : tick.events().events()) on_event_(event);
    }
    if (tick.has_characters() && tick.characters().characters_size() > 0) {
      const v1::Character& character = tick.characters().characters(0);
      frame_ = {tick.host_ns(), wire::FromProto(character.trial()),
                stream::GaitNumbered(character.gait().commanded_gait()),
                stream::GaitNumbered(character.gait().gait()),
                wire::FromProto(character.interface())};
      if (on_frame_) on_frame_(frame_);
    }
  }

  Console& console_;
  ActiveTime& active_;
  bool sensor_ticked_ = false;
  bool simulation_ticked_ = false;
  rig::Follower sensors_;
  SimulationFrame frame_;
  std::string in_force_;  ///< Interface that this connection set last; empty: none.
  stream::Track track_;
  std::function<void(const SimulationFrame&)> on_frame_;
  std::function<void(const v1::Event&)> on_event_;
  ServerLink sensor_;  // Last: their handlers use all the rest.
  ServerLink simulation_;
};

Servers::Servers(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Servers::~Servers() = default;

Result<std::unique_ptr<Servers>> Servers::Open(Console& console, const Options& options,
                                               ActiveTime& active) {
  auto own = std::make_unique<Implementation>(console, options, active);
  const Waited waited =
      console.RunUntil([&] { return own->sensor_ticked_ && own->simulation_ticked_; }, kConnectS);
  if (waited == Waited::kInterrupted) return Interrupted();
  for (const auto& [link, ticked] : {std::pair(&own->sensor_, own->sensor_ticked_),
                                     std::pair(&own->simulation_, own->simulation_ticked_)}) {
    if (!ticked && link->refused()) return Failure(link->Text());
    if (!ticked) {
      return NoDevice(
          "no " + link->Text() +
          transport::RemedyFor(link->Text(),
                               "start it, or name its address (footing-study run --help)"));
    }
  }
  for (ServerLink* link : {&own->simulation_, &own->sensor_}) {
    const Waited leased = console.RunUntil([&] { return link->lease().held(); }, kLeaseWithinS);
    if (leased == Waited::kInterrupted) return Interrupted();
    if (leased == Waited::kTimeUp) {
      return Failure(link->name() + ": " + link->lease().refusal());
    }
  }
  return std::unique_ptr<Servers>(new Servers(std::move(own)));
}

const std::vector<stream::DeviceStatus>& Servers::devices() const {
  return implementation_->sensors_.devices();
}
const SimulationFrame& Servers::frame() const { return implementation_->frame_; }
const stream::Track& Servers::track() const { return implementation_->track_; }

bool Servers::live() const {
  return implementation_->sensor_.up() && implementation_->simulation_.up() && !broken();
}

bool Servers::broken() const {
  return implementation_->sensor_.broken() || implementation_->simulation_.broken();
}

std::uint64_t Servers::breaks() const {
  return implementation_->sensor_.breaks() + implementation_->simulation_.breaks();
}

Result<void> Servers::CheckLeases() const {
  for (const ServerLink* link : {&implementation_->simulation_, &implementation_->sensor_}) {
    if (!link->lease().lost()) continue;
    return Failure(link->name() + ": " + link->lease().refusal() +
                   "; footing-study run resumes the session");
  }
  return {};
}

void Servers::LendDevices() {
  HeldLease& lease = implementation_->sensor_.lease();
  if (lease.wanted()) lease.Release([] {});
}

void Servers::KeepDevices() { implementation_->sensor_.lease().Hold(); }

std::string Servers::WhyNoDevices() const {
  const HeldLease& lease = implementation_->sensor_.lease();
  if (lease.held()) return "";
  return lease.refusal().empty() ? "footingd has not given its lease yet" : lease.refusal();
}

std::string Servers::WhyNotLive() const {
  std::string text;
  for (const ServerLink* link : {&implementation_->sensor_, &implementation_->simulation_}) {
    if (link->up() && !link->broken()) continue;
    text += (text.empty() ? "" : "; ") + link->Text();
  }
  return text;
}

void Servers::set_on_frame(std::function<void(const SimulationFrame&)> on_frame) {
  implementation_->on_frame_ = std::move(on_frame);
}

void Servers::set_on_event(std::function<void(const v1::Event&)> on_event) {
  implementation_->on_event_ = std::move(on_event);
}

Result<void> Servers::UseInterface(const std::string& interface, const std::string& turn_by,
                                   const std::string& table) {
  const auto wanted = stream::UserInterfaceNamed(interface);
  const auto source = stream::LegTurnSourceNamed(turn_by);
  const auto in_force = [&] {
    const stream::InterfaceState& now = frame().interface;
    const bool turns = wanted != stream::UserInterface::kLeg || now.turn.source == source;
    return now.interface == wanted && turns;
  };
  // Frames do not show the table: what another session has left must not stay in force.
  const std::string asked = interface + " " + turn_by + " " + table;
  if (in_force() && implementation_->in_force_ == asked) return {};
  if (const auto stopped = StopTrial(); !stopped) return stopped;
  v1::Command command;
  command.mutable_set_interface()->set_character(1);
  command.mutable_set_interface()->set_interface(static_cast<v1::UserInterface>(wanted));
  command.mutable_set_interface()->set_turn_by(static_cast<v1::TurnSource>(source));
  command.mutable_set_interface()->set_table(table);
  if (const auto done = Call(std::move(command)); !done) return done;
  const Waited waited = implementation_->console_.RunUntil(in_force, kShownS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) return Failure("footing-sim does not show interface " + interface);
  implementation_->in_force_ = asked;
  return {};
}

/// A trial that has ended by itself meanwhile cannot be stopped, and need not be. If one goes on,
/// the next command says so, but not why.
Result<void> Servers::StopTrial() {
  const auto goes_on = [this] {
    const stream::TrialState& trial = frame().trial;
    // Before the first trial the character is ready, too.
    const bool ready = trial.progress.phase == stream::TrialPhase::kReady && !trial.trial.empty();
    return ready || trial.progress.phase == stream::TrialPhase::kRunning;
  };
  if (!goes_on()) return {};
  v1::Command stop;
  stop.mutable_stop_trial()->set_character(1);
  const auto stopped = Call(std::move(stop));
  if (stopped) return {};
  const Waited waited =
      implementation_->console_.RunUntil([&] { return !goes_on(); }, kTrialShownS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) {
    implementation_->console_.Print("the trial that goes on was not stopped: " +
                                    stopped.error().message);
  }
  return {};
}

void Servers::Show(const stream::StudyState& state) {
  v1::Command command;
  *command.mutable_set_study()->mutable_study() = wire::ToProto(state);
  implementation_->simulation_.client().Send(std::move(command), [](const v1::CommandResult&) {});
}

Result<void> Servers::Call(v1::Command command) {
  // The answer may come after an interruption has ended this wait.
  const auto answer = std::make_shared<std::optional<v1::CommandResult>>();
  command.set_deadline_ms(static_cast<std::uint32_t>(kAnswerS * 1e3));
  implementation_->simulation_.client().Send(
      std::move(command), [answer](const v1::CommandResult& result) { *answer = result; });
  const Waited waited =
      implementation_->console_.RunUntil([&] { return answer->has_value(); }, 2 * kAnswerS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) return Failure("footing-sim does not answer");
  if (!(*answer)->ok()) return Failure("footing-sim: " + (*answer)->message());
  return {};
}

}  // namespace footing::study

#include "clients/study/session/servers.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "clients/study/session/held_lease.h"
#include "common/stream/leg_turn.h"
#include "common/transport/client.h"
#include "common/wire/wire.h"

namespace footing::study {
namespace {

constexpr double kConnectS = 5;
constexpr double kAnswerS = 5;
constexpr double kShownS = 2;
constexpr double kReleasedS = 1;
// The lease of a session that is gone has run out by then.
constexpr double kLeaseWithinS = 7;
constexpr std::uint32_t kQueueTicks = 1024;

transport::ClientOptions ClientOf(const transport::Address& address, v1::Role role,
                                  std::vector<std::string> channels) {
  transport::ClientOptions options;
  options.address = address;
  options.client_name = "footing-study";
  options.role = role;
  options.channels = std::move(channels);
  // Reliable: a failure that is missed would not be counted.
  options.policy = v1::QUEUE_POLICY_RELIABLE;
  options.queue_ticks = kQueueTicks;
  return options;
}

bool AnyMoves(const v1::FeatureFrame& frame) {
  return std::any_of(frame.rigs().begin(), frame.rigs().end(), [](const v1::RigFeatures& rig) {
    return std::any_of(rig.devices().begin(), rig.devices().end(),
                       [](const v1::DeviceFeatures& device) { return device.moving(); });
  });
}

}  // namespace

class Servers::Implementation {
 public:
  struct Link {
    std::string name;
    transport::LinkState state = transport::LinkState::kConnecting;
    std::string why = "not connected";
    bool ticked = false;
    std::optional<transport::Client> client;
  };

  Implementation(Console& console, const Options& options, ActiveTime& active)
      : console_(console), active_(active) {
    sensor_.name = "footingd at " + options.sensor.Text();
    simulation_.name = "footing-sim at " + options.simulation.Text();
    Make(sensor_, ClientOf(options.sensor, v1::ROLE_VIEW, {"status", "features"}));
    Make(simulation_,
         ClientOf(options.simulation, v1::ROLE_CONTROL, {"characters", "events", "track"}));
    lease_ = std::make_shared<HeldLease>(console.io(), *simulation_.client, options.holder);
    for (Link* link : {&sensor_, &simulation_}) link->client->Start();
  }

  ~Implementation() {
    if (lease_->held()) {
      const auto released = std::make_shared<bool>(false);
      lease_->Release([released] { *released = true; });
      console_.RunUntil([&] { return *released; }, kReleasedS);
    }
    for (Link* link : {&sensor_, &simulation_}) link->client->Stop();
  }

  void Make(Link& link, transport::ClientOptions options) {
    transport::ClientHandlers handlers;
    handlers.on_tick = [this, &link](const v1::Tick& tick) {
      OnTick(tick);
      // The snapshot has no frame yet, and without one nothing is known of footing-sim.
      link.ticked = link.ticked || &link == &sensor_ || tick.has_characters();
    };
    handlers.on_state = [this, &link](transport::LinkState state, const std::string& why) {
      link.state = state;
      link.why = why;
      if (state != transport::LinkState::kLive && &link == &simulation_) in_force_.clear();
      if (&link == &simulation_) lease_->OnState(state);
    };
    handlers.on_notice = [this, &link](const v1::Notice& notice) {
      console_.Print("Notice of " + link.name + ": " + notice.text());
    };
    link.client.emplace(console_.io(), std::move(options), std::move(handlers));
  }

  void OnTick(const v1::Tick& tick) {
    if (tick.has_status()) {
      devices_.clear();
      for (const v1::DeviceStatus& one : tick.status().devices()) {
        devices_.push_back(wire::FromProto(one));
      }
    }
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

  static std::string Text(const Link& link) { return link.name + ": " + link.why; }

  Console& console_;
  ActiveTime& active_;
  Link sensor_;
  Link simulation_;
  std::shared_ptr<HeldLease> lease_;
  std::vector<stream::DeviceStatus> devices_;
  SimulationFrame frame_;
  std::string in_force_;  ///< What this connection made the interface last; empty: nothing.
  stream::Track track_;
  std::function<void(const SimulationFrame&)> on_frame_;
  std::function<void(const v1::Event&)> on_event_;
};

Servers::Servers(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Servers::~Servers() = default;

Result<std::unique_ptr<Servers>> Servers::Open(Console& console, const Options& options,
                                               ActiveTime& active) {
  auto own = std::make_unique<Implementation>(console, options, active);
  const Waited waited =
      console.RunUntil([&] { return own->sensor_.ticked && own->simulation_.ticked; }, kConnectS);
  if (waited == Waited::kInterrupted) return Interrupted();
  for (const Implementation::Link* link : {&own->sensor_, &own->simulation_}) {
    if (!link->ticked) {
      return NoDevice("no " + Implementation::Text(*link) +
                      "; start it, or name its address (footing-study run --help)");
    }
  }
  const Waited leased = console.RunUntil([&] { return own->lease_->held(); }, kLeaseWithinS);
  if (leased == Waited::kInterrupted) return Interrupted();
  if (leased == Waited::kTimeUp) {
    return Failure("footing-sim at " + options.simulation.Text() + ": " + own->lease_->refusal());
  }
  return std::unique_ptr<Servers>(new Servers(std::move(own)));
}

const std::vector<stream::DeviceStatus>& Servers::devices() const {
  return implementation_->devices_;
}
const SimulationFrame& Servers::frame() const { return implementation_->frame_; }
const stream::Track& Servers::track() const { return implementation_->track_; }

bool Servers::live() const {
  return implementation_->sensor_.state == transport::LinkState::kLive &&
         implementation_->simulation_.state == transport::LinkState::kLive &&
         implementation_->lease_->held();
}

Result<void> Servers::CheckLease() const {
  const HeldLease& lease = *implementation_->lease_;
  if (!lease.lost()) return {};
  return Failure(implementation_->simulation_.name + ": " + lease.refusal() +
                 "; footing-study run goes on with the session");
}

std::string Servers::Links() const {
  return Implementation::Text(implementation_->sensor_) + "; " +
         Implementation::Text(implementation_->simulation_) +
         (implementation_->lease_->held() ? "" : "; " + implementation_->lease_->refusal());
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
  const stream::TrialPhase phase = frame().trial.progress.phase;
  if (phase == stream::TrialPhase::kReady || phase == stream::TrialPhase::kRunning) {
    v1::Command stop;
    stop.mutable_stop_trial()->set_character(1);
    if (const auto done = Call(std::move(stop)); !done) return done;
  }
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

void Servers::Show(const stream::StudyState& state) {
  v1::Command command;
  *command.mutable_set_study()->mutable_study() = wire::ToProto(state);
  implementation_->simulation_.client->Send(std::move(command), [](const v1::CommandResult&) {});
}

Result<void> Servers::Call(v1::Command command) {
  // The answer may come after an interruption has ended this wait.
  const auto answer = std::make_shared<std::optional<v1::CommandResult>>();
  command.set_deadline_ms(static_cast<std::uint32_t>(kAnswerS * 1e3));
  implementation_->simulation_.client->Send(
      std::move(command), [answer](const v1::CommandResult& result) { *answer = result; });
  const Waited waited =
      implementation_->console_.RunUntil([&] { return answer->has_value(); }, 2 * kAnswerS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) return Failure("footing-sim does not answer");
  if (!(*answer)->ok()) return Failure("footing-sim: " + (*answer)->message());
  return {};
}

}  // namespace footing::study

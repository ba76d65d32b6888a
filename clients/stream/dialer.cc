#include "clients/stream/dialer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/net/device_link.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"
#include "common/stream/leg_turn.h"
#include "common/stream/roles.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/board_cells.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/options/sensor_options.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"
#include "footing/v1/device.pb.h"

namespace footing::stream_client {
namespace {

constexpr double kPointEveryM = 0.25;
constexpr double kRememberedS = 1.5;
/// From a turn of the hands to a turn of the character, besides the reaction.
constexpr double kInterfaceS = 0.25;
/// Turning rate while both hands are inclined: 5 degrees a step (gait paper, section 7).
constexpr double kTurnPerStepRad = 5 * kPi / 180;
constexpr double kStepsPerS = 2.4;
/// Share of this turning rate that a player plans with.
constexpr double kTurnShare = 0.8;
constexpr double kSteerAboveRad = 0.08, kSteerBelowRad = 0.03;
/// Well above the 20 degrees at which the wrists turn.
constexpr double kInclinedRad = 30 * kPi / 180;
/// Frequencies over speeds, as the wrist interface maps them (its table of ranges).
constexpr double kWalkMps = 1.2, kWalkHz = 1.75, kWalkSlowMps = 0.6, kWalkSlowHz = 1.0;
constexpr double kRunSlowMps = 1.75, kRunSlowHz = 2.2, kRunMps = 3.0, kRunHz = 3.25;
constexpr double kWalkAmplitudeMps2 = 7, kRunAmplitudeMps2 = 13;
/// A walker wants a reason to run.
constexpr double kSlackMps = 0.25;

double Between(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0);
}

}  // namespace

Runner::Runner(std::uint64_t seed) {
  noise::Random random(seed);
  reaction_s_ = random.Uniform(0.2, 0.3);
  favourite_mps_ = random.Uniform(2.2, 2.8);
}

void Runner::SeeTrack(const stream::Track& track) {
  line_.clear();
  for (const stream::TrackSegment& segment : track.segments) {
    const Eigen::Vector2d way(std::cos(segment.heading_rad), std::sin(segment.heading_rad));
    for (double along_m = 0; along_m < segment.length_m; along_m += kPointEveryM) {
      line_.push_back({segment.start_m.head<2>() + along_m * way, segment.heading_rad});
    }
  }
}

void Runner::See(double time_s, const RunnerSight& sight) {
  seen_.push_back({time_s, sight});
  while (time_s - seen_.front().time_s > kRememberedS) seen_.pop_front();
}

/// Where the character will be when what the hands do now takes effect.
RunnerSight Runner::Reckon(double time_s) const {
  Seen old = seen_.front();
  for (const Seen& seen : seen_) {
    if (seen.time_s <= time_s - reaction_s_) old = seen;
  }
  RunnerSight now = old.sight;
  constexpr double kStepS = 0.05;
  for (double t_s = old.time_s; t_s < time_s + kInterfaceS; t_s += kStepS) {
    int side = 0;
    for (const Turned& turned : turned_) {
      if (turned.time_s + kInterfaceS <= t_s) side = turned.side;
    }
    now.heading_rad += side * kTurnPerStepRad * kStepsPerS * kStepS;
    now.p_W_m += now.speed_mps * kStepS *
                 Eigen::Vector2d(std::cos(now.heading_rad), std::sin(now.heading_rad));
  }
  return now;
}

std::size_t Runner::NearestTo(const Eigen::Vector2d& p_W_m) const {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < line_.size(); ++i) {
    if ((line_[i].p_W_m - p_W_m).squaredNorm() < (line_[nearest].p_W_m - p_W_m).squaredNorm()) {
      nearest = i;
    }
  }
  return nearest;
}

const Runner::Point& Runner::Ahead(std::size_t from, double ahead_m) const {
  const auto points = static_cast<std::size_t>(ahead_m / kPointEveryM);
  return line_[std::min(from + points, line_.size() - 1)];
}

/// The sharpest bend in sight, rad/m.
double Runner::BendAhead(std::size_t from, double speed_mps) const {
  constexpr double kSpanM = 3;
  double sharpest = 0;
  for (double ahead_m = 0; ahead_m < 3 + 2 * speed_mps; ahead_m += 0.5) {
    const double turn_rad =
        WrapAngle(Ahead(from, ahead_m + kSpanM).heading_rad - Ahead(from, ahead_m).heading_rad);
    sharpest = std::max(sharpest, std::fabs(turn_rad) / kSpanM);
  }
  return sharpest;
}

RunnerSwing Runner::Want(double time_s) {
  if (line_.empty() || seen_.empty()) return {};
  while (!turned_.empty() && time_s - turned_.front().time_s > kRememberedS) turned_.pop_front();
  const RunnerSight now = Reckon(time_s);
  const std::size_t here = NearestTo(now.p_W_m);
  const double speed_mps = std::max(0.0, now.speed_mps);
  const Eigen::Vector2d way = Ahead(here, std::clamp(1.2 + speed_mps, 2.0, 4.0)).p_W_m - now.p_W_m;
  const double error_rad = WrapAngle(std::atan2(way.y(), way.x()) - now.heading_rad);
  const bool steers = std::fabs(error_rad) > (side_ == 0 ? kSteerAboveRad : kSteerBelowRad);
  side_ = steers ? (error_rad > 0 ? 1 : -1) : 0;
  turned_.push_back({time_s, side_});

  const double rate_radps = kTurnShare * kTurnPerStepRad * kStepsPerS;
  const double bend = std::max(1e-3, BendAhead(here, speed_mps));
  const double most_mps = std::min(favourite_mps_, rate_radps / bend);
  runs_ = most_mps > kRunSlowMps + (runs_ ? 0 : kSlackMps);
  const double frequency_hz = runs_
                                  ? Between(most_mps, kRunSlowMps, kRunSlowHz, kRunMps, kRunHz)
                                  : Between(most_mps, kWalkSlowMps, kWalkSlowHz, kWalkMps, kWalkHz);
  return {frequency_hz, runs_ ? kRunAmplitudeMps2 : kWalkAmplitudeMps2, -side_ * kInclinedRad};
}

namespace {

/// How fast the hands change from one swing to another.
constexpr double kSwingChangeS = 0.12;

wrists::HandMotion UnitSwing() {
  wrists::Segment segment;
  segment.frequency_hz = 1;
  segment.phase_rad = kPi;
  segment.amplitude_mps2 = 1;
  return {{segment}, wrists::WristShape(), 0};
}

}  // namespace

LiveRunner::LiveRunner(std::uint64_t seed) : runner_(seed), unit_(UnitSwing()) {}

void LiveRunner::See(const v1::Tick& tick) {
  if (tick.has_track()) runner_.SeeTrack(wire::FromProto(tick.track()));
  if (tick.characters().characters_size() == 0) return;
  const v1::Character& character = tick.characters().characters(0);
  runner_.See(time_s_, {wire::FromProto(character.com_m()).head<2>(),
                        wire::Finite(character.gait().heading_rad()),
                        wire::Finite(character.gait().speed_mps())});
}

wrists::Hands LiveRunner::At(double t_s) {
  const double step_s = t_s - time_s_;
  if (step_s > 0) {
    time_s_ = t_s;
    const RunnerSwing wanted = runner_.Want(t_s);
    const double share = 1 - std::exp(-step_s / kSwingChangeS);
    swing_.amplitude_mps2 += share * (wanted.amplitude_mps2 - swing_.amplitude_mps2);
    swing_.roll_rad += share * (wanted.roll_rad - swing_.roll_rad);
    swing_.frequency_hz += share * (wanted.frequency_hz - swing_.frequency_hz);
    cycles_ += swing_.frequency_hz * step_s;
  }
  const Eigen::Vector3d level = wrists::InclinedGravity(0, 0);
  const Eigen::Vector3d inclined = wrists::InclinedGravity(swing_.roll_rad, 0);
  const wrists::Hands unit = unit_.At(std::fmod(cycles_, 1.0));
  return {inclined + swing_.amplitude_mps2 * (unit.left_mps2 - level),
          inclined + swing_.amplitude_mps2 * (unit.right_mps2 - level)};
}

Result<RunnerPlan> PlanRunner(const Common& common) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  RunnerPlan planned;
  planned.runner = std::make_shared<LiveRunner>(common.seed);
  for (const bool left : {true, false}) {
    const std::uint64_t device = left ? 1 : 2;
    const auto motion = [runner = planned.runner, left,
                         random = noise::Random(DeviceSeed(common, device))](double t_s) mutable {
      const wrists::Hands hands = runner->At(t_s);
      virtual_devices::WiimoteSensors sensors;
      sensors.specific_force_S_mps2 = left ? hands.left_mps2 : hands.right_mps2;
      for (int axis = 0; axis < 3; ++axis) {
        sensors.specific_force_S_mps2[axis] += wrists::SensorModel().noise_mps2 * random.Normal();
      }
      return sensors;
    };
    const auto role = left ? stream::DeviceRole::kLeftHand : stream::DeviceRole::kRightHand;
    planned.plan.devices.push_back(MakeRemote(common, *link, device, role, motion));
  }
  planned.plan.duration_s = common.seconds;
  return planned;
}

namespace {

using stream::DeviceRole;
using stream::TurnSource;
using stream::UserInterface;

/// Step of the user's body, s; every second one begins with a decision.
constexpr double kMoveS = 0.005;
constexpr double kBoardGapM = 0.02;
constexpr std::uint16_t kJumpButton = 0x0008;

/// Readings of the remote with this index among the body-worn ones, with a Wiimote's noise.
SimulatedDevice::WiimoteMotion RemoteOf(std::shared_ptr<LiveUser> user, std::size_t index,
                                        std::uint64_t seed, HeldKind kind) {
  const double noise_mps2 = kind == HeldKind::kWiimote ? wrists::SensorModel().noise_mps2 : 0;
  return [user = std::move(user), index, noise_mps2,
          random = noise::Random(seed)](double t_s) mutable {
    const users::Felt& felt = user->At(t_s);
    virtual_devices::WiimoteSensors sensors;
    if (index < static_cast<std::size_t>(felt.remote_count)) {
      sensors.specific_force_S_mps2 = felt.remotes[index].specific_force_S_mps2;
    }
    for (int axis = 0; axis < 3; ++axis) {
      sensors.specific_force_S_mps2[axis] += noise_mps2 * random.Normal();
    }
    sensors.buttons = felt.button_a ? kJumpButton : 0;
    sensors.nunchuk.stick_x = felt.stick_x;
    sensors.nunchuk.stick_y = felt.stick_y;
    return sensors;
  };
}

SimulatedDevice::CornerForces BoardOf(std::shared_ptr<LiveUser> user, std::size_t foot) {
  return [user = std::move(user), foot](double t_s) {
    const auto places = virtual_sensors::OneFootEach(kBoardGapM);
    const auto load = virtual_sensors::LoadBoard(places[foot], user->At(t_s).feet[foot]);
    const virtual_sensors::Corners& n = load.corners_n;
    return virtual_devices::CornerForces{n[0], n[1], n[2], n[3]};
  };
}

}  // namespace

LiveUser::LiveUser(UserInterface interface, TurnSource turn_by, const users::Style& style,
                   std::uint64_t seed, std::vector<users::Act> acts)
    : acts_(std::move(acts)),
      driver_(users::AbilityWith(interface, turn_by), style, seed),
      person_(interface, style, seed, turn_by) {}

void LiveUser::See(const v1::Tick& tick) {
  if (tick.has_track()) {
    track_ = wire::FromProto(tick.track());
    driver_.SeeTrack(track_);
  }
  if (tick.characters().characters_size() == 0) return;
  const v1::Character& character = tick.characters().characters(0);
  const stream::GaitState gait = wire::FromProto(character.gait());
  const Eigen::Vector3d com_m = wire::FromProto(character.com_m());
  seen_ = {.p_W_m = com_m.head<2>(),
           .com_m = com_m.z(),
           .heading_rad = gait.heading_rad,
           .speed_mps = gait.speed_mps,
           .steps = gait.steps,
           .falls = gait.falls,
           .gait = gait.gait,
           .trial = wire::FromProto(character.trial()).progress};
  for (std::size_t i = 0; i < track_.tasks.size(); ++i) {  // A trial's task is published by name.
    if (track_.tasks[i].name == character.trial().task()) seen_.trial.task = static_cast<int>(i);
  }
  seen_s_ = time_s_;
}

const users::Felt& LiveUser::At(double t_s) {
  if (t_s < at_s_ - 1) before_s_ = time_s_;  // The devices have connected again.
  at_s_ = t_s;
  const double until_s = before_s_ + t_s;
  while (time_s_ + kMoveS <= until_s) {
    time_s_ += kMoveS;
    seen_.time_s = time_s_;
    decides_ = !decides_;
    if (decides_) wanted_ = Want();
    person_.Advance(time_s_, wanted_);
    recent_.push_back({time_s_, person_.felt()});
    while (time_s_ - recent_.front().time_s > kRecentS) recent_.pop_front();
  }
  const auto then = std::find_if(recent_.rbegin(), recent_.rend(),
                                 [until_s](const Moment& one) { return one.time_s <= until_s; });
  return then == recent_.rend() ? person_.felt() : then->felt;
}

users::Intention LiveUser::Want() {
  if (!acts_.empty()) return users::WantedAt(acts_, time_s_);
  return time_s_ - seen_s_ < kBlindS ? driver_.Want(seen_) : users::Intention{};
}

Result<LiveUserPlan> PlanLiveUser(const LiveUserOptions& options, const Common& common,
                                  std::uint64_t style_seed) {
  const auto link = ParseLink(common.link);
  if (!link) return link.error();
  const UserInterface named = stream::UserInterfaceNamed(options.interface);
  const TurnSource turns = stream::LegTurnSourceNamed(options.turn_by);
  if (turns == TurnSource::kUnspecified) {
    return UsageError("unknown --turn-by " + options.turn_by + "; there are: head, feet, trunk");
  }
  const std::vector<DeviceRole> roles = stream::RolesOf(named, turns);
  if (roles.empty()) {
    return UsageError("unknown --interface " + options.interface +
                      "; there are: " + stream::UserInterfaceNames());
  }
  std::optional<users::GripWish> grip;
  if (options.grip_deg) {
    const auto parsed = users::ParseGrip(*options.grip_deg, options.grip_way, named);
    if (!parsed) return parsed.error();
    grip = *parsed;
  }
  std::vector<users::Act> acts;
  if (options.ranges) acts = users::RangeActs(named, turns);
  if (options.ranges && acts.empty()) {
    return UsageError(
        "--ranges: the user of a joystick has no range of its own; there are: wrist, "
        "arm, leg, boards");
  }
  const users::Style style = users::StyleOf(style_seed, named, grip, options.style);
  LiveUserPlan live{.plan = {},
                    .user = std::make_shared<LiveUser>(named, turns, style, style_seed, acts)};
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const std::uint64_t device = i + 1;
    const std::uint64_t seed = DeviceSeed(common, device);
    if (named == UserInterface::kBoards) {
      live.plan.devices.emplace_back(virtual_devices::BalanceBoard(seed), BoardOf(live.user, i),
                                     roles[i], virtual_devices::BoardLink(*link, seed + 500));
      continue;
    }
    live.plan.devices.push_back(
        MakeRemote(common, *link, device, roles[i], RemoteOf(live.user, i, seed, options.devices),
                   {options.devices, false, named == UserInterface::kJoystick}));
  }
  live.plan.duration_s = common.seconds;
  return live;
}

namespace {

/// --see and --ranges move a body, which the others describe.
void AddBody(CLI::App& user, UserOptions& options, CLI::Option* see, CLI::Option* ranges) {
  std::vector<CLI::Option*> body = sensor_options::AddUserStyle(user, options.style);
  body.push_back(user.add_option("--style-seed", options.style_seed,
                                 "Seed of the user's style; keep it for one person whose devices "
                                 "have several seeds (default: --seed)"));
  body.push_back(user.add_option(
      "--turn-by", options.turn_by,
      "Body part that steers with the interface leg: head, feet or trunk (default head)"));
  auto* grip = user.add_option("--grip-deg", options.grip_deg,
                               "Rotation of the remotes in the hands, with wrist and arm, degrees "
                               "(default: drawn with the style)");
  body.push_back(grip);
  user.add_option("--grip-way", options.grip_way,
                  "Grips of both hands: mirrored or same (default mirrored)")
      ->needs(grip);
  user.callback([body, see, ranges] {
    if (see->count() + ranges->count() > 0) return;
    for (const CLI::Option* option : body) {
      if (option->count() > 0) throw CLI::RequiresError(option->get_name(), "--see or --ranges");
    }
  });
}

}  // namespace

CLI::App* AddUserCommand(CLI::App& app, UserOptions& options) {
  auto* user = app.add_subcommand(
      "user", "A synthetic user, who follows a script or sees the track and steers along it");
  auto* script = user->add_option("--script", options.script,
                                  "Script of the user: a built-in name, or a JSON file");
  user->add_option(
      "--interface", options.interface,
      "Interface: wrist, arm, leg, joystick or boards; with --script wrist or joystick");
  auto* see = user->add_option("--see", options.see,
                               "Address of footing-sim, whose character, track and trial the user "
                               "sees, unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
  see->excludes(script);
  auto* ranges = user->add_flag("--ranges", options.ranges,
                                "Perform the motions for which footing-study ranges prompts, again "
                                "and again");
  ranges->excludes(script)->excludes(see);
  AddBody(*user, options, see, ranges);
  user->add_option("--devices", options.devices,
                   "Devices that the user holds: wiimote or joycon (default wiimote)");
  auto* motion_plus =
      user->add_flag("--motion-plus", options.held.motion_plus, "Add a MotionPlus to each Wiimote");
  auto* nunchuk =
      user->add_flag("--nunchuk", options.held.nunchuk, "Add a Nunchuk to each Wiimote");
  for (auto* body : {see, ranges}) body->excludes(motion_plus)->excludes(nunchuk);
  return user;
}

class Dialer::Implementation : public std::enable_shared_from_this<Dialer::Implementation> {
 public:
  Implementation(boost::asio::io_context& io, DialerOptions options, Plan plan,
                 std::function<void()> on_end)
      : options_(std::move(options)),
        duration_s_(plan.duration_s),
        on_end_(std::move(on_end)),
        devices_(std::move(plan.devices)),
        fresh_sources_(std::move(plan.feeds)),
        silences_(std::move(plan.silences)),
        link_(io, {.to = options_.to,
                   .client_name = "footing-stream",
                   .on_open = [this] { OnOpen(); },
                   .on_message = [this](const v1::DeviceEnvelope& message) { OnMessage(message); },
                   .on_refused = [this](const auto& message) { refused_.insert(message.slot()); },
                   .on_close = [this] { StopClocks(); }}) {
    sequences_.assign(devices_.size(), 0);
    // One for each, and one for the end.
    for (std::size_t i = 0; i < devices_.size() + fresh_sources_.size() + 1; ++i)
      clocks_.push_back(std::make_unique<timer::Timer>(io));
  }

  void Dial() { link_.Start(); }

  void Stop(const std::string& reason) {
    stopped_ = true;
    StopClocks();
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) SendDetach(slot, reason);
    link_.Stop(reason);
  }

  bool has_attached() const { return link_.was_open(); }
  Error NeverAttached() const { return link_.NeverOpen(); }
  bool all_refused() const { return !devices_.empty() && refused_.size() >= devices_.size(); }

 private:
  void OnOpen() {
    refused_.clear();
    const std::string what = devices_.empty()
                                 ? std::to_string(fresh_sources_.size()) + " simulated sources"
                                 : std::to_string(devices_.size()) + " simulated devices";
    log::Info("attached " + what + " to " + options_.to.Text());
    start_ns_ = clock::MonotonicNs();
    start_ = timer::Now();
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) {
      devices_[slot].Restart();
      if (devices_[slot].attaches_s() > 0) {
        AttachLater(slot);
      } else {
        SendAttach(slot);
        Schedule(slot);
      }
    }
    ScheduleEnd();
    sources_ = fresh_sources_;
    sent_.assign(sources_.size(), 0);
    for (std::size_t i = 0; i < sources_.size(); ++i) ScheduleSource(i);
  }

  void StopClocks() {
    for (auto& timer : clocks_) timer->cancel();
  }

  void AttachLater(std::size_t slot) {
    At(slot, devices_[slot].attaches_s() / options_.rate_scale, [this, slot] {
      SendAttach(slot);
      Schedule(slot);
    });
  }

  /// A device that has nothing more to send stays until it is lost.
  void DetachLater(std::size_t slot) {
    const double time_s = devices_[slot].detaches_s() / options_.rate_scale;
    if (std::isinf(time_s)) return;
    At(slot, time_s, [this, slot] { SendDetach(slot, "lost in the recording"); });
  }

  void SendDetach(std::size_t slot, const std::string& reason) {
    v1::DeviceEnvelope envelope;
    envelope.mutable_detach()->set_slot(static_cast<std::uint32_t>(slot));
    envelope.mutable_detach()->set_reason(reason);
    link_.Send(envelope);
  }

  /// Does something at a time of the motion, by one of the clocks: of a slot, a source or the end.
  void At(std::size_t slot, double time_s, std::function<void()> action) {
    clocks_[slot]->At(start_ + std::chrono::nanoseconds(SecondsToNanoseconds(time_s)),
                      [this, action = std::move(action)] {
                        if (link_.open() && !stopped_) action();
                      });
  }

  void SendAttach(std::size_t slot) {
    const virtual_devices::Identity& identity = devices_[slot].identity();
    v1::DeviceEnvelope envelope;
    v1::DeviceAttach& attach = *envelope.mutable_attach();
    attach.set_slot(static_cast<std::uint32_t>(slot));
    attach.set_bus(identity.bus);
    attach.set_vendor(identity.vendor);
    attach.set_product(identity.product);
    attach.set_name(identity.name);
    attach.set_serial(identity.serial);
    attach.set_role(static_cast<v1::DeviceRole>(devices_[slot].role()));
    link_.Send(envelope);
  }

  void OnMessage(const v1::DeviceEnvelope& envelope) {
    if (!envelope.has_output() || envelope.output().slot() >= devices_.size()) return;
    const std::string& bytes = envelope.output().report();
    const std::size_t slot = envelope.output().slot();
    const std::int64_t now_ns = clock::MonotonicNs();
    const double now_s = NanosecondsToSeconds(now_ns - start_ns_);
    if (IsSilent(slot, now_s)) return;
    SimulatedDevice& device = devices_[slot];
    if (envelope.output().channel() == v1::DeviceOutput::CHANNEL_FEATURE_GET) {
      if (bytes.empty()) return;
      const auto id = static_cast<std::uint8_t>(bytes[0]);
      SendReport(slot, device.Feature(id, envelope.output().size()), now_ns, true);
      return;
    }
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    for (const auto& report : device.HandleOutput(now_s, {first, bytes.size()})) {
      SendReport(slot, report, now_ns);
    }
    if (const std::string changes = device.Changes(now_s); !changes.empty()) log::Info(changes);
  }

  void Schedule(std::size_t slot) {
    SimulatedDevice::Arrival next = devices_[slot].Next();
    next.arrives_s /= options_.rate_scale;
    next.sampled_s /= options_.rate_scale;
    if (std::isinf(next.arrives_s)) return DetachLater(slot);
    At(slot, next.arrives_s, [this, slot, next] { Deliver(slot, next); });
  }

  bool IsSilent(std::size_t slot, double time_s) const {
    return std::any_of(silences_.begin(), silences_.end(), [&](const Silence& silence) {
      return silence.device == slot && silence.Covers(time_s);
    });
  }

  /// A recording may end with its devices silent: the end does not wait for their reports.
  void ScheduleEnd() {
    if (duration_s_ <= 0) return;
    At(clocks_.size() - 1, duration_s_, [this] { IsOver(duration_s_); });
  }

  /// The motion has come to its end, which is reported once.
  bool IsOver(double time_s) {
    if (duration_s_ <= 0 || time_s < duration_s_) return false;
    if (!ended_) on_end_();
    ended_ = true;
    return true;
  }

  void Deliver(std::size_t slot, const SimulatedDevice::Arrival& arrival) {
    if (IsOver(arrival.arrives_s)) return;
    for (const auto& report : devices_[slot].Deliver(arrival.sampled_s)) {
      if (IsSilent(slot, arrival.arrives_s)) continue;
      SendReport(slot, report, start_ns_ + SecondsToNanoseconds(arrival.sampled_s));
    }
    Schedule(slot);
  }

  SphereLights Lights() const {
    const double now_s = NanosecondsToSeconds(clock::MonotonicNs() - start_ns_);
    SphereLights lights;
    for (const SimulatedDevice& device : devices_)
      if (const auto rgb = device.SphereLight(now_s)) lights[device.role()] = *rgb;
    return lights;
  }

  void ScheduleSource(std::size_t index) {
    const double due_s = static_cast<double>(sent_[index]) / sources_[index].rate_hz;
    At(devices_.size() + index, due_s + sources_[index].late_s,
       [this, index, due_s] { SendDue(index, due_s); });
  }

  /// Sends the value at `due_s`; its age is how late this is.
  void SendDue(std::size_t index, double due_s) {
    if (devices_.empty() && IsOver(due_s)) return;
    Feed& feed = sources_[index];
    if (feed.frames) {
      feed.frames(due_s, start_ns_ + SecondsToNanoseconds(due_s), Lights());
      ++sent_[index];
      return ScheduleSource(index);
    }
    const std::int64_t now_ns = clock::MonotonicNs();
    const std::int64_t age_ns =
        std::max<std::int64_t>(0, now_ns - start_ns_ - SecondsToNanoseconds(due_s));
    v1::DeviceEnvelope envelope;
    if (feed.hands) {
      stream::HandFrame frame = feed.hands(due_s);
      frame.age_ns = age_ns;
      frame.sent_ns = now_ns;
      *envelope.mutable_hand_frame() = wire::ToProto(frame);
    } else if (feed.contacts) {
      stream::ContactFrame frame = feed.contacts(due_s);
      frame.age_ns = age_ns;
      frame.sent_ns = now_ns;
      *envelope.mutable_contact_frame() = wire::ToProto(frame);
    } else {
      stream::ReferenceFrame frame = feed.reference(due_s);
      frame.age_ns = age_ns;
      frame.sent_ns = now_ns;
      *envelope.mutable_reference_frame() = wire::ToProto(frame);
    }
    link_.Send(envelope);
    ++sent_[index];
    ScheduleSource(index);
  }

  void SendReport(std::size_t slot, const virtual_devices::Report& report, std::int64_t true_ns,
                  bool feature = false) {
    v1::DeviceEnvelope envelope;
    v1::DeviceInputReport& input = *envelope.mutable_input_report();
    input.set_slot(static_cast<std::uint32_t>(slot));
    input.set_sequence(++sequences_[slot]);
    input.set_report(report.data(), report.size());
    input.set_true_ns(true_ns);
    input.set_feature(feature);
    link_.Send(envelope);
  }

  const DialerOptions options_;
  const double duration_s_;  // Duration of the motion; 0 goes on until stopped.
  const std::function<void()> on_end_;
  std::vector<SimulatedDevice> devices_;
  const std::vector<Feed> fresh_sources_;
  const std::vector<Silence> silences_;
  std::vector<Feed> sources_;
  std::vector<std::uint64_t> sent_;  // How often each was.
  std::vector<std::unique_ptr<timer::Timer>> clocks_;
  timer::TimePoint start_;
  std::vector<std::uint64_t> sequences_;
  std::set<std::uint32_t> refused_;  ///< Slots, on the present connection.
  device_link::DeviceLink link_;
  std::int64_t start_ns_ = 0;
  bool stopped_ = false;
  bool ended_ = false;
};

Dialer::Dialer(boost::asio::io_context& io, DialerOptions options, Plan plan,
               std::function<void()> on_end)
    : implementation_(std::make_shared<Implementation>(io, std::move(options), std::move(plan),
                                                       std::move(on_end))) {}

Dialer::~Dialer() = default;

void Dialer::Start() { implementation_->Dial(); }
bool Dialer::has_attached() const { return implementation_->has_attached(); }
Error Dialer::NeverAttached() const { return implementation_->NeverAttached(); }
bool Dialer::all_refused() const { return implementation_->all_refused(); }
void Dialer::Stop(const std::string& reason) { implementation_->Stop(reason); }

}  // namespace footing::stream_client

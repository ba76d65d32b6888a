#include "daemon/offline/eval/track_trial.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <system_error>

#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/stream/roles.h"
#include "common/virtual/people/driver.h"
#include "common/virtual/people/person.h"
#include "daemon/simulation/biped/trial.h"
#include "daemon/simulation/mapping/boards.h"

namespace footing::eval {

void Agreement::Add(double time_s, stream::Gait meant, stream::Gait commanded, double delay_s,
                    bool still_stands) {
  if (meant_.empty() || meant_.back().gait != meant) meant_.push_back({time_s, meant});
  // The newest change from before the delay is what was meant when it began.
  while (meant_.size() > 1 && meant_[1].time_s <= time_s - delay_s) meant_.pop_front();
  const bool agrees =
      still_stands || std::any_of(meant_.begin(), meant_.end(),
                                  [&](const Meant& past) { return past.gait == commanded; });
  ++count_;
  agree_ += agrees ? 1 : 0;
  if (meant_.size() == 1 && meant_.front().time_s <= time_s - delay_s) {
    const stream::Gait shown = agrees && still_stands ? meant : commanded;
    ++table_[stream::IndexOf(meant)][stream::IndexOf(shown)];
  }
}

void Agreement::Pool(const Agreement& other) {
  count_ += other.count_;
  agree_ += other.agree_;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    for (std::size_t j = 0; j < table_.size(); ++j) table_[i][j] += other.table_[i][j];
  }
}

void Delay::Add(double time_s) {
  ++count;
  sum_s += time_s;
  sum_s2 += time_s * time_s;
}

void Delay::Pool(const Delay& other) {
  count += other.count;
  sum_s += other.sum_s;
  sum_s2 += other.sum_s2;
}

double Delay::sd_s() const {
  if (count < 2) return 0;
  const double n = static_cast<double>(count);
  return std::sqrt(std::max(0.0, sum_s2 - sum_s * sum_s / n) / (n - 1));
}

void JumpDelays::Add(double time_s, bool meant, bool commanded, bool jumps, double delay_s) {
  if (meant) meant_s_ = time_s;
  if (time_s - meant_s_ > delay_s) begun_s_.reset();
  // A gesture in a jump, or under a command, asks for nothing new.
  if (meant && !meant_ && !commanded_ && !jumps) begun_s_ = time_s;
  if (commanded && !commanded_ && begun_s_) {
    to_command_.Add(time_s - *begun_s_);
    commanded_s_ = time_s;
    begun_s_.reset();
  }
  if (!commanded) commanded_s_.reset();
  if (jumps && commanded_s_) {
    to_take_off_.Add(time_s - *commanded_s_);
    commanded_s_.reset();
  }
  meant_ = meant;
  commanded_ = commanded;
}

void JumpDelays::Restart() {
  begun_s_.reset();
  commanded_s_.reset();
  meant_ = commanded_ = false;
}

void JumpDelays::Pool(const JumpDelays& other) {
  to_command_.Pool(other.to_command_);
  to_take_off_.Pool(other.to_take_off_);
}

void JumpEvents::Decide(bool recognised, bool late) {
  begun_s_.reset();
  ++meant_count_;
  recognised_ += recognised ? 1 : 0;
  late_ += late ? 1 : 0;
}

void JumpEvents::Add(double time_s, bool meant, bool commanded, double delay_s) {
  if (meant && !meant_) {
    if (begun_s_) Decide(false, false);  // The next gesture comes before the last one's command.
    begun_s_ = time_s;
  }
  if (meant) meant_s_ = time_s;
  meant_ = meant;
  const bool lately = meant_s_ && time_s - *meant_s_ <= delay_s;
  if (commanded && !commanded_) {
    ++commanded_count_;
    not_meant_ += lately ? 0 : 1;
  }
  commanded_ = commanded;
  if (!begun_s_) return;
  overdue_ = time_s - *begun_s_ > delay_s;
  if (commanded) {
    Decide(true, overdue_);
  } else if (!lately) {
    Decide(false, false);
  }
}

void JumpEvents::Restart() {
  if (begun_s_ && overdue_) Decide(false, false);
  begun_s_.reset();
  meant_ = commanded_ = overdue_ = false;
}

void JumpEvents::Pool(const JumpEvents& other) {
  meant_count_ += other.meant_count_;
  recognised_ += other.recognised_;
  late_ += other.late_;
  commanded_count_ += other.commanded_count_;
  not_meant_ += other.not_meant_;
}

namespace {

constexpr const char* kColumns =
    "seed,time,place,aside,heading_error,speed,wanted,meant,commanded,runs,phase,"
    "commanded_speed,wanted_turn,commanded_turn,failures,next,frequency,phase_between,"
    "elevation,turn_share\n"
    ",s,m,m,deg,m/s,,,,,,m/s,deg,deg,,,Hz,deg,deg,1\n";

}  // namespace

Result<TrackTrace> TrackTrace::Create(const std::string& path) {
  TrackTrace trace;
  if (path.empty()) return trace;
  trace.path_ = path;
  trace.file_.open(path);
  trace.file_ << kColumns;
  if (!trace.file_.flush()) return trace.CannotWrite();
  return trace;
}

Error TrackTrace::CannotWrite() const {
  return Failure("cannot write " + path_ + ": " +
                 std::generic_category().message(error_ != 0 ? error_ : errno) +
                 "; name another file");
}

Result<void> TrackTrace::Flush() {
  if (!file_.is_open() || file_.flush()) return {};
  return CannotWrite();
}

void TrackTrace::Add(stream::Gait wanted, stream::Gait meant, double turn_rad,
                     const engine::EngineOutput& output) {
  if (!file_.is_open()) return;
  const stream::GaitState& gait = output.gait;
  const stream::InterfaceState& shown = output.interface;
  const auto degrees = [](double angle_rad) { return RadiansToDegrees(angle_rad); };
  file_ << seed_ << ',' << output.time_s << ',' << output.trial.distance_m << ','
        << output.trial.lateral_offset_m << ',' << degrees(output.trial.heading_error_rad) << ','
        << gait.speed_mps << ',' << stream::Name(wanted) << ',' << stream::Name(meant) << ','
        << stream::Name(gait.commanded_gait) << ',' << stream::Name(gait.gait) << ',' << gait.phase
        << ',' << gait.commanded_speed_mps << ',' << degrees(turn_rad) << ','
        << degrees(gait.commanded_turn_rad) << ',' << gait.falls << ','
        << stream::Name(shown.next_gait) << ',';
  if (shown.frequency_valid) file_ << shown.frequency_hz;
  file_ << ',';
  if (shown.phase_valid) file_ << degrees(shown.phase_rad);
  file_ << ',';
  if (shown.forearms.valid) file_ << degrees(shown.forearms.elevation_rad);
  file_ << ',';
  if (shown.turn.valid) file_ << shown.turn.share;
  file_ << '\n';
  if (!file_ && error_ == 0) error_ = errno;
}

namespace {

using stream::Gait;
using stream::UserInterface;

/// Nobody is given up before: the paper's subjects all finished.
constexpr double kLongestS = 600;
constexpr double kKickNs = 2;
/// People stand before the start line until a trial begins, or run towards it.
constexpr double kStandsS = 1, kRunsMps = 2;
constexpr int kStepsPerSight = 10;
/// Time in which people change over from one motion to another (common/virtual/people/person.cc).
constexpr double kChangeOverS = 0.4;
/// A change of the motion is followed at the pace of the slower one.
constexpr double kPaceS = 2;

/// How long an interface may take to follow a change of the motion (docs/interfaces.md): limbs of
/// the wrist, the arm and the leg interface 1.9 cycles; feet on boards two whole steps after the
/// one in which the motion changes or, to notice a stop, 1.3 s.
double FollowsWithin(UserInterface interface, double limb_hz) {
  switch (interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kLeg:
      return kChangeOverS + 1.9 / limb_hz;
    case UserInterface::kJoystick:
      return kChangeOverS;
    case UserInterface::kBoards:
      return kChangeOverS + std::max(1.3, 1.5 / limb_hz);
  }
  return kChangeOverS;
}

users::Style StyleOf(const TrackUser& user) {
  if (!user.interface) return users::DrawStyle(user.seed);
  return users::StyleOf(user.seed, *user.interface, user.grip, user.style);
}

users::Observation See(const engine::EngineOutput& output) {
  return {.time_s = output.time_s,
          .p_W_m = output.p_WC_m.head<2>(),
          .com_m = output.p_WC_m.z(),
          .heading_rad = output.gait.heading_rad,
          .speed_mps = output.gait.speed_mps,
          .steps = output.gait.steps,
          .falls = output.gait.falls,
          .gait = output.gait.gait,
          .trial = output.trial};
}

bool HasEvent(const engine::EngineOutput& output, engine::EventKind kind) {
  return std::any_of(output.events.begin(), output.events.begin() + output.event_count,
                     [kind](const auto& event) { return event.kind == kind; });
}

/// A user's body with its devices.
struct Embodied {
  users::Person person;
  UserDevices devices;
  double slowest_hz = 1;       ///< Lowest cadence of the last motions.
  double jump_meant_s = -1e9;  ///< When a jump was last meant.
};

/// One engine with its user.
class TrackTrial {
 public:
  TrackTrial(engine::GaitEngine engine, const TrackUser& user, TrackTrace& trace)
      : engine_(std::move(engine)),
        user_(user),
        trace_(trace),
        driver_(user.interface ? users::AbilityWith(*user.interface, user.turn_by)
                               : users::DirectAbility(),
                StyleOf(user), user.seed) {
    trace_.Begin(user.seed);
    Random random(user.seed);
    kick_s_ = random.Uniform(3, 20);
    kick_rad_ = random.Uniform(-kPi, kPi);
    driver_.SeeTrack(engine_.track());
    if (user.interface) {
      users::Person person(*user.interface, StyleOf(user), user.seed, user.turn_by);
      person.Advance(0, {});
      const users::Felt at_rest = person.felt();
      embodied_.emplace(Embodied{
          std::move(person), {*user.interface, user.turn_by, user.seed, user.devices, at_rest}});
    }
    if (embodied_) WaitForTrial();
    inputs_.trial = {.number = 1, .task = trial::DrawTask(engine_.track(), user.seed)};
  }

  TrackResult Run() {
    const double longest_s = user_.seconds ? kStandsS + *user_.seconds : kLongestS;
    while (engine_.Output().time_s < longest_s && !result_.completed) Look();
    const stream::TrialProgress& end = engine_.Output().trial;
    result_.failures = end.failures;
    result_.distance_m = engine_.Output().gait.distance_m;
    if (end.task >= 0) {
      result_.task = engine_.track().tasks[static_cast<std::size_t>(end.task)].name;
    }
    return result_;
  }

 private:
  void WaitForTrial() {
    users::Intention until = {};
    if (user_.starts_running) until = {.gait = Gait::kRun, .speed_mps = kRunsMps};
    while (engine_.Output().time_s < kStandsS) {
      Move(engine_.Output().time_s, until);
      for (int i = 0; i < kStepsPerSight; ++i) engine_.Advance(inputs_);
      Compare();
    }
  }

  void Move(double time_s, const users::Intention& wanted) {
    if (!embodied_) {
      inputs_.direct = true;
      inputs_.direct_command = {.gait = wanted.gait,
                                .speed_mps = wanted.speed_mps,
                                .height_m = wanted.height_m,
                                .turn_per_step_rad = wanted.turn_rad};
      return;
    }
    embodied_->person.Advance(time_s - HeldDevices::kStepS, wanted);
    embodied_->devices.Feel(embodied_->person.felt());
    embodied_->person.Advance(time_s, wanted);
    inputs_.features = embodied_->devices.Take(embodied_->person.felt());
    ++inputs_.features_number;
    const double limb_hz = embodied_->person.limb_hz();
    if (limb_hz <= 0) return;
    double& slowest_hz = embodied_->slowest_hz;
    slowest_hz = std::min(limb_hz, slowest_hz + UserDevices::kTickS / kPaceS * limb_hz);
  }

  void Compare() {
    if (!embodied_) return;
    const engine::EngineOutput& output = engine_.Output();
    const Gait meant = embodied_->person.gesture(), commanded = output.gait.commanded_gait;
    if (meant == Gait::kJump) embodied_->jump_meant_s = output.time_s;
    const double delay_s = FollowsWithin(*user_.interface, embodied_->slowest_hz);
    // A press or a heel rise commands a jump until the character has taken it over.
    const bool one_jump =
        *user_.interface == UserInterface::kJoystick || *user_.interface == UserInterface::kBoards;
    const bool waits =
        one_jump && commanded == Gait::kJump &&
        output.time_s - embodied_->jump_meant_s < delay_s + mapping::HeldJump::kMostWaitS;
    result_.agreement.Add(output.time_s, meant, commanded, delay_s, waits);
    result_.jumps.Add(output.time_s, meant == Gait::kJump, commanded == Gait::kJump, delay_s);
    result_.jump_delays.Add(output.time_s, meant == Gait::kJump, commanded == Gait::kJump,
                            output.gait.gait == Gait::kJump, delay_s);
  }

  /// One look of the user at the picture, and what the character does until the next.
  void Look() {
    const engine::EngineOutput& seen = engine_.Output();
    const users::Intention wanted = driver_.Want(See(seen));
    Move(seen.time_s, wanted);
    if (inputs_.push_number == 0 && seen.time_s >= kick_s_) {
      inputs_.push_number = 1;
      inputs_.push_impulse_W_ns =
          kKickNs * Eigen::Vector2d(std::cos(kick_rad_), std::sin(kick_rad_));
    }
    for (int i = 0; i < kStepsPerSight; ++i) Step();
    const engine::EngineOutput& output = engine_.Output();
    trace_.Add(wanted.gait, embodied_ ? embodied_->person.gesture() : wanted.gait, wanted.turn_rad,
               output);
    result_.time_s = output.trial.time_s;
    result_.completed = output.trial.phase == stream::TrialPhase::kFinished;
    if (fallen_) {
      result_.agreement.Restart();
      result_.jumps.Restart();
      result_.jump_delays.Restart();
      return;
    }
    Compare();
    result_.off_centre.Add(output.trial.lateral_offset_m);
  }

  void Step() {
    engine_.Advance(inputs_);
    const engine::EngineOutput& output = engine_.Output();
    if (output.append.added) driver_.SeeTrack(engine_.track());  // It grows.
    const bool put_back = HasEvent(output, engine::EventKind::kPutBack);
    fallen_ = (fallen_ || HasEvent(output, engine::EventKind::kFall)) && !put_back;
    if (fallen_) return;
    result_.heading_error.Add(
        WrapAngle(YawOf(output.links[0].orientation) - output.gait.heading_rad));
    result_.line_heading.Add(output.trial.heading_error_rad);
    if (!output.trial.on_track) result_.off_track_s += engine::EngineConfig{}.step_s;
  }

  engine::GaitEngine engine_;
  TrackUser user_;
  TrackTrace& trace_;
  engine::EngineInputs inputs_;
  users::Driver driver_;
  std::optional<Embodied> embodied_;
  double kick_s_ = 0, kick_rad_ = 0;
  TrackResult result_;
  bool fallen_ = false;
};

}  // namespace

Result<TrackResult> RunTrack(const std::string& track_text, const TrackUser& user,
                             TrackTrace& trace) {
  Result<engine::GaitEngine> engine =
      NewEngineOn(track_text,
                  {.interface = user.interface.value_or(UserInterface::kWrist),
                   .leg = {.turn_by = user.turn_by}},
                  user.mapping_table);
  if (!engine) return engine.error();
  if (engine->track().finish_m <= 0 && !user.seconds) {
    return UsageError("the track \"" + engine->track().name +
                      "\" has no finish line: give --seconds");
  }
  return TrackTrial(std::move(engine).value(), user, trace).Run();
}

namespace {

using stream::DeviceRole;
using stream::TurnSource;

constexpr double kBoardHz = 60;
constexpr double kBoardGapM = 0.02;
/// A Nunchuk's stick has about so many counts from its centre to the rim.
constexpr double kStickCounts = 95;
/// White noise of a board's cell, kg; and its gains' spread (Bartlett, Ting & Bingham 2014).
constexpr double kCellNoiseKg = 0.05;
constexpr double kCellGainSpread = 0.01;

/// Device numbers are those of the roles.
std::uint32_t DeviceOf(DeviceRole role) { return static_cast<std::uint32_t>(role); }

/// Boards have no features.
std::vector<features::Member> MembersFor(UserInterface interface, TurnSource turn_by) {
  std::vector<features::Member> members;
  if (interface == UserInterface::kBoards) return members;
  for (const DeviceRole role : stream::RolesOf(interface, turn_by)) {
    members.push_back({DeviceOf(role), role});
  }
  return members;
}

}  // namespace

UserDevices::UserDevices(UserInterface interface, TurnSource turn_by, std::uint64_t seed,
                         HeldKind kind, const users::Felt& at_rest)
    : interface_(interface), random_(seed), chain_(MembersFor(interface, turn_by)) {
  if (kind != HeldKind::kWiimote) {
    held_ = std::make_unique<HeldDevices>(kind, stream::RolesOf(interface, turn_by), seed, at_rest);
  }
  for (const std::uint64_t board : {1u, 2u}) {
    cells_.emplace_back(virtual_sensors::CellErrorConfig{
        .gain_spread = kCellGainSpread, .noise_kg = kCellNoiseKg, .seed = seed + board});
  }
}

void UserDevices::Feel(const users::Felt& felt) {
  if (held_) held_->Feel(felt);
}

void UserDevices::TakePublished(const users::Felt& felt) {
  held_->Feel(felt);
  const sensor::TickContent content = held_->Tick();
  if (interface_ != UserInterface::kJoystick) {
    if (!content.features.empty()) TakeFeatures(content.features.front());
    return;
  }
  mapping::StickInput& stick = inputs_.stick;
  for (const stream::NunchukSample& sample : content.nunchuks) {
    stick.present = true;
    stick.x = sample.stick_x;
    stick.y = sample.stick_y;
  }
  for (const stream::MotionSample& sample : content.motion) {
    constexpr std::uint32_t kButtonA = 0x0008;
    const bool pressed = (sample.buttons & kButtonA) != 0;
    if (pressed && !stick.pressed) ++stick.presses;
    stick.pressed = pressed;
  }
}

/// Shins and the trunk have a mounting; hands and the head need none.
void UserDevices::TakeFeatures(const stream::RigFeatures& features) {
  std::uint32_t mounted_roles = 0;
  for (const stream::DeviceFeatures& device : features.devices) {
    const DeviceRole role = device.role;
    const bool mounted =
        role == DeviceRole::kLeftLeg || role == DeviceRole::kRightLeg || role == DeviceRole::kTrunk;
    if (mounted) mounted_roles |= stream::RoleBit(role);
  }
  mapping::TakeFeatures(features, mounted_roles, inputs_);
}

void UserDevices::TakeRemotes(const users::Felt& felt) {
  const std::int64_t now_ns = SecondsToNanoseconds(static_cast<double>(ticks_) * kTickS);
  for (std::size_t i = 0; i < static_cast<std::size_t>(felt.remote_count); ++i) {
    const users::FeltRemote& remote = felt.remotes[i];
    const auto reading = wrists::Read(sensor_, remote.specific_force_S_mps2, random_);
    chain_.Add(DeviceOf(remote.role), now_ns, reading.specific_force_mps2, reading.clipped_axes);
  }
  TakeFeatures(chain_.Compute(now_ns));
}

void UserDevices::TakeStick(const users::Felt& felt) {
  mapping::StickInput& stick = inputs_.stick;
  stick.present = true;
  stick.x = std::round(felt.stick_x * kStickCounts) / kStickCounts;
  stick.y = std::round(felt.stick_y * kStickCounts) / kStickCounts;
  if (felt.button_a && !stick.pressed) ++stick.presses;
  stick.pressed = felt.button_a;
}

void UserDevices::TakeBoards(const users::Felt& felt) {
  const double now_s = static_cast<double>(ticks_) * kTickS;
  if (now_s < board_due_s_) return;
  board_due_s_ += 1 / kBoardHz;
  const auto places = virtual_sensors::OneFootEach(kBoardGapM);
  for (std::size_t foot = 0; foot < 2; ++foot) {
    const auto load = virtual_sensors::LoadBoard(places[foot], felt.feet[foot]);
    const auto read = cells_[foot].Advance(load.corners_n, 1 / kBoardHz);
    const board::PlateReading reading = plates_[foot].Advance({read[0], read[1], read[2], read[3]});
    mapping::BoardInput& board = foot == 0 ? inputs_.left_board : inputs_.right_board;
    board = {.present = true, .corners_n = read, .cop_valid = reading.cop_valid};
    if (!reading.cop_valid) continue;
    const virtual_sensors::BoardPlace& place = places[foot];
    const Eigen::Vector2d cop_W_m = board::InWorld(
        {place.middle_m.x(), place.middle_m.y(), place.yaw_rad}, reading.cop_x_m, reading.cop_y_m);
    board.cop_x_m = cop_W_m.x();
    board.cop_y_m = cop_W_m.y();
  }
}

mapping::Inputs UserDevices::Take(const users::Felt& felt) {
  ++ticks_;
  if (held_) {
    TakePublished(felt);
    return inputs_;
  }
  switch (interface_) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kLeg:
      TakeRemotes(felt);
      break;
    case UserInterface::kJoystick:
      TakeStick(felt);
      break;
    case UserInterface::kBoards:
      TakeBoards(felt);
      break;
  }
  return inputs_;
}

}  // namespace footing::eval

#include "daemon/offline/eval/track_trial.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/people/driver.h"
#include "common/virtual/people/person.h"
#include "daemon/offline/eval/user_devices.h"
#include "daemon/simulation/mapping/held_jump.h"
#include "daemon/simulation/biped/trial.h"

namespace footing::eval {
namespace {

using stream::Gait;
using stream::UserInterface;

/// Nobody is given up before: the paper's subjects all finished.
constexpr double kLongestS = 600;
constexpr double kKickNs = 2;
/// People stand before the start line until a trial begins.
constexpr double kStandsS = 1;
constexpr int kStepsPerSight = 10;
/// Time in which people change over from one motion to another (common/virtual/people/rhythm.cc).
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

bool Has(const engine::EngineOutput& output, engine::EventKind kind) {
  return std::any_of(output.events.begin(), output.events.begin() + output.event_count,
                     [kind](const auto& event) { return event.kind == kind; });
}

/// A user's body with its devices.
struct Embodied {
  users::Person person;
  UserDevices devices;
  double slowest_hz = 1;       ///< Of the last motions.
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
      embodied_.emplace(Embodied{{*user.interface, StyleOf(user), user.seed, user.turn_by},
                                 {*user.interface, user.turn_by, user.seed}});
    }
    if (embodied_) Stand();
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
  void Stand() {
    while (engine_.Output().time_s < kStandsS) {
      Move(engine_.Output().time_s, {});
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
    const bool put_back = Has(output, engine::EventKind::kPutBack);
    fallen_ = (fallen_ || Has(output, engine::EventKind::kFall)) && !put_back;
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

}  // namespace footing::eval

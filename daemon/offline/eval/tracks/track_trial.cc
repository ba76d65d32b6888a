#include "daemon/offline/eval/tracks/track_trial.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/config/data_file.h"
#include "common/units/units.h"
#include "daemon/offline/eval/tracks/synthetic_user.h"
#include "daemon/offline/eval/tracks/synthetic_wrists.h"
#include "daemon/simulation/trial/trial.h"

namespace footing::eval {
namespace {

constexpr double kLongestS = 300;
constexpr double kKickNs = 2;
constexpr int kStepsPerSight = 10;

/// Between a user and an engine.
class Channel {
 public:
  explicit Channel(engine::EngineInputs& inputs) : inputs_(inputs) {}
  virtual ~Channel() = default;
  virtual void Send(const biped::GaitCommand& wanted) = 0;

 protected:
  engine::EngineInputs& inputs_;
};

class DirectChannel : public Channel {
 public:
  using Channel::Channel;
  void Send(const biped::GaitCommand& wanted) override {
    inputs_.direct = true;
    inputs_.direct_command = wanted;
  }
};

class WristChannel : public Channel {
 public:
  WristChannel(engine::EngineInputs& inputs, const mapping::WristMapping& mapping,
               std::uint64_t seed)
      : Channel(inputs), wrists_(mapping, seed) {}
  void Send(const biped::GaitCommand& wanted) override {
    inputs_.features = wrists_.Advance(wanted);
    ++inputs_.features_number;
  }

 private:
  SyntheticWrists wrists_;
};

Result<mapping::WristMapping> ReadMapping() {
  const Result<std::string> text = config::ReadDataFile(mapping::kWristMappingFile);
  if (!text) return text.error();
  return mapping::ParseWristMapping(*text, mapping::kWristMappingFile);
}

/// The wrists' range is the mapping's; a change of the swing is felt after about one cycle.
Skill WristSkill(const mapping::WristMapping& mapping) {
  return {.walk_min_mps = mapping.swing.walk_mps_from_hz.to_min,
          .walk_max_mps = mapping.swing.walk_mps_from_hz.to_max - 0.1,
          .run_min_mps = mapping.swing.run_mps_from_hz.to_min + 0.15,
          .run_max_mps = mapping.swing.run_mps_from_hz.to_max,
          .jump_mps = mapping.swing.jump_mps_from_hz.to_max,
          .jump_height_m = mapping.swing.jump_m_from_mps2.to_max,
          .turn_per_step_rad = mapping.turn.turn_per_step_rad,
          .turns_by_degrees = false,
          .delay_s = 0.25};
}

Sight See(const engine::EngineOutput& output, std::uint64_t put_backs) {
  return {.time_s = output.time_s,
          .p_W_m = output.p_WC_m.head<2>(),
          .heading_rad = output.gait.heading_rad,
          .speed_mps = output.gait.speed_mps,
          .steps = output.gait.steps,
          .gait = output.gait.gait,
          .put_backs = put_backs,
          .task = output.trial.task,
          .task_phase = output.trial.task_phase};
}

bool Fell(const engine::EngineOutput& output) {
  return std::any_of(output.events.begin(), output.events.begin() + output.event_count,
                     [](const auto& event) { return event.kind == engine::EventKind::kFall; });
}

bool WasPutBack(const engine::EngineOutput& output) {
  return std::any_of(output.events.begin(), output.events.begin() + output.event_count,
                     [](const auto& event) { return event.kind == engine::EventKind::kPutBack; });
}

/// One engine with its user.
class TrackTrial {
 public:
  TrackTrial(engine::GaitEngine engine, Interface interface, const mapping::WristMapping& mapping,
             std::uint64_t seed)
      : engine_(std::move(engine)),
        random_(seed),
        kick_s_(random_.Uniform(3, 20)),
        kick_rad_(random_.Uniform(-kPi, kPi)),
        channel_(MakeChannel(interface, mapping, seed)),
        user_(engine_.track(), interface == Interface::kWrist ? WristSkill(mapping) : Skill{},
              random_) {
    inputs_.trial = {.number = 1, .task = trial::DrawTask(engine_.track(), seed)};
  }

  TrackResult Run() {
    while (engine_.Output().time_s < kLongestS && !result_.completed) Look();
    const stream::TrialProgress& end = engine_.Output().trial;
    result_.failures = end.failures;
    if (end.task >= 0) {
      result_.task = engine_.track().tasks[static_cast<std::size_t>(end.task)].name;
    }
    return result_;
  }

 private:
  std::unique_ptr<Channel> MakeChannel(Interface interface, const mapping::WristMapping& mapping,
                                       std::uint64_t seed) {
    if (interface == Interface::kDirect) return std::make_unique<DirectChannel>(inputs_);
    return std::make_unique<WristChannel>(inputs_, mapping, seed);
  }

  /// One look of the user at the picture, and what the character does until the next.
  void Look() {
    const engine::EngineOutput& seen = engine_.Output();
    channel_->Send(user_.Want(See(seen, put_backs_)));
    if (inputs_.push_number == 0 && seen.time_s >= kick_s_) {
      inputs_.push_number = 1;
      inputs_.push_impulse_W_ns =
          kKickNs * Eigen::Vector2d(std::cos(kick_rad_), std::sin(kick_rad_));
    }
    for (int i = 0; i < kStepsPerSight; ++i) Step();
    const engine::EngineOutput& output = engine_.Output();
    result_.time_s = output.trial.time_s;
    result_.completed = output.trial.phase == stream::TrialPhase::kFinished;
    if (!fallen_) result_.off_centre.Add(output.trial.lateral_offset_m);
  }

  void Step() {
    engine_.Advance(inputs_);
    const engine::EngineOutput& output = engine_.Output();
    if (WasPutBack(output)) ++put_backs_;
    fallen_ = (fallen_ || Fell(output)) && !WasPutBack(output);
    if (fallen_) return;
    result_.heading_error.Add(
        WrapAngle(YawOf(output.links[0].orientation) - output.gait.heading_rad));
    result_.line_heading.Add(output.trial.heading_error_rad);
  }

  engine::GaitEngine engine_;
  engine::EngineInputs inputs_;
  Random random_;
  double kick_s_, kick_rad_;
  std::unique_ptr<Channel> channel_;
  SyntheticUser user_;
  TrackResult result_;
  std::uint64_t put_backs_ = 0;
  bool fallen_ = false;
};

}  // namespace

Result<TrackResult> RunTrack(const std::string& track_text, Interface interface,
                             std::uint64_t seed) {
  Result<engine::GaitEngine> engine = NewEngineOn(track_text);
  if (!engine) return engine.error();
  if (engine->track().finish_m <= 0) {
    return UsageError("the track \"" + engine->track().name + "\" has no finish line");
  }
  const Result<mapping::WristMapping> mapping = ReadMapping();
  if (!mapping) return mapping.error();
  return TrackTrial(std::move(engine).value(), interface, *mapping, seed).Run();
}

}  // namespace footing::eval

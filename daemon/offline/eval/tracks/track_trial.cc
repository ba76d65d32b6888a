#include "daemon/offline/eval/tracks/track_trial.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/config/data_file.h"
#include "common/units/units.h"
#include "daemon/offline/eval/tracks/synthetic_user.h"
#include "daemon/offline/eval/tracks/synthetic_wrists.h"
#include "daemon/simulation/terrain/track.h"

namespace footing::eval {
namespace {

constexpr double kLongestS = 300;
constexpr double kFinishM = 100;
constexpr double kRunOutM = 3;
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
  const Result<std::string> text = config::ReadDataFile(engine::kWristMappingFile);
  if (!text) return text.error();
  return mapping::ParseWristMapping(*text, engine::kWristMappingFile);
}

/// The wrists' range is the mapping's; a change of the swing is felt after about one cycle.
Skill WristSkill(const mapping::WristMapping& mapping) {
  return {.walk_min_mps = mapping.walk_mps_from_hz.to_min,
          .walk_max_mps = mapping.walk_mps_from_hz.to_max - 0.1,
          .run_min_mps = mapping.run_mps_from_hz.to_min + 0.15,
          .run_max_mps = mapping.run_mps_from_hz.to_max,
          .jump_mps = mapping.jump_mps_from_hz.to_max,
          .jump_height_m = mapping.jump_m_from_mps2.to_max,
          .turn_per_step_rad = mapping.turn_per_step_rad,
          .turns_by_degrees = false,
          .delay_s = 0.25};
}

Sight See(const engine::EngineOutput& output) {
  return {.time_s = output.time_s,
          .p_W_m = output.p_WC_m.head<2>(),
          .heading_rad = output.gait.heading_rad,
          .speed_mps = output.gait.speed_mps,
          .steps = output.gait.steps,
          .gait = output.gait.gait};
}

void CountFailures(const engine::EngineOutput& output, TrackResult& result) {
  for (int i = 0; i < output.event_count; ++i) {
    const engine::EngineEvent& event = output.events[static_cast<std::size_t>(i)];
    if (event.kind != engine::EventKind::kFall) continue;
    ++result.failures[static_cast<std::size_t>(event.cause)];
  }
}

bool Fell(const engine::EngineOutput& output) {
  return std::any_of(output.events.begin(), output.events.begin() + output.event_count,
                     [](const auto& event) { return event.kind == engine::EventKind::kFall; });
}

bool WasPutBack(const engine::EngineOutput& output) {
  return std::any_of(output.events.begin(), output.events.begin() + output.event_count,
                     [](const auto& event) { return event.kind == engine::EventKind::kPutBack; });
}

}  // namespace

Result<TrackResult> RunTrack(const std::string& track_text, Interface interface,
                             std::uint64_t seed) {
  Result<engine::GaitEngine> engine = NewEngineOn(track_text);
  if (!engine) return engine.error();
  const Result<mapping::WristMapping> mapping = ReadMapping();
  if (!mapping) return mapping.error();
  Random random(seed);
  const double kick_s = random.Uniform(3, 20);
  const double kick_rad = random.Uniform(-kPi, kPi);
  const stream::Track& track = engine->track();
  const double finish_m = std::min(terrain::LengthOf(track) - kRunOutM, kFinishM);

  engine::EngineInputs inputs;
  std::unique_ptr<Channel> channel;
  Skill skill;
  switch (interface) {
    case Interface::kDirect:
      channel = std::make_unique<DirectChannel>(inputs);
      break;
    case Interface::kWrist:
      skill = WristSkill(*mapping);
      channel = std::make_unique<WristChannel>(inputs, *mapping, seed);
      break;
  }
  SyntheticUser user(track, skill, random);
  TrackResult result;
  bool fallen = false;
  while (result.time_s < kLongestS) {
    const engine::EngineOutput& seen = engine->Output();
    channel->Send(user.Want(See(seen)));
    if (inputs.push_number == 0 && result.time_s >= kick_s) {
      inputs.push_number = 1;
      inputs.push_impulse_W_ns = kKickNs * Eigen::Vector2d(std::cos(kick_rad), std::sin(kick_rad));
    }
    for (int i = 0; i < kStepsPerSight; ++i) {
      engine->Advance(inputs);
      const engine::EngineOutput& output = engine->Output();
      CountFailures(output, result);
      fallen = (fallen || Fell(output)) && !WasPutBack(output);
      if (fallen) continue;
      result.heading_error.Add(
          WrapAngle(YawOf(output.links[0].orientation) - output.gait.heading_rad));
    }
    const engine::EngineOutput& output = engine->Output();
    result.time_s = output.time_s;
    const terrain::TrackPlace place = terrain::Locate(track, output.p_WC_m.head<2>());
    if (!fallen) result.off_centre.Add(place.distance_m);
    result.completed = !fallen && terrain::LengthTo(track, place) >= finish_m;
    if (result.completed) break;
  }
  return result;
}

}  // namespace footing::eval

#include "daemon/simulation/engine/engine.h"

#include <cmath>

#include "daemon/simulation/biped/mjcf.h"
#include "daemon/simulation/biped/skeleton.h"
#include "daemon/simulation/engine/parts.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/terrain/ground.h"
#include "daemon/simulation/terrain/track.h"

namespace footing::engine {

GaitEngine::GaitEngine(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
GaitEngine::GaitEngine(GaitEngine&&) noexcept = default;
GaitEngine& GaitEngine::operator=(GaitEngine&&) noexcept = default;
GaitEngine::~GaitEngine() = default;

Result<GaitEngine> GaitEngine::Create(const EngineTexts& texts, const EngineConfig& config) {
  if (!(config.step_s > 0 && config.step_s <= 0.002)) {
    return UsageError("step_s is " + std::to_string(config.step_s) +
                      ", allowed is more than 0 and up to 0.002");
  }
  Result<biped::BipedParameters> biped = biped::ParseBiped(texts.biped, kBipedFile);
  if (!biped) return biped.error();
  Result<stream::Track> track = terrain::ParseTrack(texts.track, "the track");
  if (!track) return track.error();
  Result<mapping::WristMapping> mapping =
      mapping::ParseWristMapping(texts.wrist_mapping, kWristMappingFile);
  if (!mapping) return mapping.error();
  gait::GainTable gain_table;
  for (const GainText& gains : texts.gains) {
    if (const auto added = gain_table.Add(gains.text, gains.origin); !added) return added.error();
  }
  std::vector<std::string> boxes;
  for (int i = 0; track->extendable && i < terrain::kGroundBoxes; ++i) {
    boxes.push_back(terrain::GroundBoxName(i));
  }
  Result<physics::World> world = physics::World::FromMjcf(
      biped::WriteMjcf(*biped, terrain::GroundMjcf(*track), config.step_s), biped::Names(boxes));
  if (!world) return world.error();

  auto parts = std::make_unique<Parts>(Parts{.config = config,
                                             .biped = *biped,
                                             .gain_table = std::move(gain_table),
                                             .gains = {},
                                             .track = std::move(*track),
                                             .skeleton = biped::DescribeSkeleton(*biped),
                                             .first_segments = {},
                                             .sees_ground = false,
                                             .world = std::move(*world),
                                             .state = {.world = {},
                                                       .gait = {},
                                                       .wrist = mapping::WristInterface(*mapping),
                                                       .command = {},
                                                       .inputs = {},
                                                       .response = {},
                                                       .track = {}},
                                             .body = {},
                                             .output = {}});
  parts->sees_ground = !terrain::IsLevel(parts->track);
  if (parts->track.extendable) {
    parts->first_segments = parts->track.segments;
    parts->track.segments.reserve(terrain::kMostSegments);
    parts->PlaceGround();
  }
  const stream::TrackSegment start = parts->track.segments.front();
  parts->Stand(start.start_m, start.heading_rad);
  return GaitEngine(std::move(parts));
}

void GaitEngine::Advance(const EngineInputs& inputs) {
  Parts& p = *parts_;
  p.output.event_count = 0;
  p.output.appended = false;
  p.output_stale = true;
  const stream::Gait gait_before = p.state.gait.gait;
  p.TakeFeatures(inputs);
  p.TakePush(inputs);
  p.Command(inputs);
  if (p.state.inputs.put_back_number != inputs.put_back_number) {
    p.state.inputs.put_back_number = inputs.put_back_number;
    if (!p.state.fallen) ++p.state.operator_put_backs;
    p.PutBack("by a command", true);
  } else if (p.state.fallen && p.TimeS() - p.state.fallen_time_s >= p.config.fall_shown_s) {
    p.PutBack("after a failure", false);
  }
  p.TakeAppend(inputs);
  p.PlaceGround();
  p.StepWorld();
  p.NoteGait(gait_before);
  p.NoteFall();
}

const EngineOutput& GaitEngine::Output() {
  if (parts_->output_stale) parts_->FillOutput();
  parts_->output_stale = false;
  return parts_->output;
}

const stream::Skeleton& GaitEngine::skeleton() const { return parts_->skeleton; }
const stream::Track& GaitEngine::track() const { return parts_->track; }

void GaitEngine::UseGains(const gait::GainTable& table) {
  parts_->gain_table = table;
  parts_->gains_gait = stream::Gait::kUnspecified;
}

EngineState GaitEngine::Save() const {
  EngineState state = parts_->state;
  state.world = parts_->world.Save();
  parts_->SaveTrack(state.track);
  return state;
}

void GaitEngine::Restore(const EngineState& state) {
  Parts& p = *parts_;
  p.state = state;
  p.RestoreTrack();
  p.body.p_WB = Eigen::Vector3d(state.world.qpos[0], state.world.qpos[1], state.world.qpos[2]);
  p.PlaceGround();
  p.world.Restore(state.world);
  p.body = biped::Read(p.biped, p.world.Observe(), p.TimeS());
  p.output.event_count = 0;
  p.output.appended = false;
  p.output_stale = true;
}

}  // namespace footing::engine

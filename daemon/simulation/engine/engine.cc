#include "daemon/simulation/engine/engine.h"

#include <utility>

#include "daemon/simulation/biped/skeleton.h"
#include "daemon/simulation/engine/parts.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine {

GaitEngine::GaitEngine(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
GaitEngine::GaitEngine(GaitEngine&&) noexcept = default;
GaitEngine& GaitEngine::operator=(GaitEngine&&) noexcept = default;
GaitEngine::~GaitEngine() = default;

Result<GaitEngine> GaitEngine::Create(const EngineTexts& texts, const EngineConfig& config) {
  Result<stream::Track> track = terrain::ParseTrack(texts.track, "the track");
  if (!track) return track.error();
  return CreateOn(std::move(track).value(), texts, config);
}

Result<GaitEngine> GaitEngine::CreateOn(stream::Track track, const EngineTexts& texts,
                                        const EngineConfig& config) {
  if (!(config.step_s > 0 && config.step_s <= 0.002)) {
    return UsageError("step_s is " + std::to_string(config.step_s) +
                      ", allowed is more than 0 and up to 0.002");
  }
  Result<biped::BipedParameters> biped = biped::ParseBiped(texts.biped, kBipedFile);
  if (!biped) return biped.error();
  Result<mapping::AnyInterface> interface =
      mapping::AnyInterface::Create(config.interface, texts.mapping);
  if (!interface) return interface.error();
  gait::GainTable gain_table;
  for (const GainText& gains : texts.gains) {
    if (const auto added = gain_table.Add(gains.text, gains.origin); !added) return added.error();
  }
  Result<std::unique_ptr<TrackWorld>> on = MakeTrackWorld(std::move(track), *biped, config.step_s);
  if (!on) return on.error();

  auto parts = std::make_unique<Parts>(Parts{.config = config,
                                             .biped = *biped,
                                             .gain_table = std::move(gain_table),
                                             .gains = {},
                                             .skeleton = biped::DescribeSkeleton(*biped),
                                             .on = std::move(**on),
                                             .state = {.world = {},
                                                       .gait = {},
                                                       .interface = *interface,
                                                       .command = {},
                                                       .inputs = {},
                                                       .response = {},
                                                       .track = {},
                                                       .trial = {}},
                                             .body = {},
                                             .place = {},
                                             .output = {}});
  parts->BeginOnTrack();
  parts->state.trial = trial::Begin(parts->on.track, trial::DrawTask(parts->on.track, 0));
  return GaitEngine(std::move(parts));
}

void GaitEngine::Advance(const EngineInputs& inputs) {
  Parts& p = *parts_;
  p.output.event_count = 0;
  p.output.append.added = false;
  p.output_stale = true;
  const stream::Gait gait_before = p.state.gait.gait;
  p.TakeFeatures(inputs);
  p.TakeInterface(inputs);
  p.TakePush(inputs);
  p.Command(inputs);
  p.TakeTrial(inputs);
  p.TakePutBack(inputs);
  p.TakeAppend(inputs);
  p.ExtendEndless();
  p.PlaceGround();
  p.StepWorld();
  p.NoteGait(gait_before);
  p.NoteTrial();
  p.NoteFall();
}

void GaitEngine::UseTrack(TrackWorld& other) {
  std::swap(parts_->on, other);
  parts_->BeginOnTrack();
  parts_->output_stale = true;
}

const EngineOutput& GaitEngine::Output() {
  if (parts_->output_stale) parts_->FillOutput();
  parts_->output_stale = false;
  return parts_->output;
}

const stream::Skeleton& GaitEngine::skeleton() const { return parts_->skeleton; }
const stream::Track& GaitEngine::track() const { return parts_->on.track; }

void GaitEngine::UseGains(const gait::GainTable& table) {
  parts_->gain_table = table;
  parts_->gains_gait = stream::Gait::kUnspecified;
}

EngineState GaitEngine::Save() const {
  EngineState state = parts_->state;
  state.world = parts_->on.world.Save();
  parts_->SaveTrack(state.track);
  return state;
}

void GaitEngine::Restore(const EngineState& state) {
  Parts& p = *parts_;
  p.state = state;
  p.RestoreTrack();
  p.place = terrain::Locate(p.on.track, {state.world.qpos[0], state.world.qpos[1]});
  p.PlaceGround();
  p.on.world.Restore(state.world);
  p.ReadBody();
  p.output.event_count = 0;
  p.output.append.added = false;
  p.output_stale = true;
}

}  // namespace footing::engine

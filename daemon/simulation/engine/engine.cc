#include "daemon/simulation/engine/engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <mujoco/mujoco.h>

#include "common/base/text.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/gait/controller.h"

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

namespace {

Result<gait::GainTable> TableOf(const std::vector<GainText>& texts) {
  gait::GainTable table;
  for (const GainText& gains : texts) {
    if (const auto added = table.Add(gains.text, gains.origin); !added) return added.error();
  }
  return table;
}

}  // namespace

Result<GaitEngine> GaitEngine::CreateOn(stream::Track track, const EngineTexts& texts,
                                        const EngineConfig& config) {
  if (!(config.step_s > 0 && config.step_s <= 0.002)) {
    return UsageError("step_s is " + std::to_string(config.step_s) +
                      ", allowed is more than 0 and up to 0.002");
  }
  Result<biped::BipedParameters> biped = biped::ParseBiped(texts.biped, kBipedFile);
  if (!biped) return biped.error();
  biped = biped::On(*biped, config.surface);
  Result<mapping::AnyInterface> interface =
      mapping::AnyInterface::Create(config.interface, texts.mapping);
  if (!interface) return interface.error();
  const Result<gait::GainTable> gain_table = TableOf(texts.gains);
  if (!gain_table) return gain_table.error();
  const Result<gait::GainTable> style_table = TableOf(texts.style);
  if (!style_table) return style_table.error();
  Result<GainChoices> choices = texts.choices.text.empty()
                                    ? GainChoices()
                                    : ReadChoices(texts.choices.text, texts.choices.origin);
  if (!choices) return choices.error();
  Result<std::unique_ptr<TrackWorld>> on = MakeTrackWorld(std::move(track), *biped, config.step_s);
  if (!on) return on.error();

  auto parts = std::make_unique<Parts>(
      Parts{.config = config,
            .biped = *biped,
            .tables = {.plain = *gain_table, .style = *style_table, .choices = std::move(*choices)},
            .gains = {},
            .gains_ahead = {},
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

Result<std::string> ExportMjcf(const EngineTexts& texts, const EngineConfig& config,
                               const std::string& writer) {
  const Result<GaitEngine> engine = GaitEngine::Create(texts, config);
  if (!engine) return engine.error();
  const Result<biped::BipedParameters> biped = biped::ParseBiped(texts.biped, kBipedFile);
  if (!biped) return biped.error();
  std::string start = "<keyframe>\n<key name='start' qpos='";
  for (const double value : engine->Save().world.qpos) start += text::Shortest(value) + " ";
  start.back() = '\'';
  start += "/>\n</keyframe>\n";
  const terrain::GroundText ground = terrain::WholeGroundMjcf(engine->track());
  return "<!-- The biped of the gait engine on its track. Written by " + writer + " for MuJoCo " +
         mj_versionString() +
         ".\n     Start: mj_resetDataKeyframe(model, data, 0), then mj_forward(model, data).\n"
         "     Each step: the efforts of the eight joints in ctrl, N m and N; a push on the body "
         "in\n"
         "     xfrc_applied of \"body\", N; then mj_step(model, data). -->\n" +
         biped::WriteMjcf(biped::On(*biped, config.surface), ground.mjcf, ground.names,
                          config.step_s, biped::MotorsMjcf() + start);
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
  p.TakeTow(inputs);
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
  parts_->tables = {.plain = table, .style = {}, .choices = {}};
  parts_->gains.Forget();
  parts_->gains_ahead.Forget();
}

void GaitEngine::UseStyle(const gait::GainTable& table) {
  parts_->tables.style = table;
  parts_->gains.Forget();
  parts_->gains_ahead.Forget();
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

namespace {

using stream::FailureCause;

/// A fall is put down to what a foot is over when the foot is lower than this over the ribbon, m:
/// legs shorten in a fall, and a foot in the air is higher.
constexpr double kLowFootM = 0.1;
/// Only with a foot this far under the ribbon is what it is over looked up without a fall, m.
constexpr double kSunkM = 0.05;

/// Ground that a foot has missed.
struct MissedGround {
  bool pit = false, pit_deep = false, edge = false;
};

MissedGround Missed(const stream::Track& track, const biped::BodyState& body) {
  MissedGround missed;
  for (const biped::LegState& leg : body.legs) {
    const Eigen::Vector2d p_W = leg.p_WF.head<2>();
    const terrain::TrackPlace place = terrain::Locate(track, p_W);
    const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
    const double depth_m = terrain::RibbonHeight(segment, place) - leg.p_WF.z();
    const bool beside = terrain::IsOffRibbon(track, place);
    missed.edge = missed.edge || (beside && depth_m > -kLowFootM);
    missed.pit = missed.pit || (segment.pit && !beside && depth_m > -kLowFootM);
    missed.pit_deep = missed.pit_deep || (segment.pit && !beside && depth_m > kFootInPitM);
  }
  return missed;
}

const char* WhyFallen(double ground_m, const biped::BodyState& body,
                      const physics::Observation& seen) {
  if (seen.diverged) return "the simulation diverged";
  if (body.p_WB.z() - ground_m < kLowestBodyM) return "the body is below 0.55 m";
  if (body.R_WB(2, 2) < std::cos(kLargestTiltRad)) return "the body tilts over 60 degrees";
  if (seen.other_contact) return "something else than a foot touches";
  return nullptr;
}

}  // namespace

Failure FindFailure(const stream::Track& track, const terrain::TrackPlace& place,
                    const biped::BodyState& body, const physics::Observation& seen) {
  const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
  const char* why = WhyFallen(terrain::RibbonHeight(segment, place), body, seen);
  if (terrain::HasPlane(track)) return {FailureCause::kSimulation, why};
  const bool beside = !track.open && terrain::IsOffRibbon(track, place);
  // Both feet high and nothing wrong: no need to look what is under them.
  const double lowest_foot_m = std::min(body.legs[0].p_WF.z(), body.legs[1].p_WF.z());
  const bool sunk = lowest_foot_m < terrain::RibbonHeight(segment, place) - kSunkM;
  const MissedGround missed = sunk || why != nullptr ? Missed(track, body) : MissedGround{};
  if (missed.pit_deep) return {FailureCause::kJump, "a foot is in a pit"};
  if (beside) return {FailureCause::kCurve, "the body is beside the track"};
  if (missed.pit) return {FailureCause::kJump, why};
  return {missed.edge ? FailureCause::kCurve : FailureCause::kSimulation, why};
}

bool MissesPit(const stream::Track& track, const terrain::TrackPlace& place,
               const biped::BodyState& body) {
  const auto& segments = track.segments;
  const auto at = static_cast<std::size_t>(place.segment);
  const std::size_t first = at > 0 ? at - 1 : 0, last = std::min(at + 1, segments.size() - 1);
  bool near = false;
  for (std::size_t i = first; i <= last; ++i) near = near || segments[i].pit;
  if (!near) return false;
  return std::any_of(
      body.legs.begin(), body.legs.end(), [&track, &segments](const biped::LegState& leg) {
        const terrain::TrackPlace foot = terrain::Locate(track, leg.p_WF.head<2>());
        const stream::TrackSegment& segment = segments[static_cast<std::size_t>(foot.segment)];
        if (!segment.pit || terrain::IsOffRibbon(track, foot)) return false;
        // Over a pit there is nothing to touch but its edges and walls.
        return leg.touching || leg.p_WF.z() < terrain::RibbonHeight(segment, foot) - kSunkM;
      });
}

}  // namespace footing::engine

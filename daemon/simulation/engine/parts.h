#pragma once

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/engine/track_world.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine {

/// What a GaitEngine owns; its methods are the parts of one step, in their order.
struct GaitEngine::Parts {
  EngineConfig config;
  biped::BipedParameters biped;
  gait::GainTable gain_table;
  gait::Gains gains;  ///< Of gains_gait at gains_speed_mps.
  stream::Gait gains_gait = stream::Gait::kUnspecified;
  double gains_speed_mps = 0;
  stream::Skeleton skeleton;
  TrackWorld on;                                                 ///< The track with its physics.
  std::array<std::uint64_t, terrain::kGroundBoxes> box_holds{};  ///< Segment's number + 1; 0 none.

  EngineState state;
  biped::BodyState body;
  terrain::TrackPlace place;  ///< Of the body on the track, as of `body`.
  EngineOutput output;
  bool output_stale = true;

  double TimeS() const { return static_cast<double>(state.step) * config.step_s; }
  void AddEvent(const EngineEvent& event);

  /// Stands the character at the start of a track that it has not been on.
  void BeginOnTrack();
  /// Stands the character on a point of the track, feet under the hips.
  void Stand(const Eigen::Vector3d& p_W_m, double heading_rad);
  /// Puts the character back to a point `to_m` along the track.
  void PutBack(const char* why, double to_m, bool by_operator);
  /// Takes in what the world shows after a step or a reset.
  void ReadBody();
  /// What the gait controllers see of the ground; null where it is level for them.
  const stream::Track* Sight() const {
    if (!on.sees_ground) return nullptr;
    return on.track.help_over_pits ? &on.track : &on.sight;
  }
  double DistanceAlong() const { return terrain::LengthTo(on.track, place); }

  void TakeFeatures(const EngineInputs& inputs);
  void TakeInterface(const EngineInputs& inputs);
  void TakePush(const EngineInputs& inputs);
  void Command(const EngineInputs& inputs);
  /// Follows the gait that runs and its desired speed; the table is looked up when they change.
  void ChooseGains();
  /// Puts the character back when the inputs ask for it, or some time after a failure.
  void TakePutBack(const EngineInputs& inputs);
  /// Begins or stops a trial.
  void TakeTrial(const EngineInputs& inputs);
  void TakeAppend(const EngineInputs& inputs);
  /// Lays more of an endless track ahead of the character.
  void ExtendEndless();
  /// Puts the world's boxes under the segments around the character.
  void PlaceGround();
  void SaveTrack(TrackMemory& memory) const;
  void RestoreTrack();
  void StepWorld();
  void NoteGait(stream::Gait before);
  void NoteTrial();
  void NoteFall();
  void Fail(stream::FailureCause cause, const char* why);
  /// How the trial stands as of the last step.
  stream::TrialProgress Progress() const;
  void FillOutput();
};

}  // namespace footing::engine

#pragma once

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/engine/state.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/terrain/ground.h"

namespace footing::engine {

/// What a GaitEngine owns; its methods are the parts of one step, in their order.
struct GaitEngine::Parts {
  EngineConfig config;
  biped::BipedParameters biped;
  gait::GainTable gain_table;
  gait::Gains gains;  ///< Of gains_gait at gains_speed_mps.
  stream::Gait gains_gait = stream::Gait::kUnspecified;
  double gains_speed_mps = 0;
  stream::Track track;
  stream::Skeleton skeleton;
  std::vector<stream::TrackSegment> first_segments;              ///< The file's.
  std::array<std::uint64_t, terrain::kGroundBoxes> box_holds{};  ///< Segment's number + 1; 0 none.
  bool sees_ground = false;  ///< The track has slopes, steps or pits.
  physics::World world;

  EngineState state;
  biped::BodyState body;
  EngineOutput output;
  bool output_stale = true;

  double TimeS() const { return static_cast<double>(state.step) * config.step_s; }
  void AddEvent(const EngineEvent& event);

  /// Stands the character on a point of the track, feet under the hips.
  void Stand(const Eigen::Vector3d& p_W_m, double heading_rad);
  void PutBack(const char* why, bool by_operator);

  void TakeFeatures(const EngineInputs& inputs);
  void TakePush(const EngineInputs& inputs);
  void Command(const EngineInputs& inputs);
  /// Follows the gait that runs and its desired speed; the table is looked up when they change.
  void ChooseGains();
  void TakeAppend(const EngineInputs& inputs);
  /// Puts the world's boxes under the segments around the character.
  void PlaceGround();
  void SaveTrack(TrackMemory& memory) const;
  void RestoreTrack();
  void StepWorld();
  void NoteGait(stream::Gait before);
  void NoteFall();
  void FillOutput();
};

}  // namespace footing::engine

#pragma once

#include <memory>
#include <vector>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/biped/trial.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/engine/foresight.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/gait/targets.h"
#include "daemon/simulation/mapping/any_interface.h"

namespace footing::engine {

/// Numbers of the inputs that the engine has taken so far.
struct InputMemory {
  std::uint64_t features_number = 0;
  std::uint64_t interface_number = 0;
  std::uint64_t push_number = 0;
  std::uint64_t put_back_number = 0;
  std::uint64_t trial_number = 0;
  double features_time_s = 0;  ///< When features last were new.
  bool fed = false;            ///< New features arrived within the timeout.
  Eigen::Vector3d push_W_n = Eigen::Vector3d::Zero();
  int push_steps_left = 0;
  Eigen::Vector3d tow_W_n = Eigen::Vector3d::Zero();
};

/// From a command to its controller.
struct ResponseMemory {
  bool waiting = false;
  ResponseSteps steps;
};

/// The track as far as it grew; of a track that does not grow, nothing.
struct TrackMemory {
  std::uint64_t append_number = 0;                   ///< Taken or refused.
  std::uint64_t first_segment = 0;                   ///< Dropped so far.
  double first_m = 0;                                ///< Length of those.
  std::uint64_t revision = 0;                        ///< 0: the track is still the file's.
  Eigen::Vector2d course = Eigen::Vector2d::Zero();  ///< Average direction of travel.
  std::size_t count = 0;
  std::array<stream::TrackSegment, terrain::kMostSegments> segments;
};

/// Everything in a GaitEngine that changes with time on one track.
struct EngineState {
  physics::WorldState world;
  gait::GaitMemory gait;
  mapping::AnyInterface interface;
  biped::GaitCommand command;
  InputMemory inputs;
  ResponseMemory response;
  TrackMemory track;
  trial::TrialMemory trial;
  Foresight foresight = {};
  std::uint64_t step = 0;
  stream::FailureCounts failures = {};
  std::uint64_t operator_put_backs = 0;
  double distance_m = 0;
  bool fallen = false;
  double fallen_time_s = 0;
  double missed_pit_s = -1e9;  ///< When a foot last was in a pit or on its edge.
  double put_back_to_m = 0;    ///< Where the put-back after the failure goes, along the track.
  bool simulated_input = false;
};

/// A track and the physics over it, as a GaitEngine runs on them.
struct TrackWorld {
  stream::Track track;
  /// The track as the gait controllers see it: without its pits where it does not help over them.
  stream::Track sight;
  bool sees_ground = false;                          ///< That has slopes, steps or pits.
  std::vector<stream::TrackSegment> first_segments;  ///< The file's, on a track that grows.
  terrain::GroundWindow window;                      ///< Boxes that follow the character.
  physics::World world;
  physics::World twin;  ///< For rollouts.
};

/// Builds the physics of a track. Allocates, and takes some milliseconds: not for the simulation
/// thread. Fails when the physics engine does not accept it.
Result<std::unique_ptr<TrackWorld>> MakeTrackWorld(stream::Track track,
                                                   const biped::BipedParameters& biped,
                                                   double step_s);

/// Members of a GaitEngine; the methods are the parts of one step, in their order.
struct GaitEngine::Parts {
  EngineConfig config;
  biped::BipedParameters biped;
  GainTables tables;
  GainsInForce gains;
  GainsInForce gains_ahead;  ///< The same in rollouts.
  stream::Skeleton skeleton;
  TrackWorld on;                                                 ///< The track with its physics.
  std::array<std::uint64_t, terrain::kGroundBoxes> box_holds{};  ///< Segment's number + 1; 0 none.

  EngineState state;
  biped::BodyState body;
  terrain::TrackPlace place;  ///< Place of the body on the track, as of `body`.
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
  /// Ground that the gait controllers see; null where it is level for them.
  const stream::Track* Sight() const {
    if (!on.sees_ground) return nullptr;
    return on.track.help_over_pits ? &on.track : &on.sight;
  }
  double DistanceAlong() const { return terrain::LengthTo(on.track, place); }

  void TakeFeatures(const EngineInputs& inputs);
  void TakeInterface(const EngineInputs& inputs);
  void TakePush(const EngineInputs& inputs);
  void TakeTow(const EngineInputs& inputs);
  void Command(const EngineInputs& inputs);
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
  /// After a push, and at the phases of a gait that is out of its rhythm: chooses gains by
  /// rollouts.
  void LookAhead(int phase_before, bool push_ended);
  void NoteGait(stream::Gait before);
  void NoteTrial();
  void NoteFall();
  void Fail(stream::FailureCause cause, const char* why);
  /// How the trial stands as of the last step.
  stream::TrialProgress Progress() const;
  void FillOutput();
};

}  // namespace footing::engine

#pragma once

#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/gait/memory.h"
#include "daemon/simulation/mapping/any_interface.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/biped/trial.h"

namespace footing::engine {

/// What the engine has taken of its inputs so far.
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

}  // namespace footing::engine

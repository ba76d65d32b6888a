#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clients/view/scene/part.h"
#include "common/rig/follower.h"
#include "common/stream/character.h"
#include "common/stream/device.h"
#include "common/stream/game.h"
#include "common/stream/hands.h"
#include "common/stream/response.h"
#include "common/stream/sensor.h"
#include "common/stream/setup.h"
#include "common/stream/study.h"
#include "common/stream/user_interface.h"

/// Contents of one tick of a server, as plain structs. World frame W: x forward, y left, z up; SI.
namespace footing::scene {

/// One character of one frame.
struct CharacterPose {
  std::uint32_t character = 0;
  std::string rig;
  bool valid = false;
  std::vector<stream::LinkPose> links;  ///< In the order of the skeleton's links.
  std::vector<stream::Contact> contacts;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_velocity_mps = Eigen::Vector3d::Zero();
  stream::GaitState gait;  ///< Its phase stays empty: the name travels as a text of its own.
  std::string phase;
  stream::InterfaceState interface;  ///< Interface state of the gait engine.
  bool simulated_input = false;
  std::optional<BodyState> body;            ///< Body of a reconstructed person.
  std::optional<stream::TrialState> trial;  ///< Trial of a character on a track.
};

/// One frame of the world, from one tick of footing-sim.
struct WorldFrame {
  std::uint64_t sequence = 0;  ///< Sequence number of its tick.
  std::uint64_t step = 0;
  double time_s = 0;  ///< Simulation time.
  std::uint64_t overruns = 0;
  std::vector<CharacterPose> characters;
};

/// Kinds of notes that the viewer shows or counts.
enum class NoteKind {
  kOther,
  kFall,
  kPutBack,
  kGaitChanged,
  kResponse,
  kStreamLost,
  kStreamBack,
  kServer,  ///< Something slows the server or this session.
};

/// An event, for a person to read.
struct Note {
  NoteKind kind = NoteKind::kOther;
  std::int64_t host_ns = 0;
  std::string text;
  stream::ResponseStages response;  ///< Stages of a kResponse.
  std::int64_t received_ns = 0;     ///< On the viewer's clock.
};

/// Liveness of one connection.
enum class LinkState { kConnecting, kLive, kStale, kRefused };

/// State of one connection.
struct LinkReport {
  std::string address;    ///< As the user typed it.
  std::string server_id;  ///< "footingd", "footing-sim"; empty before the first Welcome.
  LinkState state = LinkState::kConnecting;
  std::string why;  ///< A line for a person.
};

/// One tick. Fields that the tick did not carry stay empty. Its stamp and the times at which motion
/// was received are on the viewer's own clock.
struct Update : rig::Tick {
  int source = 0;                ///< Which connection.
  bool live = true;              ///< Neither a snapshot nor a refill: its age is a latency.
  std::int64_t received_ns = 0;  ///< When the viewer's socket gave it, on the viewer's own clock.
  std::optional<std::vector<stream::Skeleton>> skeletons;
  std::optional<stream::Track> track;
  std::optional<ReferencePose> reference;  ///< The newest one of the tick.
  std::optional<WorldFrame> frame;
  std::optional<stream::GameState> game;
  std::optional<stream::StudyState> study;
  std::vector<Note> notes;
};

}  // namespace footing::scene

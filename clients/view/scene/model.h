#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/view/scene/anatomy.h"
#include "clients/view/scene/calibration.h"
#include "clients/view/scene/camera_preview.h"
#include "clients/view/scene/fall_replay.h"
#include "clients/view/scene/hand_signs.h"
#include "clients/view/scene/playout.h"
#include "clients/view/scene/pose_tally.h"
#include "clients/view/scene/strip.h"
#include "clients/view/scene/tally.h"
#include "clients/view/scene/update.h"

namespace footing::scene {

/// One board's last 10 s.
struct BoardTrace {
  struct Point {
    std::int64_t time_ns = 0;
    float x_m = 0;  ///< Plate frame P: to the right.
    float y_m = 0;  ///< To the front.
    bool joined = true;
  };
  stream::BoardSample newest;
  std::int64_t newest_ns = 0;  ///< When it came, on the viewer's clock.
  std::deque<Point> points;
};

/// A stretch of time in one state of a gait controller.
struct PhaseSpan {
  std::string phase;
  stream::Gait gait = stream::Gait::kUnspecified;
  std::int64_t start_ns = 0;  ///< On the viewer's clock; it ends where the next one starts.
};

/// A device as its server last described it.
struct Device {
  int source = 0;
  stream::DeviceStatus status;
};

/// The newest events.
struct LastNotes {
  std::optional<Note> response;
  std::optional<Note> note;    ///< That a person should read.
  std::map<int, Note> server;  ///< What each source's server said slows it.
};

/// The user study, where one runs.
struct ShownStudy {
  stream::StudyState state;
  std::int64_t received_ns = 0;  ///< On the viewer's clock.
};

/// Of the person's body, from the trackers and from the simulator, and how a tracker's camera
/// fares.
struct Observed {
  std::deque<ReferencePose> references;  ///< The last half second, oldest first.
  std::vector<SeenHand> hands;
  CameraPreview camera;
  std::optional<Calibration> calibration;  ///< Its screen takes the place of the world.
};

/// Everything that the picture and the words are made from.
struct Model {
  std::vector<LinkReport> links;  ///< By source.
  std::vector<Device> devices;
  std::vector<stream::Skeleton> skeletons;
  stream::Track track;
  std::uint64_t track_version = 0;  ///< Counts the tracks received.
  stream::GameState game;           ///< The terrain game, where one is led.
  ShownStudy study;
  Playout playout;
  FallReplay replay;
  StripSet strips;
  std::map<std::pair<int, std::uint32_t>, BoardTrace> boards;  ///< By {source, device}.
  LastNotes last;
  std::map<int, std::int64_t>
      newest_host_ns;               ///< Newest tick's stamp of each source, on the viewer's clock.
  std::vector<std::string> phases;  ///< Of the first character's present gait, in order of coming.
  std::deque<PhaseSpan> phase_spans;  ///< The last 10 s, oldest first.
  Tally tally;
  PoseTally pose_tally;
  Anatomy anatomy;                      ///< Of the first skeleton.
  std::vector<stream::RigSetup> setup;  ///< Of the server that has one.
  Observed observed;
};

/// Whether the connection to the server that described a device is live. Where it is not, the
/// present state of the device is unknown.
bool IsCurrent(const Model& model, const Device& device);

/// Takes one tick in. Plain data in, plain data out: no clock is read.
void Apply(Model& model, const Update& update);

/// True when any character or device is simulated, which every screen must show.
bool IsSimulated(const Model& model);

/// Age of the newest data, ms; of several servers that of the one whose data are oldest.
double AgeMs(const Model& model, std::int64_t now_ns);

/// True once any server has sent something to look at.
bool HasPicture(const Model& model);
/// True while no connection has ever been live and nothing has come.
bool IsWaiting(const Model& model);

/// The reference as it was at `time_ns` of the viewer's clock: the last one before, else the
/// oldest; null when there is none.
const ReferencePose* ReferenceAt(const Model& model, std::int64_t time_ns);

/// Both feet of a person on one or two boards.
struct Stance {
  bool valid = false;  ///< Someone stands on them.
  double total_n = 0;
  double left_share = 0.5;  ///< 0 to 1.
};
Stance StanceOf(const Model& model);

}  // namespace footing::scene

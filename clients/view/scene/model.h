#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/figure.h"
#include "clients/view/scene/part.h"
#include "clients/view/scene/signs.h"
#include "clients/view/scene/tally.h"
#include "clients/view/scene/update.h"
#include "common/guide/camera_step.h"
#include "common/stream/setup.h"

namespace footing::scene {

struct Model;
struct Picture;

/// The guided calibration of where the camera stands, as its screen shows it.
struct Calibration {
  std::string rig;
  std::string file;      ///< The camera file that the pose is written to.
  std::string prompt;    ///< Prompt to the person; empty once there is a result.
  std::string feedback;  ///< State of the camera's view, in words.
  std::optional<guide::MarksState> marks;
  std::optional<stream::SetupItem> result;
};

/// The boards from the person's side with the marks on them: those that are done green, the next
/// one amber and pulsing, with the controller above it where it has to stand; at the end the
/// residual of each mark, and the camera where it stands.
void AddCalibration(const Model& model, std::int64_t now_ns, Picture& picture);

/// The prompt, or how it ended.
std::string CalibrationTitle(const Calibration& calibration);
/// State of the camera's view, or cause and remedy of a refusal.
std::string CalibrationDetail(const Calibration& calibration);
/// "Camera's pose, mark 3 of 10".
std::string CalibrationProgress(const Calibration& calibration);

/// Keeps what led to the last fall, to be seen again in slow motion.
///
/// A fall is a character's count of falls gone up. Its clip begins 5 s before it and ends when the
/// characters are put back (one moved more than 0.5 m between two frames), 1.5 s after it at the
/// latest.
class FallReplay {
 public:
  static constexpr double kBeforeS = 5;
  static constexpr double kAfterS = 1.5;
  static constexpr double kPace = 0.25;  ///< Seconds of the clip a second of the viewer.

  /// Every frame, in the order of coming. A step back in simulation time means a restarted server:
  /// what was kept is dropped.
  void Push(const WorldFrame& frame);

  /// True once a fall has been seen to its end.
  bool ready() const { return !clip_.empty() && !filling_; }
  /// Counts the clips that became ready.
  std::uint64_t clips() const { return clips_; }

  /// Plays from the clip's start, at `now_ns` of the viewer's clock. Does nothing before ready().
  void Start(std::int64_t now_ns);
  void Stop() { started_ns_.reset(); }

  /// Frame to show while a replay runs; nothing before and after it.
  std::optional<WorldFrame> At(std::int64_t now_ns) const;
  /// Time of the clip at `now_ns` less that of the fall, s: negative before it.
  double FromFallS(std::int64_t now_ns) const { return ClipTimeS(now_ns) - fall_s_; }

 private:
  double ClipTimeS(std::int64_t now_ns) const;
  void CutClip(double fall_s);

  std::deque<WorldFrame> recent_;
  std::deque<WorldFrame> clip_;
  double fall_s_ = 0;
  bool filling_ = false;
  std::uint64_t clips_ = 0;
  std::optional<std::int64_t> started_ns_;
};

/// A character whose COM moved further than this between two frames was put back, m.
inline constexpr double kPutBackM = 0.5;

/// The frame between two others: `share` 0 gives a, 1 gives b. Positions on the line, orientations
/// on the arc between; what is not a number (gait, phase, touching) is that of a until b is
/// reached. A character that moved more than 0.5 m between them was put back: it stays at a.
WorldFrame Between(const WorldFrame& a, const WorldFrame& b, double share);

/// Smooths the arrival of frames: shows the stream one frame interval late, so that there is nearly
/// always a frame on either side to draw between.
///
/// Simulation time runs beside the viewer's clock at the pace of the frame that came with the least
/// delay within the last 1.5 s; if frames stop, the newest one stands.
class Playout {
 public:
  /// A frame that the socket gave at `received_ns`. A step back in simulation time means a
  /// restarted server: what was kept is dropped.
  void Push(WorldFrame frame, std::int64_t received_ns);

  bool empty() const { return frames_.empty(); }
  const WorldFrame& Newest() const { return frames_.back().frame; }
  /// When the newest frame came, on the viewer's clock; 0 without one.
  std::int64_t newest_ns() const { return frames_.empty() ? 0 : frames_.back().received_ns; }
  /// Frame to show at `now_ns`. Not to be called while empty.
  WorldFrame At(std::int64_t now_ns) const;

 private:
  struct Timed {
    WorldFrame frame;
    std::int64_t received_ns = 0;
  };
  double ShownTime(std::int64_t now_ns) const;

  std::deque<Timed> frames_;
};

/// Length of the past that the sliding strips show.
inline constexpr std::int64_t kStripNs = 10'000'000'000;
/// Age from which on a value is no longer the present one.
inline constexpr std::int64_t kCurrentNs = 500'000'000;

/// The instant up to which sliding curves are drawn: now, but where nothing has come since
/// `newest_ns` for longer than kCurrentNs they stand still, as the scene does.
std::int64_t ShownTime(std::int64_t newest_ns, std::int64_t now_ns);

/// One curve over the last 10 s.
class Strip {
 public:
  struct Point {
    std::int64_t time_ns = 0;  ///< On the viewer's own clock.
    float value = 0;
    bool joined = true;  ///< A line leads here from the point before.
  };

  /// A value that is not finite is left out. Points come in the order of time.
  void Add(std::int64_t time_ns, double value);
  /// The value is unknown at `time_ns`: the next point starts a new line.
  void Break(std::int64_t time_ns);
  const std::deque<Point>& points() const { return points_; }

 private:
  void DropBefore(std::int64_t time_ns);

  std::deque<Point> points_;
  bool broken_ = true;
};

/// The curves of one controller.
struct DeviceStrips {
  stream::DeviceRole role = stream::DeviceRole::kUnspecified;
  bool simulated = false;
  Strip magnitude_mps2;  ///< Magnitude of the raw specific force.
  Strip filtered_x_mps2, filtered_y_mps2, filtered_z_mps2;
  Strip moving;  ///< 0 or 1.
  Strip frequency_hz;
  Strip amplitude_mps2;
  Strip roll_rad, pitch_rad;
};

/// All curves; at most 16 devices and 8 rigs.
struct StripSet {
  std::map<std::pair<int, std::uint32_t>, DeviceStrips> devices;  ///< By {source, device}.
  std::map<std::string, Strip> phases_rad;                        ///< By rig.
  std::int64_t newest_ns = 0;                                     ///< When the last values came.

  void Add(const Update& update);
};

/// One board's last 10 s.
struct BoardTrace {
  struct Point {
    std::int64_t time_ns = 0;
    float x_m = 0;  ///< Plate frame P: to the right.
    float y_m = 0;  ///< Position towards the front.
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
  std::optional<Note> note;    ///< Newest text that a person should read.
  std::map<int, Note> server;  ///< Last notice of each source's server on what slows it.
};

/// The user study, where one runs.
struct ShownStudy {
  stream::StudyState state;
  std::int64_t received_ns = 0;  ///< On the viewer's clock.
};

/// Observations of the person's body, from the trackers and from the simulator, and the state of a
/// tracker's camera.
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
  std::vector<std::string> phases;  ///< States of the first character's gait, in order.
  std::deque<PhaseSpan> phase_spans;  ///< The last 10 s, oldest first.
  Tally tally;
  PoseTally pose_tally;
  Anatomy anatomy;                      ///< Anatomy of the first skeleton.
  std::vector<stream::RigSetup> setup;  ///< Setups of the server that has one.
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
/// Stance of the person on the boards.
Stance StanceOf(const Model& model);

/// Engine of the connected footing-sim: the biped, a person on boards, or not known yet.
enum class Engine { kUnknown, kBiped, kPerson };
/// Engine of the newest ticks.
Engine EngineOf(const Model& model);

/// Conditions that decide which keys of a live view are active.
struct KeyContext {
  Engine engine = Engine::kUnknown;
  bool has_subjects = false;  ///< Files for the key N were named.
  bool calibrates = false;    ///< A camera file for the key C was named.
  bool may_command = false;   ///< footing-sim is connected, on this machine.
};
/// Conditions of the keys in the present state.
KeyContext ContextOf(const Model& model, bool has_subjects, bool calibrates);

/// The server that gets a marker of the key E: footingd, or else footing-sim, connected on this
/// machine; empty: neither is.
std::string MarkedServer(const Model& model);

/// A line of the list of keys.
struct KeyLine {
  std::string key;
  std::string what;
};

/// The keys of a live view that do something now, in the order of the list, and what the mouse
/// does.
std::vector<KeyLine> LiveKeyLines(const KeyContext& context);
/// Lines of the mouse, which is the same in every view.
std::vector<KeyLine> MouseLines();

/// Why a drag on the character turns the view and does not push; empty where it pushes.
std::string WhyNoPush(const KeyContext& context);

/// Whether the key changes the mode of the pose engine (M), or leaves a part of it out or in.
bool ChangesMode(char key);
/// That part, as SetPoseMode names it; empty for other keys.
std::string PartOfKey(char key);

/// Why a key does nothing now, and what to do; empty where it does what the list says. `key` is a
/// capital letter.
std::string WhyNoKey(char key, const KeyContext& context);

}  // namespace footing::scene

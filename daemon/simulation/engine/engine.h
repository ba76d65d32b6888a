#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/mapping/any_interface.h"

/// The gait engine: received features in, a walking biped out, one fixed step at a time.
namespace footing::engine {

/// Texts of the data files; the constants name them under daemon/simulation/data.
struct GainText {
  std::string origin;  ///< Names the file in errors.
  std::string text;
};
/// Data files of the engine, as text.
struct EngineTexts {
  std::string biped;    ///< kBipedFile
  std::string track;    ///< "tracks/NAME.json"
  std::string mapping;  ///< mapping::MappingFileOf(EngineConfig::interface.interface)
  /// kGainFiles, and more: a later one replaces what an earlier one had for its gaits. None: the
  /// defaults of gains.h.
  std::vector<GainText> gains;
  /// kStyleFiles: gains of the same gaits with their style. May be none.
  std::vector<GainText> style;
  /// kChoicesFile: what foresight (foresight.h) chooses from. An empty text: none.
  GainText choices;
};
inline constexpr const char* kBipedFile = "biped.json";
inline constexpr const char* kPlainTrackFile = "tracks/plain.json";
inline constexpr std::array kGainFiles{"gaits/step.csv", "gaits/walk.csv", "gaits/run.csv",
                                       "gaits/jump.csv"};
inline constexpr std::array kStyleFiles{"gaits/style/step.csv", "gaits/style/walk.csv",
                                        "gaits/style/run.csv"};
inline constexpr const char* kChoicesFile = "gaits/choices.csv";
/// After those, the gaits as the gait paper prints them.
inline constexpr std::array kPaperGainFiles{"gaits/paper/step.csv", "gaits/paper/walk.csv",
                                            "gaits/paper/run.csv", "gaits/paper/jump.csv"};
static_assert(kGainFiles.size() == stream::kGaits.size(), "a table of gains for every gait");

/// Settings of the engine.
struct EngineConfig {
  double step_s = 0.001;            ///< Step of physics and control, (0, 0.002].
  double fall_shown_s = 0.7;        ///< From a fall to the put-back.
  double put_back_distance_m = 3;   ///< Along the track's centre line, backwards.
  double features_timeout_s = 0.5;  ///< Without new features: stepping in place.
  mapping::InterfaceOptions interface = {};
  terrain::Surface surface = {};  ///< The ground of all tracks.
};

inline constexpr int kMaxAppends = 16;

/// Which user interface the person has. Another one takes effect when its number is new.
struct InterfaceInputs {
  std::uint64_t number = 0;  ///< 0: the one of EngineConfig.
  mapping::InterfaceOptions options = {};
  std::optional<mapping::AnyInterface> made = {};  ///< Made of the options; not read with number 0.
};

/// Which trial runs. A trial begins when its number is new, on the track that the engine then has.
struct TrialInputs {
  std::uint64_t number = 0;
  int task = -1;                    ///< Index among the track's tasks; -1: none.
  std::uint64_t stopped_below = 0;  ///< Trials with smaller numbers are stopped.
  std::uint64_t track_number = 0;   ///< Track that it runs on (UseTrack); 0: the first one.
};

/// Inputs of the engine as of one step. Fixed size. Numbers count up: a push, a put-back
/// or features are new when their number differs from the last step's, so the same inputs may be
/// given again and again, and nothing is carried out twice.
struct EngineInputs {
  std::uint64_t features_number = 0;  ///< 0: none received so far.
  mapping::Inputs features;           ///< Features of the controllers and boards.
  InterfaceInputs interface;
  bool direct = false;  ///< Follow direct_command in place of the features.
  biped::GaitCommand direct_command;
  std::uint64_t push_number = 0;
  Eigen::Vector2d push_impulse_W_ns = Eigen::Vector2d::Zero();  ///< On the body's COM, over 0.1 s.
  Eigen::Vector2d tow_W_n = Eigen::Vector2d::Zero();            ///< Held force on the body's COM.
  std::uint64_t put_back_number = 0;
  /// Segments to add to the track's end: the newest append_count ones of append_number in all,
  /// oldest first. One is taken a step; keep each here until EngineOutput::append_number says so.
  std::uint64_t append_number = 0;
  int append_count = 0;
  std::array<terrain::NewSegment, kMaxAppends> appends;
  TrialInputs trial;
};

/// Kinds of events.
enum class EventKind {
  kFall,  ///< A failure of any cause.
  kPutBack,
  kGaitCommanded,  ///< Another gait is commanded than before.
  kGaitChanged,    ///< Another gait's controller runs than before.
  kGaitTakenOver,  ///< The commanded gait's controller runs: the command's wait for contact is
                   ///< over.
  kStreamLost,     ///< No new features for longer than the timeout.
  kStreamBack,
  kAppendRefused,  ///< A segment was not added; why is in the text.
  kTrialReady,     ///< A trial begins; the character stands before the start line.
  kTrialRunning,   ///< The start line was crossed.
  kTrialFinished,  ///< The finish line was crossed.
  kTrialStopped,
  kTaskDone,  ///< The change of gait that the track asks for has succeeded.
};

/// An event of one step. Fixed size.
struct EngineEvent {
  EventKind kind = EventKind::kFall;
  stream::Gait from = stream::Gait::kUnspecified;
  stream::Gait to = stream::Gait::kUnspecified;
  const char* text = "";  ///< Why it fell or was put back; static storage.
  stream::FailureCause cause = stream::FailureCause::kUnspecified;  ///< For a failure.
  std::uint64_t failure_number = 0;                  ///< For a failure: all are counted from 1.
  bool in_trial = false;                             ///< For a failure: the trial was going on.
  bool by_operator = false;                          ///< For a put-back: an input asked for it.
  std::uint64_t trial_number = 0;                    ///< Trial at this step.
  stream::TrialProgress trial = {};                  ///< For a failure or a trial: its progress.
  Eigen::Vector3d p_WC_m = Eigen::Vector3d::Zero();  ///< For a failure: its place.
};

inline constexpr int kLinkCount = 5;  ///< body, left hip, left knee, right hip, right knee.
inline constexpr int kContactCount = 2;
inline constexpr int kMaxEvents = 16;

/// For the stages of a response: the step in which the commanded gait last changed, the features
/// it came from, and the step in which its controller took over (0: not yet).
struct ResponseSteps {
  std::uint64_t commanded = 0;
  std::uint64_t features_number = 0;
  std::uint64_t taken_over = 0;
};

/// How far the inputs' appends are.
struct AppendProgress {
  std::uint64_t number = 0;  ///< So many were taken or refused.
  bool added = false;        ///< In this step: the track's last segment is new.
};

/// State of the character after a step, in W. Fixed size.
struct EngineOutput {
  std::uint64_t step = 0;
  double time_s = 0;  ///< step * step_s.
  std::array<stream::LinkPose, kLinkCount> links;
  std::array<stream::Contact, kContactCount> contacts;
  Eigen::Vector3d p_WC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WC_mps = Eigen::Vector3d::Zero();
  /// Generalised forces of this step: yaw, roll, pitch (N m) and length (N) of the left leg, then
  /// of the right one; and push and tow on the body.
  std::array<double, 8> joint_efforts{};
  Eigen::Vector3d push_W_n = Eigen::Vector3d::Zero();
  stream::GaitState gait;
  stream::InterfaceState interface;  ///< The person's movement as the interface takes it.
  stream::TrialProgress trial;
  std::uint64_t trial_number = 0;  ///< The inputs' that this trial began with.
  std::uint64_t track_number = 0;
  bool simulated_input = false;
  double root_force_max_n = 0;   ///< Largest hidden force on the root so far; must stay 0.
  std::uint64_t state_hash = 0;  ///< FNV-1a of the physics state: the same binary and machine only.
  ResponseSteps response;
  AppendProgress append;
  std::array<EngineEvent, kMaxEvents> events;  ///< Events in this step alone.
  int event_count = 0;
};

struct EngineState;
struct TrackWorld;

/// The engine's world as one MJCF file for MuJoCo alone: the biped, all segments of the track, a
/// motor for each joint, and the state in which the engine starts as key frame 0 ("start").
///
/// From mj_resetDataKeyframe and mj_forward on, mj_step leads to the bits of EngineOutput's
/// state_hash, with the same version of MuJoCo on the same machine: joint_efforts in ctrl and
/// push_W_n in xfrc_applied of the body "body". The comment at the file's head says so. Where the
/// engine moves its ground (terrain::WindowOf) it agrees until a foot stands on two boxes whose
/// order differs. `writer` is named in that comment, such as "Footing 1.0.0".
Result<std::string> ExportMjcf(const EngineTexts& texts, const EngineConfig& config,
                               const std::string& writer);

/// Physics, gait controllers, user interface, trials, and what happens at a failure.
///
/// One thread at a time. After Create nothing allocates, locks or logs.
class GaitEngine {
 public:
  /// Fails with one line that names the file and key when a text does not parse.
  static Result<GaitEngine> Create(const EngineTexts& texts, const EngineConfig& config = {});
  /// The same on a track that was read already; that of the texts is left alone.
  static Result<GaitEngine> CreateOn(stream::Track track, const EngineTexts& texts,
                                     const EngineConfig& config = {});
  GaitEngine(GaitEngine&&) noexcept;
  GaitEngine& operator=(GaitEngine&&) noexcept;
  ~GaitEngine();

  /// One step of config.step_s.
  void Advance(const EngineInputs& inputs);
  /// As of the last step; valid until the next Advance or Restore.
  const EngineOutput& Output();

  /// Skeleton of the character, and the track that it is on now.
  const stream::Skeleton& skeleton() const;
  const stream::Track& track() const;

  /// Goes over to another track (state.h) and gives the former one back in `other`. The
  /// character stands at the start, time and counts go on; a trial begins with the next inputs that
  /// have a new number. Allocates nothing.
  void UseTrack(TrackWorld& other);

  /// Other gains from the next step on, without style and foresight; not part of the state.
  /// Allocates.
  void UseGains(const gait::GainTable& table);

  /// Other tables of the style from the next step on, likewise.
  void UseStyle(const gait::GainTable& table);

  /// Everything that changes with time, as a value (state.h); Restore brings an engine on the same
  /// track back to that step.
  EngineState Save() const;
  void Restore(const EngineState& state);

 private:
  struct Parts;
  explicit GaitEngine(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// The house's definition of a fall; put-backs count besides.
inline constexpr double kLowestBodyM = 0.55;
inline constexpr double kLargestTiltRad = 1.0471975511965976;  ///< 60 degrees.

/// A foot lower than this under the ribbon, in a pit, has missed the ground.
inline constexpr double kFootInPitM = 0.3;

/// A fall within this time of a foot that was in a pit, or stood on its edge, is the jump's.
inline constexpr double kStumbleS = 1;

/// A failure and why, as text of static storage; null when there is none.
struct Failure {
  stream::FailureCause cause = stream::FailureCause::kSimulation;
  const char* why = nullptr;
};

/// Failure in a state: simulation, curve or jump. A touch or a drop beside the ribbon
/// is the curve's failure, with a foot in a pit the jump's, whatever else is wrong besides. `place`
/// is the body's on the track.
Failure FindFailure(const stream::Track& track, const terrain::TrackPlace& place,
                    const biped::BodyState& body, const physics::Observation& seen);

/// Whether a foot touches the edge of a pit, or is lower than the track over one: a jump that was
/// too short or badly timed. `place` is the body's on the track.
bool MissesPit(const stream::Track& track, const terrain::TrackPlace& place,
               const biped::BodyState& body);

}  // namespace footing::engine

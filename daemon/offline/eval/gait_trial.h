#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double Uniform(double min, double max) {
    constexpr double kSteps = 9007199254740992.0;  // 2^53
    return min + (max - min) * static_cast<double>(engine_() >> 11) / kSteps;
  }

 private:
  std::mt19937_64 engine_;
};

/// A number for the seed of one trial.
std::uint64_t TrialSeed(std::uint64_t seed, int trial);

/// "random" or a number; a random one is drawn from the system and printed to standard error.
Result<std::uint64_t> ParseSeed(const std::string& text);

/// Controllers of every engine made after this: best or paper. The command line's, as below.
void UseGaits(const std::string& gaits);
/// Gait tables (gain_table.h) that every engine made after this reads after the product's own. The
/// command line's, said once for the whole process.
void ReadGainsToo(std::vector<std::string> paths);

/// An engine on the straight track, from the product's data files.
Result<engine::GaitEngine> NewEngine(const terrain::Surface& surface = {});
/// The same on a track given as text.
Result<engine::GaitEngine> NewEngineOn(const std::string& track, const terrain::Surface& surface);
/// An engine on a track given as text, for a user interface with the mapping table of this path;
/// empty: the built-in one.
Result<engine::GaitEngine> NewEngineOn(const std::string& track,
                                       const mapping::InterfaceOptions& interface = {},
                                       const std::string& mapping_table = "");
/// The world of NewEngine's engine alone, or of one on a track; its feet are not listed as pairs.
Result<physics::World> NewWorld(const std::optional<std::string>& track = std::nullopt,
                                const terrain::Surface& surface = {});

/// An engine driven by direct commands, with what one wants to know of it.
class Walker {
 public:
  explicit Walker(engine::GaitEngine& engine) : engine_(engine) {}

  void Command(const biped::GaitCommand& command);
  /// Pushes the body over the 0.1 s that follow; in an engine restored to an earlier step a push
  /// needs a number that its state has not seen.
  void Push(double impulse_ns, double direction_rad);
  void Push(double impulse_ns, double direction_rad, std::uint64_t number);
  /// A force on the body that goes on; none to begin with.
  void Tow(double force_n, double direction_rad);
  /// One step; reads the output every step.
  const engine::EngineOutput& Advance();
  bool fell() const { return output_ != nullptr && output_->gait.falls > 0; }
  /// Least gap between the legs so far, m (leg_gap.h); without falls and what follows them.
  double leg_gap_min_m() const { return leg_gap_min_m_; }
  const engine::EngineInputs& inputs() const { return inputs_; }

 private:
  engine::GaitEngine& engine_;
  engine::EngineInputs inputs_;
  const engine::EngineOutput* output_ = nullptr;
  double leg_gap_min_m_ = INFINITY;
};

/// Pits to jump over: a track with pits at random places, and the pilot who commands.
struct Pit {
  double near_m;  ///< Edges, along the track.
  double far_m;
};

/// A track with pits, and where they are.
struct PitCourse {
  std::string track;  ///< Text for GaitEngine::Create.
  std::vector<Pit> pits;
  stream::Track curves;  ///< The same track, where it is not straight; else without segments.
};

/// Pits of one width after run-ups of 16 to 20 m, which is what a run of 3 m/s needs to be one
/// again after a jump, for as long as `length_m`; then level ground. Which step comes before an
/// edge is thus random.
PitCourse MakePitCourse(double width_m, double length_m, Random& random);
/// The same along curves of this radius after the first run-up, a quarter of a circle to the one
/// side and a quarter to the other, in segments of 5 degrees. A pit may be anywhere in them.
PitCourse MakeCurvedPitCourse(double width_m, double length_m, double radius_m, Random& random);

/// Commands a gait along a course. A run is commanded to jump when the edge is `lead_s` away, and
/// to run again once it has landed behind the pit; other gaits get one command all along. All are
/// steered towards the middle.
class PitPilot {
 public:
  PitPilot(const PitCourse& course, const biped::GaitCommand& command, double height_m,
           double lead_s)
      : course_(course), command_(command), height_m_(height_m), lead_s_(lead_s) {}

  /// The command after this output; counts the pits on the way.
  biped::GaitCommand Command(const engine::EngineOutput& output);

  /// Pits passed: the COM beyond the far edge and the character still up 2 s later.
  int crossed() const { return crossed_; }
  /// Pits passed or failed at. One that was still open when the trial ended is neither.
  int met(bool fell) const { return crossed_ + (fell && over_ ? 1 : 0); }

 private:
  /// Turn of the next step towards the middle of the track.
  double Steer(const engine::EngineOutput& output, const terrain::TrackPlace& place) const;

  const PitCourse& course_;
  biped::GaitCommand command_;
  double height_m_;
  double lead_s_;
  std::size_t next_ = 0;
  bool over_ = false;  ///< Reached the pit, not yet passed it.
  bool jumping_ = false;
  double passed_s_ = -1;
  int crossed_ = 0;
};

/// The rise of a jump that carries `speed_mps` over the pit with 15 cm to spare at either edge.
double SensibleHeight(double width_m, double speed_mps);

/// Pushes of one size in evenly spaced directions, at evenly spaced moments of one cycle (two
/// steps, or one hop of a jump).
struct PushSweep {
  biped::GaitCommand command;
  int directions = 8;
  int phases = 12;
  double impulse_ns = 16;  ///< Over 0.1 s.
  terrain::Surface surface = {};
};

/// Falls by direction and size of a push.
struct PushSweepResult {
  std::vector<int> falls;  ///< By direction; direction 0 pushes from behind, then to the left.
  int pushes = 0;
  double leg_gap_min_m = INFINITY;  ///< Between the legs (leg_gap.h), after pushes that size.
  /// Found by bisection to 1 N s, up to 64: as if who survives a push survived all smaller ones.
  double largest_survived_ns = 0;

  int all_falls() const;
};

/// Settles at the command (the seed draws a kick of 2 N s on the way and the first moment), keeps
/// the engine's state at each moment, and goes on from there with each push for 5 s. Adds to
/// `result.falls` and `pushes`; `largest_survived_ns` becomes the smallest over calls.
Result<void> RunPushSweep(const PushSweep& sweep, std::uint64_t seed, PushSweepResult& result);

/// Writes plots like the paper's Figures 5 to 8 into a folder, which is made where it is missing,
/// each over the part of the motion that has most of what it shows: vertical COM where the COM
/// rises and falls most, horizontal COM where it leans furthest, the shoulder's and the elbow's
/// angles where an arm swings most, and stick figures of the deepest crouch (pose_run.h),
/// whose title says where there is none. Files of before are overwritten. Returns the names.
Result<std::vector<std::string>> WriteFigures(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options,
                                              const std::string& folder);

}  // namespace footing::eval

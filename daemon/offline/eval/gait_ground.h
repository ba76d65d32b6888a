#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/engine/state.h"

/// Slopes and steps to walk over: a straight track, and the pilot who leads the character along it.
namespace footing::eval {

/// A track of slopes or steps, and where they are.
struct GroundCourse {
  std::string track;            ///< Text for GaitEngine::Create.
  std::vector<double> edges_m;  ///< Where the ground changes, along x: steps, or the slope's foot.
};

/// Steps of `step_m` at random spacing of 2.5 to 4 m, up and down at even odds after the first,
/// which goes up where `step_m` is positive; as many as `length_m` holds, then level ground.
GroundCourse MakeStepCourse(double step_m, double length_m, Random& random);

/// A level run-up of random length on which `speed_mps` is reached, then one slope of `length_m`.
GroundCourse MakeSlopeCourse(double slope_deg, double speed_mps, double length_m, Random& random);

/// Ground of a trial, at most one of slope, step and pit; 0: absent.
struct GroundKind {
  double slope_deg = 0;
  double step_m = 0;
  double pit_m = 0;  ///< Width.
  terrain::Surface surface = {};
};

/// Ground of that kind in three segments at most, so that the world keeps all of it in its place:
/// level, and from `level_m` on the slope, a step up and 3 m later one down, or a pit. Level ground
/// is without a name of its own: the plane.
std::optional<std::string> MakeShortTrack(const GroundKind& kind, double level_m);

/// Commands a gait along a course, and says when it is time for the kick. A gait that stays in
/// place is led on to the course by walking first.
class GroundPilot {
 public:
  /// The kick comes at a random place of the first 3 m of the course.
  GroundPilot(const GroundCourse& course, const biped::GaitCommand& command, Random& random);

  /// The command after this output; counts the steps on the way.
  biped::GaitCommand Command(const engine::EngineOutput& output);
  /// True from the moment of the kick on.
  bool kick_due() const { return kick_due_; }
  /// True once the character has been on the course until its speed has settled.
  bool settled() const { return settled_; }

  /// Steps passed: the COM beyond the edge and the character still up 1 s later.
  int crossed() const { return crossed_; }
  /// Steps passed or failed at. One whose second was not over when the trial ended is neither.
  int met(bool fell) const { return crossed_ + (fell ? static_cast<int>(reached_s_.size()) : 0); }

 private:
  const GroundCourse& course_;
  biped::GaitCommand command_;
  double kick_m_;
  double kick_delay_s_;
  std::optional<double> arrived_s_;
  std::vector<double> reached_s_;  ///< When the COM first was near each edge met so far.
  int crossed_ = 0;
  bool kick_due_ = false;
  bool settled_ = false;
};

/// CPU time of a step of the engine, and of a bare mj_step under the same forces, over two seconds
/// of a gait that runs.
class StepCost {
 public:
  /// With a push from the side in its first step, `push_ns` above 0.
  static Result<StepCost> Create(const biped::GaitCommand& command, const GroundKind& kind = {},
                                 double push_ns = 0);

  double EngineUs();
  double BareUs();
  bool fell() const { return fell_; }
  /// After BareUs: its state is the engine's.
  bool agrees() const { return world_.StateHash() == hash_; }

 private:
  struct Forces {
    physics::JointEfforts joints;
    Eigen::Vector3d push_W_n;
  };
  StepCost(engine::GaitEngine engine, physics::World world)
      : engine_(std::move(engine)), world_(std::move(world)) {}

  engine::GaitEngine engine_;
  physics::World world_;
  engine::EngineInputs inputs_;
  engine::EngineState start_ = engine_.Save();
  std::vector<Forces> forces_;
  bool fell_ = false;
  std::uint64_t hash_ = 0;
};

/// CPU time of the engine's step over that of bare mj_step, which replays the recorded generalised
/// forces from the same state and must end in the same state hash. The engine's output is read
/// every tenth step, as when published. Median over seven pairs taken A B B A. On a slope of the
/// kind the character climbs all the time, it meets the step up in the middle, and the pit lies
/// just ahead. The bare world looks at every pair of geoms. 0 where the character falls on the way.
Result<double> MeasureStepCostRatio(const biped::GaitCommand& command, const GroundKind& kind);

}  // namespace footing::eval

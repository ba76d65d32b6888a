#pragma once

#include <string>
#include <vector>

#include "daemon/offline/eval/gait_trial.h"

/// Pits to jump over: a straight track with pits at random places, and the pilot who commands.
namespace footing::eval {

struct Pit {
  double near_m;  ///< Edges, along x.
  double far_m;
};

struct PitCourse {
  std::string track;  ///< Text for GaitEngine::Create.
  std::vector<Pit> pits;
};

/// Pits of one width after run-ups of 16 to 20 m, which is what a run of 3 m/s needs to be one
/// again after a jump, for as long as `length_m`; then level ground. Which step comes before an
/// edge is thus random.
PitCourse MakePitCourse(double width_m, double length_m, Random& random);

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

}  // namespace footing::eval

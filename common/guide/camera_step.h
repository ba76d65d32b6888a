#pragma once

#include <string>
#include <vector>

#include "common/camera/camera_pose.h"
#include "common/camera/marks.h"
#include "common/guide/step.h"

namespace footing::guide {

/// Calibrates where a camera stands: the person holds a sphere on each mark of the boards and, with
/// a PS Move, stands it upright on one mark of each board, for gravity. Without a camera file in
/// the options it finishes at once, without a result.
class CameraStep {
 public:
  Progress Advance(const Situation& now, const SetUpOptions& options);

 private:
  /// A stretch of a sphere at rest, or why there is none yet.
  struct Rest {
    std::optional<camera_pose::SeenPoint> seen;
    double tilt_rad = 0;  ///< Of the controller's long axis against gravity.
    std::string feedback;
    double share = 0;  ///< Of the stretch.
  };

  void Begin(const Situation& now, const SetUpOptions& options);
  Rest Look(const Situation& now, const SetUpOptions& options, bool upright) const;
  /// Why the sphere at rest cannot be at the place that is asked for; empty when it can.
  std::string Doubt(const Rest& rest) const;
  void Take(const Rest& rest);
  Progress Ask() const;
  Progress Ask(const Rest& rest) const;
  MarksState Marks(double rest_share) const;
  Progress Solve();
  Progress Stored(const Situation& now);

  bool begun_ = false, stored_ = false;
  std::vector<camera_pose::BoardMark> marks_;
  std::vector<std::size_t> places_;  ///< Indices of marks_, in the order asked for.
  std::vector<bool> upright_;        ///< Of each place.
  std::size_t next_ = 0;             ///< Of places_.
  std::int64_t asked_ns_ = 0;        ///< When the present place was asked for.
  std::string picture_;
  camera_pose::Observations observations_;
  camera_pose::CameraPose pose_;
};

}  // namespace footing::guide

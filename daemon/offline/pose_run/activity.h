#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"

/// What the person does, frame by frame: scores of a clip that mostly stands say little of squats.
namespace footing::pose_run {

/// [begin_s, end_s) on the motion's clock.
struct ActivitySpan {
  double begin_s = 0, end_s = 0;
  std::string activity;
};

/// A table with the head "begin_s,end_s,activity". Spans do not overlap, names have up to 60 bytes.
/// Errors say the line and what was expected.
Result<std::vector<ActivitySpan>> ParseActivities(std::string_view text, const std::string& file);

/// The label of each frame by such a table; frames outside of it have none.
Activities LabelledActivities(const PoseRun& run, const std::vector<ActivitySpan>& spans);

/// By plain rules on the truth, the first that fits:
/// airborne: no foot carries more than 20 N;
/// one_foot: one does;
/// bent: the line from the hips' middle to the neck is more than 35 degrees from the vertical;
/// crouched: the COM is under 90 % of its height in the T-pose;
/// arms: a wrist moves faster than 0.5 m/s against the chest (the neck where there is none);
/// moving: the COM moves faster than 0.1 m/s;
/// still: what is left, upright on both feet.
/// Speeds are differences over 0.1 s around the frame. The first frame stands in the T-pose.
Activities RuledActivities(const PoseRun& run);

}  // namespace footing::pose_run

#include "daemon/offline/pose_run/activity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/kinematics.h"
#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::pose_run {
namespace {

using body::Landmark;

constexpr double kBentRad = 35 * kPi / 180;
constexpr double kCrouchedShare = 0.9;  // Of the T-pose's height of the COM.
constexpr double kArmMps = 0.5;
constexpr double kWalkingMps = 0.1;
constexpr double kSpanS = 0.1;
constexpr std::size_t kMostName = 60;
constexpr std::string_view kHead = "begin_s,end_s,activity";

enum Rule { kAirborne, kOneFoot, kBent, kCrouched, kArms, kMoving, kStill };
const std::vector<std::string> kRules{"airborne", "one_foot", "bent", "crouched",
                                      "arms",     "moving",   "still"};

/// What the rules look at.
struct Shape {
  Eigen::Vector3d trunk, com_m;
  std::array<Eigen::Vector3d, 2> wrists;  ///< From the chest.
};

Shape ShapeOf(const body::Body& body, const Frame& frame, body::Kinematics& at) {
  body::ComputeKinematics(body.skeleton, frame.q, at);
  const auto place = [&](Landmark landmark) {
    return at.p_WJ[static_cast<std::size_t>(body.landmarks[landmark])];
  };
  const Eigen::Vector3d neck = place(Landmark::kNeck);
  const Eigen::Vector3d chest =
      body.landmarks[Landmark::kChest] >= 0 ? place(Landmark::kChest) : neck;
  const Eigen::Vector3d hips = 0.5 * (place(Landmark::kLeftHip) + place(Landmark::kRightHip));
  return {neck - hips,
          frame.com_m,
          {place(Landmark::kLeftWrist) - chest, place(Landmark::kRightWrist) - chest}};
}

Rule RuleOf(const PoseRun& run, const std::vector<Shape>& shapes, std::size_t i, std::size_t half) {
  const auto& feet = run.frames[i].feet;
  const int carrying = (feet[0].load_n > kLoadedN ? 1 : 0) + (feet[1].load_n > kLoadedN ? 1 : 0);
  if (carrying == 0) return kAirborne;
  if (carrying == 1) return kOneFoot;
  const Shape& now = shapes[i];
  if (std::atan2(now.trunk.head<2>().norm(), now.trunk.z()) > kBentRad) return kBent;
  if (now.com_m.z() < kCrouchedShare * shapes.front().com_m.z()) return kCrouched;
  const std::size_t low = i >= half ? i - half : 0, high = std::min(i + half, shapes.size() - 1);
  const double span_s = static_cast<double>(high - low) / run.rate_hz;
  const auto speed = [&](const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
    return span_s > 0 ? (after - before).norm() / span_s : 0;
  };
  for (std::size_t side = 0; side < 2; ++side) {
    if (speed(shapes[low].wrists[side], shapes[high].wrists[side]) > kArmMps) return kArms;
  }
  return speed(shapes[low].com_m, shapes[high].com_m) > kWalkingMps ? kMoving : kStill;
}

Result<ActivitySpan> ParseSpan(text::Lines& lines, std::string_view line) {
  const auto fields = text::Fields(line, ',');
  if (fields.size() != 3) return lines.Fault("expected three fields: " + std::string(kHead));
  const auto begin = text::ToNumber(fields[0]), end = text::ToNumber(fields[1]);
  if (!begin || !end || !(*begin < *end)) {
    return lines.Fault("expected two times in s, the first one earlier, found " +
                       text::Quoted(fields[0]) + " and " + text::Quoted(fields[1]));
  }
  if (fields[2].empty() || fields[2].size() > kMostName) {
    return lines.Fault("expected the name of an activity, of 1 to 60 bytes");
  }
  return ActivitySpan{*begin, *end, std::string(fields[2])};
}

}  // namespace

Result<std::vector<ActivitySpan>> ParseActivities(std::string_view text, const std::string& file) {
  text::Lines lines(text, file);
  if (text::Trim(lines.NextFull().value_or("")) != kHead) {
    return lines.Fault("expected the line '" + std::string(kHead) + "'");
  }
  std::vector<ActivitySpan> spans;
  for (auto line = lines.NextFull(); line; line = lines.NextFull()) {
    auto span = ParseSpan(lines, *line);
    if (!span) return span.error();
    const auto overlaps = [&span](const ActivitySpan& other) {
      return span->begin_s < other.end_s && other.begin_s < span->end_s;
    };
    if (std::any_of(spans.begin(), spans.end(), overlaps)) {
      return lines.Fault("its times overlap those of a line before");
    }
    spans.push_back(*std::move(span));
  }
  if (spans.empty()) return lines.Fault("no activity in the file");
  return spans;
}

Activities LabelledActivities(const PoseRun& run, const std::vector<ActivitySpan>& spans) {
  Activities activities;
  for (const ActivitySpan& span : spans) {
    auto& names = activities.names;
    if (std::find(names.begin(), names.end(), span.activity) == names.end()) {
      names.push_back(span.activity);
    }
  }
  for (const Frame& frame : run.frames) {
    const double time_s = frame.inputs.loads.time_s + run.clock_offset_s;
    const auto span = std::find_if(spans.begin(), spans.end(), [time_s](const ActivitySpan& one) {
      return time_s >= one.begin_s && time_s < one.end_s;
    });
    const auto name = span == spans.end() ? activities.names.end()
                                          : std::find(activities.names.begin(),
                                                      activities.names.end(), span->activity);
    activities.of_frame.push_back(
        name == activities.names.end() ? -1 : static_cast<int>(name - activities.names.begin()));
  }
  return activities;
}

Activities RuledActivities(const PoseRun& run) {
  body::Kinematics at(run.body.skeleton);
  std::vector<Shape> shapes;
  for (const Frame& frame : run.frames) {
    shapes.push_back(ShapeOf(run.body, frame, at));
  }
  const auto half = static_cast<std::size_t>(std::max(1L, std::lround(0.5 * kSpanS * run.rate_hz)));
  Activities activities{kRules, {}};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    activities.of_frame.push_back(RuleOf(run, shapes, i, half));
  }
  return activities;
}

}  // namespace footing::pose_run

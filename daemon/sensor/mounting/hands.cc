#include "daemon/sensor/mounting/hands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/stream/hands.h"

namespace footing::hands {
namespace {

using stream::DeviceRole;

constexpr std::size_t kMostNameBytes = 64;

bool IsPlain(const std::string& text) {
  return text.size() <= kMostNameBytes &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

bool IsNear(const Eigen::Vector3d& p_W) {
  return p_W.allFinite() && p_W.norm() <= stream::kFarthestPointM;
}

std::string ProblemOfHead(const std::string& name, std::int64_t age_ns) {
  if (!IsPlain(name)) return "a name is not printable text of at most 64 characters";
  if (age_ns < 0 || age_ns > stream::kOldestPointNs) {
    return "age_ns is " + std::to_string(age_ns) + ", must be from 0 to 1000000000";
  }
  return "";
}

/// The matrix of deviations and covariances has no negative direction, rounding apart.
bool IsCovariance(const Eigen::Vector3d& sd_m, const Eigen::Vector3d& covariance_m2) {
  if (!covariance_m2.allFinite()) return false;
  const double xy = covariance_m2.x() / (sd_m.x() * sd_m.y());
  const double xz = covariance_m2.y() / (sd_m.x() * sd_m.z());
  const double yz = covariance_m2.z() / (sd_m.y() * sd_m.z());
  constexpr double kMost = 1 + 1e-9;
  const double determinant = 1 + 2 * xy * xz * yz - xy * xy - xz * xz - yz * yz;
  return std::abs(xy) <= kMost && std::abs(xz) <= kMost && std::abs(yz) <= kMost &&
         determinant >= -1e-9;
}

std::string ProblemOf(const stream::TrackedPoint& point) {
  const bool has_role = point.role != DeviceRole::kUnspecified;
  const bool has_joint = point.joint != stream::BodyJoint::kUnspecified;
  if (!has_role && !has_joint) return "no role and no joint that is known";
  if (has_role && has_joint) return "a role and a joint, must have one of them";
  if (has_role && point.role != DeviceRole::kLeftHand && point.role != DeviceRole::kRightHand) {
    return std::string("the role ") + stream::Name(point.role) +
           ", must be left_hand or right_hand; other points have a joint";
  }
  if (!IsNear(point.position_m)) return "a position that is not finite or not within 10 m";
  if (!(point.confidence >= 0 && point.confidence <= 1)) {
    return "a confidence that is not from 0 to 1";
  }
  if (point.confidence == 0) {
    const bool finite = point.sd_m.allFinite() && point.covariance_m2.allFinite();
    return finite ? "" : "a number that is not finite";
  }
  const auto is_sd = [](double sd_m) { return sd_m > 0 && sd_m <= stream::kLargestPointSdM; };
  if (!is_sd(point.sd_m.x()) || !is_sd(point.sd_m.y()) || !is_sd(point.sd_m.z())) {
    return "a standard deviation that is not above 0 and at most 1 m";
  }
  if (!IsCovariance(point.sd_m, point.covariance_m2)) {
    return "covariances that do not fit its standard deviations";
  }
  return "";
}

std::string ProblemOf(const stream::TrackerPose& pose) {
  if (!IsNear(pose.position_m)) return "a tracker that is not within 10 m";
  constexpr double kMostOff = 0.01;
  if (!(std::abs(pose.rotation.norm() - 1) <= kMostOff)) return "a tracker_pose that does not turn";
  return "";
}

}  // namespace

std::string Problem(const stream::HandFrame& frame) {
  if (!IsPlain(frame.tracker)) return "a name is not printable text of at most 64 characters";
  if (auto problem = ProblemOfHead(frame.rig, frame.age_ns); !problem.empty()) return problem;
  if (frame.points.empty() || frame.points.size() > stream::kMostTrackedPoints) {
    return "it has " + std::to_string(frame.points.size()) + " points, must have 1 to 16";
  }
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const std::string problem = ProblemOf(frame.points[i]);
    if (!problem.empty()) return "point " + std::to_string(i + 1) + " has " + problem;
    const auto same = std::find_if(
        frame.points.begin(), frame.points.begin() + static_cast<std::ptrdiff_t>(i),
        [&](const stream::TrackedPoint& other) {
          return other.role == frame.points[i].role && other.joint == frame.points[i].joint;
        });
    if (same != frame.points.begin() + static_cast<std::ptrdiff_t>(i)) {
      return "points " + std::to_string(same - frame.points.begin() + 1) + " and " +
             std::to_string(i + 1) + " are of the same hand or joint";
    }
  }
  const std::string problem = frame.tracker_pose ? ProblemOf(*frame.tracker_pose) : "";
  return problem.empty() ? "" : "it has " + problem;
}

std::string Problem(const stream::ReferenceFrame& frame) {
  if (auto problem = ProblemOfHead(frame.rig, frame.age_ns); !problem.empty()) return problem;
  const std::size_t joints = frame.parents.size();
  if (joints < 1 || joints > kMostJoints || frame.positions_m.size() != joints) {
    return "it has " + std::to_string(joints) + " parents and " +
           std::to_string(frame.positions_m.size()) + " positions, must have 1 to 64, as many each";
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const std::string joint = "joint " + std::to_string(i);
    if (frame.parents[i] < -1 || frame.parents[i] >= static_cast<int>(i)) {
      return joint + " has parent " + std::to_string(frame.parents[i]) +
             ", must be -1 or a joint before it";
    }
    if (!IsNear(frame.positions_m[i])) return joint + " has a position that is not within 10 m";
  }
  if (!IsNear(frame.com_m)) return "the centre of mass has a position that is not within 10 m";
  return "";
}

std::string Problem(const stream::ContactFrame& frame) {
  if (!IsPlain(frame.source)) return "a name is not printable text of at most 64 characters";
  if (auto problem = ProblemOfHead(frame.rig, frame.age_ns); !problem.empty()) return problem;
  if (frame.body == stream::ContactBody::kUnspecified)
    return "its body must be a left or right foot";
  if (frame.cells.empty() || frame.cells.size() > kMostCells) {
    return "it has " + std::to_string(frame.cells.size()) + " cells, must have 1 to 16";
  }
  for (std::size_t i = 0; i < frame.cells.size(); ++i) {
    const stream::ContactCell& cell = frame.cells[i];
    const std::string which = "cell " + std::to_string(i + 1) + " has ";
    if (!cell.position_m.allFinite() || cell.position_m.norm() > kFarthestCellM) {
      return which + "a position that is not within 1 m";
    }
    if (!(std::abs(cell.load_n) <= kMostLoadN)) return which + "a load that is not within 10000 N";
  }
  return "";
}

std::vector<stream::HandSample> ToSamples(const stream::HandFrame& frame, std::int64_t received_ns,
                                          const std::string& default_rig) {
  std::vector<stream::HandSample> samples;
  for (const stream::TrackedPoint& point : frame.points) {
    stream::HandSample sample;
    sample.rig = frame.rig.empty() ? default_rig : frame.rig;
    sample.role = point.role;
    sample.joint = point.joint;
    sample.received_ns = received_ns;
    sample.sampled_ns = received_ns - frame.age_ns;
    sample.position_m = point.position_m;
    sample.sd_m = point.sd_m;
    sample.confidence = point.confidence;
    sample.simulated = frame.simulated;
    sample.tracker = frame.tracker;
    sample.covariance_m2 = point.covariance_m2;
    sample.saturated = point.saturated;
    sample.occluded = point.occluded;
    sample.tracker_pose = frame.tracker_pose;
    samples.push_back(std::move(sample));
  }
  return samples;
}

stream::ContactSample ToSample(const stream::ContactFrame& frame, std::int64_t received_ns,
                               const std::string& default_rig) {
  stream::ContactSample sample;
  sample.rig = frame.rig.empty() ? default_rig : frame.rig;
  sample.source = frame.source;
  sample.body = frame.body;
  sample.received_ns = received_ns;
  sample.sampled_ns = received_ns - frame.age_ns;
  sample.cells = frame.cells;
  sample.simulated = frame.simulated;
  return sample;
}

stream::ReferencePose ToPose(const stream::ReferenceFrame& frame, std::int64_t received_ns,
                             const std::string& default_rig) {
  stream::ReferencePose pose;
  pose.rig = frame.rig.empty() ? default_rig : frame.rig;
  pose.sampled_ns = received_ns - frame.age_ns;
  pose.parents = frame.parents;
  pose.positions_m = frame.positions_m;
  pose.com_m = frame.com_m;
  return pose;
}

namespace {

constexpr double kPeriodGain = 0.1;
/// A longer interval is a pause of the source, and no period.
constexpr std::int64_t kLongestPeriodNs = 500'000'000;

/// A time that cannot be right is of another host's clock.
bool IsSentKnown(const FrameTimes& times) {
  return times.sent_ns > 0 && times.sent_ns <= times.received_ns &&
         times.received_ns - times.sent_ns <= stream::kOldestPointNs;
}

}  // namespace

ExposureClock::Exposure ExposureClock::Take(const FrameTimes& times) {
  const bool exact = IsSentKnown(times);
  const bool together = started_ && times.received_ns == received_ns_;
  Exposure exposure;
  exposure.sampled_ns = (exact ? times.sent_ns : times.received_ns) - times.age_ns;
  if (started_ && !together) {
    const std::int64_t interval_ns = exposure.sampled_ns - sampled_ns_;
    if (interval_ns > 0 && interval_ns < kLongestPeriodNs) {
      const auto one_ns = static_cast<double>(interval_ns);
      period_ns_ += (period_ns_ > 0 ? kPeriodGain : 1) * (one_ns - period_ns_);
    }
    published_ns_ = sampled_ns_;
    waiting_ = 0;
  }
  if (together && !exact && waiting_ > 0) {
    // They stay later than what was published before, in their order.
    exposure.others_earlier_ns =
        std::clamp<std::int64_t>(std::llround(period_ns_), 0, (oldest_ns_ - published_ns_) / 2);
    oldest_ns_ -= exposure.others_earlier_ns;
    sampled_ns_ -= exposure.others_earlier_ns;
  }
  if (started_) exposure.sampled_ns = std::max(exposure.sampled_ns, sampled_ns_ + 1);
  if (!started_) published_ns_ = exposure.sampled_ns - kLongestPeriodNs;
  if (waiting_++ == 0) oldest_ns_ = exposure.sampled_ns;
  started_ = true;
  received_ns_ = times.received_ns;
  sampled_ns_ = exposure.sampled_ns;
  return exposure;
}

void ExposureClock::Publish() {
  published_ns_ = sampled_ns_;
  waiting_ = 0;
}

std::optional<std::string> Refusals::Say(std::int64_t now_ns, const std::string& what, Kind& kind) {
  if (kind.unsaid == 0 || (kind.said_ns && now_ns - *kind.said_ns < kQuietNs)) return std::nullopt;
  const bool first = !kind.said_ns;
  const std::uint64_t refused = std::exchange(kind.unsaid, 0);
  kind.said_ns = now_ns;
  std::string line = "device socket: " + what + " is refused: " + kind.why;
  if (!first) line += " (" + std::to_string(refused) + " refused since the last such line)";
  return line;
}

std::optional<std::string> Refusals::Add(std::int64_t now_ns, const std::string& what,
                                         const std::string& why) {
  ++total_;
  Kind& kind = kinds_[what];
  ++kind.unsaid;
  kind.why = why;
  return Say(now_ns, what, kind);
}

std::vector<std::string> Refusals::Due(std::int64_t now_ns) {
  std::vector<std::string> lines;
  for (auto& [what, kind] : kinds_) {
    if (auto line = Say(now_ns, what, kind)) lines.push_back(std::move(*line));
  }
  return lines;
}

}  // namespace footing::hands

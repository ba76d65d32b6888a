#include "clients/skeleton/tracking/tracker.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::skeleton {
namespace {

stream::BodyJoint BodyJointOf(Joint joint) {
  using stream::BodyJoint;
  constexpr BodyJoint kOf[kJoints] = {
      BodyJoint::kHead,          BodyJoint::kNeck,        BodyJoint::kLeftShoulder,
      BodyJoint::kRightShoulder, BodyJoint::kLeftElbow,   BodyJoint::kRightElbow,
      BodyJoint::kUnspecified,   BodyJoint::kUnspecified, BodyJoint::kTorso,
      BodyJoint::kLeftHip,       BodyJoint::kRightHip,    BodyJoint::kLeftKnee,
      BodyJoint::kRightKnee,     BodyJoint::kLeftFoot,    BodyJoint::kRightFoot};
  return kOf[Index(joint)];
}

}  // namespace

Observation Observe(const Skeleton& skeleton, const Eigen::Isometry3d& X_WK) {
  Observation observation;
  observation.user = skeleton.user;
  observation.sequence = skeleton.sequence;
  observation.X_WK = X_WK;
  constexpr double kVarianceM2 = kJitterM * kJitterM + kOffsetM * kOffsetM;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const JointReading& reading = skeleton.joints[i];
    JointObservation& joint = observation.joints[i];
    joint.present = reading.present();
    if (!joint.present) continue;
    joint.inferred = reading.confidence < PersonGate::kTrackedFrom;
    joint.p_W_m = X_WK * reading.p_K_m;
    const double factor = joint.inferred ? kInferredFactor : 1;
    joint.covariance_W_m2 = factor * factor * kVarianceM2 * Eigen::Matrix3d::Identity();
    joint.confidence = reading.confidence;
  }
  return observation;
}

stream::HandFrame ToHandFrame(const Observation& observation, std::int64_t now_ns) {
  stream::HandFrame frame;
  frame.tracker = "skeleton";
  frame.sent_ns = now_ns;
  frame.age_ns =
      std::clamp<std::int64_t>(now_ns - observation.exposed_ns, 0, stream::kOldestPointNs);
  frame.tracker_pose = stream::TrackerPose{observation.X_WK.translation(),
                                           Eigen::Quaterniond(observation.X_WK.rotation())};
  for (std::size_t i = 0; i < kJoints; ++i) {
    stream::TrackedPoint point;
    const auto name = static_cast<Joint>(i);
    if (name == Joint::kLeftHand) point.role = stream::DeviceRole::kLeftHand;
    if (name == Joint::kRightHand) point.role = stream::DeviceRole::kRightHand;
    if (point.role == stream::DeviceRole::kUnspecified) point.joint = BodyJointOf(name);
    const JointObservation& joint = observation.joints[i];
    if (joint.present && joint.p_W_m.norm() <= stream::kFarthestPointM) {
      point.position_m = joint.p_W_m;
      // Whoever uses the point divides its covariance by its confidence.
      const Eigen::Matrix3d covariance = joint.confidence * joint.covariance_W_m2;
      point.sd_m = covariance.diagonal().cwiseSqrt();
      point.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
      point.confidence = joint.confidence;
      point.occluded = joint.inferred;
    }
    frame.points.push_back(point);
  }
  return frame;
}

namespace {

using Eigen::Vector3d;

Vector3d Middle(const Skeleton& skeleton, Joint left) {
  return 0.5 * (skeleton[left].p_K_m + skeleton[Mirrored(left)].p_K_m);
}

Vector3d Leftward(const Skeleton& skeleton, Joint left) {
  return skeleton[left].p_K_m - skeleton[Mirrored(left)].p_K_m;
}

bool IsWhole(const Skeleton& skeleton) {
  for (const Joint left : {Joint::kLeftShoulder, Joint::kLeftHip, Joint::kLeftFoot})
    if (!skeleton[left].present() || !skeleton[Mirrored(left)].present()) return false;
  return skeleton[Joint::kNeck].present();
}

/// Cosine of the angle within which a person by whose left and right the camera is behind has
/// swapped sides. Somebody who stands sideways may be right.
constexpr double kBehindCosine = 0.5;

std::string Number(double value) { return std::to_string(static_cast<int>(std::lround(value))); }

}  // namespace

Eigen::Isometry3d ToPose(const CameraPlace& place) {
  Eigen::Matrix3d looks_along_x;  // K's x is left, y up, z ahead.
  looks_along_x << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(place.yaw_rad, Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(-place.pitch_rad, Vector3d::UnitY()) *
                   Eigen::AngleAxisd(place.roll_rad, Vector3d::UnitX()))
                      .toRotationMatrix() *
                  looks_along_x;
  pose.translation() = place.p_W_m;
  return pose;
}

Result<StandingFit> FitStanding(std::span<const Skeleton> frames, const CameraPlace& known,
                                bool by_camera) {
  StandingFit fit{.place = known};
  fit.place.yaw_rad = 0;
  fit.place.p_W_m.setZero();
  // A frame that is level, with the camera's unknown yaw.
  const Eigen::Matrix3d R_LK = ToPose(fit.place).linear();
  Vector3d left = Vector3d::Zero(), trunk = Vector3d::Zero(), feet = Vector3d::Zero();
  Vector3d toes = Vector3d::Zero();
  std::vector<Vector3d> all;
  for (const Skeleton& frame : frames) {
    if (!IsWhole(frame)) continue;
    left += R_LK * (Leftward(frame, Joint::kLeftShoulder) + Leftward(frame, Joint::kLeftHip));
    trunk += R_LK * (frame[Joint::kNeck].p_K_m - Middle(frame, Joint::kLeftHip));
    all.push_back(R_LK * Middle(frame, Joint::kLeftFoot));
    feet += all.back();
    toes += R_LK * frame.toes_K_m.value_or(Vector3d::Zero());
  }
  if (all.empty() || all.size() < frames.size() / 2)
    return Failure("placement: the camera must see shoulders, hips and feet; step back");
  feet /= static_cast<double>(all.size());
  double square_m2 = 0;
  for (const Vector3d& one : all) square_m2 += (one - feet).squaredNorm() / 3;
  fit.scatter_m = std::sqrt(square_m2 / static_cast<double>(all.size()));
  if (fit.scatter_m > kMostScatterM) return Failure("placement: the feet moved; stand still");
  fit.lean_rad = std::acos(std::clamp(trunk.normalized().z(), -1.0, 1.0));
  if (fit.lean_rad > kMostLeanRad) {
    return Failure("placement: the trunk leans by " + Number(RadiansToDegrees(fit.lean_rad)) +
                   " degrees; stand upright, or give the camera's tilt with --camera-pitch-deg "
                   "and --camera-roll-deg");
  }
  // The yaw that turns left to W's y.
  fit.place.yaw_rad = std::atan2(left.x(), left.y());
  if (toes.dot(left.cross(Vector3d::UnitZ())) < 0) {
    return Failure(
        "placement: the toes point back, so left and right are swapped; start with --swap-sides, "
        "and with --mirrored too if raising the left hand then raises the right");
  }
  if (by_camera && std::cos(fit.place.yaw_rad) > kBehindCosine) {
    return Failure(
        "placement: by left and right the person turns the back to the camera: face the camera; if "
        "you do, left and right are swapped: start with --swap-sides");
  }
  const Vector3d feet_W = Eigen::AngleAxisd(fit.place.yaw_rad, Vector3d::UnitZ()) * feet;
  fit.place.p_W_m = Vector3d(0, 0, kAnkleHeightM) - feet_W;
  return fit;
}

namespace {

constexpr std::int64_t kMostAgeNs = 1'000'000'000;

}  // namespace

std::int64_t SenderClock::Age(std::optional<std::int64_t> sent_ns, bool unix_time,
                              std::int64_t now_ns, std::int64_t wall_ns) {
  if (!sent_ns) return latency_ns_;
  if (unix_time && wall_ns >= *sent_ns && wall_ns - *sent_ns <= kOldestNs)
    return wall_ns - *sent_ns;
  const std::int64_t behind_ns = now_ns - *sent_ns;
  if (now_ns - window_began_ns_ > kWindowNs) {
    least_before_ns_ = least_ns_;
    least_ns_ = kNone;
    window_began_ns_ = now_ns;
  }
  least_ns_ = std::min(least_ns_, behind_ns);
  const std::int64_t age_ns = latency_ns_ + behind_ns - std::min(least_ns_, least_before_ns_);
  if (age_ns <= kMostAgeNs) return age_ns;
  // The sender has set its clock or begun again.
  least_ns_ = behind_ns;
  least_before_ns_ = kNone;
  return latency_ns_;
}

namespace {

constexpr std::int64_t kAwayNs = 1'000'000'000;    // Then another person may be published.
constexpr std::size_t kMostPeople = 32;            // Remembered.
constexpr std::size_t kMostOthers = 8;             // Named.
constexpr std::int64_t kWantedNs = 2'000'000'000;  // For the wanted person to appear beside others.
constexpr std::size_t kMostStanding = 2000;        // At 1000 skeletons a second.
constexpr const char* kNotPlaced =
    "the camera is not placed yet: stand on the boards, upright, facing the camera, for two "
    "seconds, or give its position with --camera-m";

}  // namespace

Tracker::Tracker(const TrackerOptions& options) : options_(options), decoder_(options.dialect) {
  if (options.stand) return;
  camera_ = options.camera;
  X_WK_ = ToPose(options.camera);
}

void Tracker::Take(osc::Bytes bytes, std::int64_t now_ns, std::int64_t wall_ns,
                   std::vector<Observation>& out) {
  ++counts_.packets;
  counts_.bytes += bytes.size();
  if (const auto read = osc::Read(bytes, packet_); !read) {
    if (counts_.rejected_packets++ == 0) messages_.push_back(read.error().message);
    return;
  }
  decoder_.Take(packet_, now_ns, complete_);
  for (std::string& problem : decoder_.TakeProblems()) messages_.push_back(std::move(problem));
  Settle(now_ns, wall_ns, out);
}

void Tracker::Flush(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out) {
  decoder_.Flush(now_ns, complete_);
  Settle(now_ns, wall_ns, out);
}

std::vector<std::string> Tracker::Messages() {
  std::vector<std::string> messages;
  messages.swap(messages_);
  return messages;
}

void Tracker::Settle(std::int64_t now_ns, std::int64_t wall_ns, std::vector<Observation>& out) {
  for (const Decoded& decoded : complete_) Take(decoded, now_ns, wall_ns, out);
  complete_.clear();
}

void Tracker::Take(const Decoded& decoded, std::int64_t now_ns, std::int64_t wall_ns,
                   std::vector<Observation>& out) {
  const std::int32_t user = decoded.skeleton.user;
  if (options_.user && user != *options_.user) return NoteOther(user, now_ns);
  Person& person = PersonOf(user, now_ns);
  const std::int64_t since_ns = now_ns - decoded.arrived_ns;
  const std::int64_t age_ns = person.clock.Age(decoded.skeleton.sent_ns, decoded.skeleton.unix_time,
                                               decoded.arrived_ns, wall_ns - since_ns);
  const std::int64_t exposed_ns = decoded.arrived_ns - age_ns;
  if (exposed_ns <= person.exposed_ns) {
    ++counts_.overtaken;
    return;
  }
  person.exposed_ns = exposed_ns;
  const Gated gated = person.gate.Advance(decoded.skeleton, exposed_ns);
  ++counts_.skeletons;
  PersonCounts& counts = counts_.people[user];
  counts.dialect = decoded.dialect;
  ++counts.skeletons;
  counts.joints += gated.skeleton.present();
  counts.inferred += gated.inferred;
  for (const Verdict verdict : gated.verdicts) ++counts.verdicts[static_cast<std::size_t>(verdict)];
  counts.fault = gated.fault;
  Report(user, person, gated.fault);
  if (gated.fault != Fault::kNone || !IsPublished(user, now_ns)) return;
  if (!camera_) Stand(decoded, gated.skeleton, exposed_ns);
  if (!camera_) return;
  Observation& observation = out.emplace_back(Observe(gated.skeleton, X_WK_));
  observation.exposed_ns = exposed_ns;
  observation.arrived_ns = decoded.arrived_ns;
}

Tracker::Person& Tracker::PersonOf(std::int32_t user, std::int64_t now_ns) {
  if (people_.size() >= kMostPeople && people_.count(user) == 0) {
    const auto oldest = std::min_element(
        people_.begin(), people_.end(),
        [](const auto& a, const auto& b) { return a.second.seen_ns < b.second.seen_ns; });
    counts_.people.erase(oldest->first);
    people_.erase(oldest);
  }
  Person& person = people_.try_emplace(user, options_.latency_ns).first->second;
  person.seen_ns = now_ns;
  return person;
}

/// The first person, until nothing has come of that one for a while.
bool Tracker::IsPublished(std::int32_t user, std::int64_t now_ns) {
  if (published_) {
    const auto found = people_.find(*published_);
    if (found != people_.end() && now_ns - found->second.seen_ns <= kAwayNs)
      return *published_ == user;
  }
  published_ = user;
  standing_.clear();
  return true;
}

void Tracker::Stand(const Decoded& decoded, const Skeleton& gated, std::int64_t exposed_ns) {
  if (standing_.empty()) standing_since_ns_ = exposed_ns;
  if (standing_.size() < kMostStanding) standing_.push_back(gated);
  const double seconds = NanosecondsToSeconds(exposed_ns - standing_since_ns_);
  if (seconds < kStandingS || standing_.size() < kLeastStandingFrames) return;
  const auto fit = FitStanding(standing_, options_.camera, decoded.dialect != Dialect::kVmc);
  standing_.clear();
  if (!fit) {
    if (not_placed_ != fit.error().message) messages_.push_back(fit.error().message);
    not_placed_ = fit.error().message;
    return;
  }
  camera_ = fit->place;
  X_WK_ = ToPose(*camera_);
  const auto number = [](double value) { return text::Fixed(value, 2); };
  messages_.push_back("placement: the camera is at " + number(camera_->p_W_m.x()) + ", " +
                      number(camera_->p_W_m.y()) + ", " + number(camera_->p_W_m.z()) + " m, yaw " +
                      text::Fixed(RadiansToDegrees(camera_->yaw_rad), 1) +
                      " degrees; the trunk leans by " +
                      text::Fixed(RadiansToDegrees(fit->lean_rad), 1) + " degrees");
}

/// Nobody but the wanted person is published, so others are worth a line when that one stays away.
void Tracker::NoteOther(std::int32_t user, std::int64_t now_ns) {
  if (others_.empty()) other_since_ns_ = now_ns;
  if (others_.size() < kMostOthers) others_.insert(user);
  if (others_reported_ || now_ns - other_since_ns_ < kWantedNs) return;
  others_reported_ = true;
  if (const std::string advice = Advice(); !advice.empty()) messages_.push_back(advice);
}

std::string Tracker::AdviceOf(std::int32_t user) const {
  const auto found = counts_.people.find(user);
  if (found == counts_.people.end()) return "";
  if (found->second.fault != Fault::kNone) return skeleton::Advice(found->second.fault);
  if (camera_ || published_ != user) return "";
  return not_placed_.empty() ? kNotPlaced : not_placed_;
}

std::string Tracker::Advice() const {
  if (options_.user && counts_.people.count(*options_.user) == 0 && !others_.empty()) {
    std::string seen;
    for (const std::int32_t other : others_)
      seen += (seen.empty() ? "" : ", ") + std::to_string(other);
    return "person " + std::to_string(*options_.user) + " was not seen; seen: " + seen +
           "; choose one of them with --user, or leave it out";
  }
  return decoder_.NoSkeleton();
}

void Tracker::Report(std::int32_t user, Person& person, Fault fault) {
  if (fault == person.reported) return;
  person.reported = fault;
  const std::string who = "person " + std::to_string(user) + ": ";
  messages_.push_back(
      who + (fault == Fault::kNone ? "the skeleton is plausible again" : skeleton::Advice(fault)));
}

}  // namespace footing::skeleton

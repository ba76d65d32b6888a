#include "clients/skeleton/tracking/person_gate.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "common/base/units.h"

namespace footing::skeleton {
namespace {

constexpr std::size_t kEvery = 8;  // A median of 5 s changes little from frame to frame.

}  // namespace

void BoneLengths::Add(std::size_t bone, double length_m) {
  History& history = histories_[bone];
  history.lengths_m[history.count % kWindow] = static_cast<float>(length_m);
  ++history.count;
  if (history.count < kLeast || (history.count != kLeast && history.count % kEvery != 0)) return;
  auto sorted = history.lengths_m;
  const auto count = static_cast<std::ptrdiff_t>(std::min(history.count, kWindow));
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.begin() + count);
  history.median_m = static_cast<double>(sorted[static_cast<std::size_t>(count / 2)]);
}

std::optional<double> BoneLengths::Median(std::size_t bone) const {
  if (histories_[bone].count < kLeast) return std::nullopt;
  return histories_[bone].median_m;
}

std::optional<double> BoneLengths::Limb() const {
  double sum_m = 0;
  int count = 0;
  for (std::size_t bone = 0; bone < kBones; ++bone) {
    if (!kBoneList[bone].limb) continue;
    if (const auto median = Median(bone)) {
      sum_m += *median;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum_m / count;
}

namespace {

// A limb's segment of an adult or a child: 0.2 to 0.5 m, with the errors of a camera. The mean of
// all limbs is 0.21 of the height, so somebody of 0.86 m has the least.
constexpr double kShortestM = 0.18;
constexpr double kLongestM = 0.65;
constexpr double kMemoryFrames = 90;  // Length of the running means: 3 s at 30 Hz.
constexpr double kLeastFrames = 30;   // Before a mean says anything.
// Hands and bent knees are in front of the shoulders by 0.10 to 0.15 m on average (four recorded
// people); less than this says nothing.
constexpr double kFrontM = 0.04;
constexpr double kUpright = 0.5;  // The upward part of a trunk that is not lying.
constexpr double kBentM = 0.08;   // A knee out of the line from hip to foot: a leg that is bent.
// OSCeleton's normalised coordinates, taken for metres, are upside down and half as long.
constexpr double kNormalisedM = 0.26;

bool Both(const Skeleton& skeleton, Joint a, Joint b) {
  return skeleton[a].confidence >= PersonGate::kTrackedFrom &&
         skeleton[b].confidence >= PersonGate::kTrackedFrom;
}

Fault ScaleFault(double limb_m) {
  if (limb_m >= kShortestM && limb_m <= kLongestM) return Fault::kNone;
  if (limb_m >= 1000 * kShortestM && limb_m <= 1000 * kLongestM) return Fault::kMillimetres;
  if (limb_m >= 100 * kShortestM && limb_m <= 100 * kLongestM) return Fault::kCentimetres;
  // 0.2 m and more over the 1.28 to 2.56 m of one unit.
  if (limb_m >= kShortestM / 2.56 && limb_m < kShortestM) return Fault::kShort;
  return Fault::kScale;
}

Eigen::Vector3d Middle(const Skeleton& skeleton, Joint left, Joint right) {
  return 0.5 * (skeleton[left].p_K_m + skeleton[right].p_K_m);
}

/// The upward part of the direction from the hips, or the torso, to the neck.
std::optional<double> UpwardPart(const Skeleton& skeleton) {
  if (skeleton[Joint::kNeck].confidence < PersonGate::kTrackedFrom) return std::nullopt;
  Eigen::Vector3d low;
  if (Both(skeleton, Joint::kLeftHip, Joint::kRightHip)) {
    low = Middle(skeleton, Joint::kLeftHip, Joint::kRightHip);
  } else if (skeleton[Joint::kTorso].confidence >= PersonGate::kTrackedFrom) {
    low = skeleton[Joint::kTorso].p_K_m;
  } else {
    return std::nullopt;
  }
  const Eigen::Vector3d trunk = skeleton[Joint::kNeck].p_K_m - low;
  return trunk.norm() > 0 ? std::optional(trunk.y() / trunk.norm()) : std::nullopt;
}

/// Where hands and bent knees are if left is left.
struct Front {
  double ahead_m = 0;  ///< In front of the body, on average.
  double away = 0;     ///< The part of "in front" that points away from the camera, -1 to 1.
};

std::optional<Front> FrontOf(const Skeleton& skeleton) {
  if (!Both(skeleton, Joint::kLeftShoulder, Joint::kRightShoulder)) return std::nullopt;
  const Eigen::Vector3d left =
      skeleton[Joint::kLeftShoulder].p_K_m - skeleton[Joint::kRightShoulder].p_K_m;
  const Eigen::Vector3d ahead = left.cross(Eigen::Vector3d::UnitY());  // y x z = x in W.
  if (ahead.norm() < 0.1) return std::nullopt;
  const Eigen::Vector3d chest = Middle(skeleton, Joint::kLeftShoulder, Joint::kRightShoulder);
  double sum_m = 0;
  int count = 0;
  const auto add = [&](const Eigen::Vector3d& offset) {
    sum_m += offset.dot(ahead.normalized());
    ++count;
  };
  for (const Joint hand : {Joint::kLeftHand, Joint::kRightHand})
    if (skeleton[hand].confidence >= PersonGate::kTrackedFrom) add(skeleton[hand].p_K_m - chest);
  for (const auto& [hip, knee, foot] :
       {std::array{Joint::kLeftHip, Joint::kLeftKnee, Joint::kLeftFoot},
        std::array{Joint::kRightHip, Joint::kRightKnee, Joint::kRightFoot}}) {
    if (!Both(skeleton, hip, knee) || !Both(skeleton, knee, foot)) continue;
    const Eigen::Vector3d bend = skeleton[knee].p_K_m - Middle(skeleton, hip, foot);
    if (bend.norm() > kBentM) add(bend);
  }
  if (count == 0) return std::nullopt;
  return Front{sum_m / count, ahead.normalized().z()};
}

}  // namespace

std::string Advice(Fault fault) {
  switch (fault) {
    case Fault::kNone:
      return "";
    case Fault::kMillimetres:
      return "the bones are a thousand times too long: the sender uses millimetres; start with "
             "--units mm";
    case Fault::kCentimetres:
      return "the bones are a hundred times too long: the sender uses centimetres; start with "
             "--units cm";
    case Fault::kNormalised:
      return "the bones are too short: the sender uses normalised image coordinates; start with "
             "--units normalised, or OSCeleton with -r";
    case Fault::kShort:
      return "the bones are half as long as a person's or less: the sender's scale is wrong; start "
             "with --factor (0.5,0.5,0.5 for a skeleton of half size)";
    case Fault::kScale:
      return "the bones have no length of a person in any known unit; see --units and the sender's "
             "factors (-mx, -my, -mz of OSCeleton: --factor)";
    case Fault::kUpsideDown:
      return "the head is below the hips: the sender's y points down, or the camera is upside "
             "down; start with --flip-y, or turn the camera";
    case Fault::kSwapped:
      return "left and right are swapped: hands and bent knees are behind the body; start with "
             "--swap-sides (without it if it is given), and with --mirrored too if raising the "
             "left "
             "hand then raises the right";
    case Fault::kTurned:
      return "the person turns the back to the camera, which takes it for the front: face the "
             "camera; of a sender without a camera left and right are swapped: --swap-sides";
  }
  return "";
}

Gated PersonGate::Advance(const Skeleton& skeleton, std::int64_t time_ns) {
  Gated gated{.skeleton = skeleton};
  for (std::size_t i = 0; i < kJoints; ++i) {
    JointReading& joint = gated.skeleton.joints[i];
    if (joint.confidence >= kUsedFrom) continue;
    joint.confidence = 0;
    gated.verdicts[i] = Verdict::kAbsent;
  }
  gated.fault = FaultOf(gated.skeleton);
  if (gated.fault != Fault::kNone) {
    for (std::size_t i = 0; i < kJoints; ++i) {
      if (gated.skeleton.joints[i].present()) gated.verdicts[i] = Verdict::kFault;
      gated.skeleton.joints[i].confidence = 0;
    }
    return gated;
  }
  DropBones(gated);
  DropFast(gated, time_ns);
  for (const JointReading& joint : gated.skeleton.joints)
    gated.inferred += joint.present() && joint.confidence < kTrackedFrom ? 1 : 0;
  return gated;
}

Fault PersonGate::FaultOf(const Skeleton& skeleton) {
  for (std::size_t bone = 0; bone < kBones; ++bone) {
    const auto& [near, far, limb] = kBoneList[bone];
    if (Both(skeleton, near, far))
      lengths_.Add(bone, (skeleton[far].p_K_m - skeleton[near].p_K_m).norm());
  }
  weight_ = std::min(weight_ + 1, kMemoryFrames);
  if (const auto up = UpwardPart(skeleton)) up_ += (*up - up_) / weight_;
  if (const auto limb_m = lengths_.Limb()) {
    const Fault fault = ScaleFault(*limb_m);
    if (fault == Fault::kShort && up_ < -kUpright) return Fault::kNormalised;
    if (fault != Fault::kNone) return fault;
    if (const auto front = FrontOf(skeleton)) {
      front_m_ += (front->ahead_m - front_m_) / weight_;
      away_ += (front->away - away_) / weight_;
    }
  }
  if (weight_ < kLeastFrames) return Fault::kNone;
  if (up_ < -kUpright)
    return lengths_.Limb().value_or(1) < kNormalisedM ? Fault::kNormalised : Fault::kUpsideDown;
  if (front_m_ >= -kFrontM) return Fault::kNone;
  return away_ > 0 ? Fault::kSwapped : Fault::kTurned;
}

void PersonGate::DropBones(Gated& gated) const {
  for (std::size_t bone = 0; bone < kBones; ++bone) {
    const auto& [near, far, limb] = kBoneList[bone];
    const JointReading &a = gated.skeleton[near], &b = gated.skeleton[far];
    const auto median_m = lengths_.Median(bone);
    if (!median_m || !a.present() || !b.present()) continue;
    const double length_m = (b.p_K_m - a.p_K_m).norm();
    if (std::abs(length_m - *median_m) <= kBoneTolerance * *median_m) continue;
    // The less certain end; of equals the outer one.
    const Joint wrong = a.confidence < b.confidence ? near : far;
    gated.skeleton[wrong].confidence = 0;
    gated.verdicts[Index(wrong)] = Verdict::kBone;
  }
}

void PersonGate::DropFast(Gated& gated, std::int64_t time_ns) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    JointReading& joint = gated.skeleton.joints[i];
    Last& last = last_[i];
    if (!joint.present()) continue;
    const double step_s = std::max(0.0, NanosecondsToSeconds(time_ns - last.time_ns));
    const double farthest_m = kNoiseM + kFastestMps * step_s;
    if (last.known && last.rejected < kMostRejected &&
        (joint.p_K_m - last.p_K_m).norm() > farthest_m) {
      ++last.rejected;
      joint.confidence = 0;
      gated.verdicts[i] = Verdict::kSpeed;
      continue;
    }
    last = {joint.p_K_m, time_ns, 0, true};
  }
}

}  // namespace footing::skeleton

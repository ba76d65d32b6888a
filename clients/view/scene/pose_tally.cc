#include "clients/view/scene/pose_tally.h"

#include <cmath>
#include <cstdlib>

#include "common/base/units.h"

namespace footing::scene {
namespace {

using body::Landmark;

constexpr std::int64_t kNearNs = 50'000'000;
constexpr Landmark kTips[] = {Landmark::kLeftHandEnd, Landmark::kRightHandEnd,
                              Landmark::kLeftToeEnd, Landmark::kRightToeEnd};

bool IsTip(Landmark landmark) {
  for (const Landmark tip : kTips) {
    if (landmark == tip) return true;
  }
  return false;
}

const ReferencePose* Nearest(const std::deque<ReferencePose>& references, std::int64_t at_ns) {
  const ReferencePose* nearest = nullptr;
  std::int64_t least_ns = kNearNs;
  for (const ReferencePose& reference : references) {
    const std::int64_t away_ns = std::abs(reference.sampled_ns - at_ns);
    if (away_ns > least_ns) continue;
    least_ns = away_ns;
    nearest = &reference;
  }
  return nearest;
}

}  // namespace

void PoseTally::Add(const CharacterPose& pose, const Anatomy& anatomy, std::int64_t host_ns,
                    const std::deque<ReferencePose>& references) {
  if (!pose.body) return;
  ++frames_;
  if (pose.body->calibrated && !last_.calibrated) ++calibrations_;
  last_ = *pose.body;
  if (!last_.calibrated) return;
  ++calibrated_frames_;
  const ReferencePose* reference = Nearest(references, host_ns - SecondsToNanoseconds(last_.lag_s));
  if (reference == nullptr || !Fits(anatomy, reference->parents)) return;
  if (pose.links.size() != reference->positions_m.size()) return;
  Compare(pose, anatomy, *reference);
  invalid_ += pose.valid ? 0 : 1;
}

void PoseTally::Compare(const CharacterPose& pose, const Anatomy& anatomy,
                        const ReferencePose& reference) {
  const auto error_m = [&](Landmark landmark) -> Eigen::Vector3d {
    const auto joint = static_cast<std::size_t>(anatomy.landmarks[landmark]);
    return pose.links[joint].position_m - reference.positions_m[joint];
  };
  const auto error_cm = [&](Landmark landmark) { return 100 * error_m(landmark).norm(); };
  const Eigen::Vector3d root_m = error_m(Landmark::kHips);
  double sum_cm = 0, relative_cm = 0;
  int joints = 0;
  for (int i = 0; i < body::kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    if (anatomy.landmarks[landmark] < 0 || IsTip(landmark)) continue;
    sum_cm += error_cm(landmark);
    relative_cm += 100 * (error_m(landmark) - root_m).norm();
    ++joints;
  }
  ++compared_;
  all_cm_ += sum_cm / joints;
  relative_cm_ += relative_cm / joints;
  wrists_cm_ += 0.5 * (error_cm(Landmark::kLeftWrist) + error_cm(Landmark::kRightWrist));
  ankles_cm_ += 0.5 * (error_cm(Landmark::kLeftAnkle) + error_cm(Landmark::kRightAnkle));
}

}  // namespace footing::scene

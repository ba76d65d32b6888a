#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/body/body.h"
#include "common/base/quantile.h"
#include "common/virtual/motion/joint_centres.h"
#include "common/virtual/motion/marker_fit.h"

namespace footing::motion {
namespace {

using body::Landmark;

constexpr Eigen::Index kMostFrames = 400;              // Of a trial for its lengths.
constexpr double kLeastRatio = 0.6, kMostRatio = 1.6;  // Of a length over the standard one.

/// Medians of distances between centres over the frames in which both are there.
class Lengths {
 public:
  Lengths(const MarkerTracks& tracks, const MarkerSet& set) {
    const Eigen::Index step = std::max<Eigen::Index>(1, tracks.frames() / kMostFrames);
    for (Eigen::Index frame = 0; frame < tracks.frames(); frame += step) {
      frames_.push_back(JointCentres(tracks, set, frame));
    }
  }

  /// 0 where the two are never there together.
  double Between(Landmark a, Landmark b) const {
    return MedianOf([&](const Centres& centres) -> std::optional<double> {
      const auto& from = centres[static_cast<std::size_t>(a)];
      const auto& to = centres[static_cast<std::size_t>(b)];
      if (!from || !to) return std::nullopt;
      return (*from - *to).norm();
    });
  }
  double Trunk() const {
    return MedianOf([](const Centres& centres) -> std::optional<double> {
      const auto& left = centres[static_cast<std::size_t>(Landmark::kLeftShoulder)];
      const auto& right = centres[static_cast<std::size_t>(Landmark::kRightShoulder)];
      const auto& hips = centres[static_cast<std::size_t>(Landmark::kHips)];
      if (!left || !right || !hips) return std::nullopt;
      return ((*left + *right) / 2 - *hips).norm();
    });
  }

 private:
  template <typename F>
  double MedianOf(F length) const {
    std::vector<double> values;
    for (const Centres& centres : frames_) {
      if (const auto value = length(centres)) values.push_back(*value);
    }
    return text::Median(std::move(values));
  }

  std::vector<Centres> frames_;
};

/// Mean of both legs, m.
double LegLength(const Lengths& lengths) {
  double legs_m = 0;
  for (int side = 0; side < 2; ++side) {
    legs_m +=
        (lengths.Between(OfSide(Landmark::kLeftHip, side), OfSide(Landmark::kLeftKnee, side)) +
         lengths.Between(OfSide(Landmark::kLeftKnee, side), OfSide(Landmark::kLeftAnkle, side))) /
        2;
  }
  return legs_m;
}

/// Gives a skeleton the lengths between the joint centres.
class SkeletonScaling {
 public:
  SkeletonScaling(const Lengths& lengths, const body::Landmarks& landmarks,
                  body::Skeleton& skeleton)
      : lengths_(lengths), landmarks_(landmarks), skeleton_(skeleton) {}

  /// The bones of arms and legs; hips and shoulders as far apart as they were seen.
  void ScaleLimbs() {
    const double hips_m = lengths_.Between(Landmark::kLeftHip, Landmark::kRightHip);
    const double shoulders_m = lengths_.Between(Landmark::kLeftShoulder, Landmark::kRightShoulder);
    for (int side = 0; side < 2; ++side) {
      const auto here = [side](Landmark left) { return OfSide(left, side); };
      Stretch(here(Landmark::kLeftHip), here(Landmark::kLeftKnee));
      Stretch(here(Landmark::kLeftKnee), here(Landmark::kLeftAnkle));
      Stretch(here(Landmark::kLeftAnkle), here(Landmark::kLeftToe));
      Stretch(here(Landmark::kLeftShoulder), here(Landmark::kLeftElbow));
      Stretch(here(Landmark::kLeftElbow), here(Landmark::kLeftWrist));
      const double sign = side == 0 ? 1 : -1;
      Offset(landmarks_[here(Landmark::kLeftHip)]).y() = sign * hips_m / 2;
      if (shoulders_m > 0) {
        Offset(landmarks_[here(Landmark::kLeftShoulder)]).y() = sign * shoulders_m / 2;
      }
    }
  }

  /// The back, so that hips and shoulders are `trunk_m` apart.
  void ScaleBack(double trunk_m) {
    double back_m = 0;
    const int chest = landmarks_[Landmark::kLeftClavicle];
    for (int i = chest; i > 0; i = skeleton_.joint(i).parent) back_m += Offset(i).z();
    const double rest_m = Offset(landmarks_[Landmark::kLeftShoulder]).z() -
                          Offset(landmarks_[Landmark::kLeftHip]).z();
    if (!(trunk_m > 0 && back_m > 0)) return;
    const double ratio = std::clamp((trunk_m - rest_m) / back_m, kLeastRatio, kMostRatio);
    for (int i = chest; i > 0; i = skeleton_.joint(i).parent) {
      for (body::Joint& joint : skeleton_.joints) {  // All that hang on the same bone.
        if (joint.parent == skeleton_.joint(i).parent && joint.parent > 0 &&
            joint.offset_m == Offset(i) &&
            &joint != &skeleton_.joints[static_cast<std::size_t>(i)]) {
          joint.offset_m *= ratio;
        }
      }
      Offset(i) *= ratio;
    }
  }

  /// Bones of a length that no person has, and that length; empty when there are none.
  const std::string& impossible() const { return impossible_; }

 private:
  Eigen::Vector3d& Offset(int joint) {
    return skeleton_.joints[static_cast<std::size_t>(joint)].offset_m;
  }

  /// Stretches the bones from `of` (not itself) down to `to` by the ratio of their lengths.
  void Stretch(Landmark of, Landmark to) {
    const double measured_m = lengths_.Between(of, to);
    double standard_m = 0;
    const int from = landmarks_[of];
    for (int i = landmarks_[to]; i != from; i = skeleton_.joint(i).parent) {
      standard_m += Offset(i).norm();
    }
    double ratio = measured_m / standard_m;
    // A toe's marker is anywhere from the ball of the foot to the tip of the shoe.
    if (to == Landmark::kLeftToe || to == Landmark::kRightToe) ratio = std::clamp(ratio, 0.8, 1.4);
    if (measured_m == 0) return;  // Never seen: the standard one.
    if (!(ratio > kLeastRatio && ratio < kMostRatio)) {
      impossible_ += (impossible_.empty() ? "" : ", ") + std::string(LandmarkName(of)) + " to " +
                     std::string(LandmarkName(to)) + " " + std::to_string(measured_m) + " m";
      return;
    }
    for (int i = landmarks_[to]; i != from; i = skeleton_.joint(i).parent) Offset(i) *= ratio;
  }

  const Lengths& lengths_;
  const body::Landmarks& landmarks_;
  body::Skeleton& skeleton_;
  std::string impossible_;
};

}  // namespace

Result<FittedSkeleton> FitLengths(const MarkerTracks& tracks, const MarkerSet& set, body::Sex sex) {
  const Lengths lengths(tracks, set);
  const double trunk_m = lengths.Trunk();
  const double height_m = body::StatureOfLengths(sex) * (LegLength(lengths) + trunk_m);
  if (!(height_m > 0.5 && height_m < 2.6)) {
    return InvalidData("the joint centres make a person of " + std::to_string(height_m) +
                       " m: are the markers in W (z up), and of that set?");
  }
  FittedSkeleton fitted{body::StandardPerson(height_m, sex), height_m};
  const auto landmarks = body::FindLandmarks(fitted.skeleton);
  if (!landmarks) return landmarks.error();
  SkeletonScaling scaling(lengths, *landmarks, fitted.skeleton);
  scaling.ScaleLimbs();
  if (!scaling.impossible().empty()) {
    return InvalidData("no person has these lengths: " + scaling.impossible() +
                       "; are the markers named as in set " + std::string(set.name) + "?");
  }
  scaling.ScaleBack(trunk_m);
  return fitted;
}

}  // namespace footing::motion

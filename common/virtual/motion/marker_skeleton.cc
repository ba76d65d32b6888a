#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/body/body.h"
#include "common/text/quantile.h"
#include "common/virtual/motion/joint_centres.h"
#include "common/virtual/motion/marker_fit.h"

namespace footing::motion {
namespace {

using body::Landmark;

constexpr Eigen::Index kMostFrames = 400;              // Of a trial for its lengths.
constexpr double kLeastRatio = 0.6, kMostRatio = 1.6;  // Of a length over the standard one.

Landmark LandmarkOfSide(Landmark left, int side) { return side == 0 ? left : Mirrored(left); }

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

}  // namespace

Result<FittedSkeleton> FitLengths(const MarkerTracks& tracks, const MarkerSet& set, body::Sex sex) {
  const Lengths lengths(tracks, set);
  double legs_m = 0;
  for (int side = 0; side < 2; ++side) {
    legs_m += (lengths.Between(LandmarkOfSide(Landmark::kLeftHip, side),
                               LandmarkOfSide(Landmark::kLeftKnee, side)) +
               lengths.Between(LandmarkOfSide(Landmark::kLeftKnee, side),
                               LandmarkOfSide(Landmark::kLeftAnkle, side))) /
              2;
  }
  const double trunk_m = lengths.Trunk();
  const double height_m = body::StatureOfLengths(sex) * (legs_m + trunk_m);
  if (!(height_m > 0.5 && height_m < 2.6)) {
    return InvalidData("the joint centres make a person of " + std::to_string(height_m) +
                       " m: are the markers in W (z up), and of that set?");
  }
  FittedSkeleton fitted{body::StandardPerson(height_m, sex), height_m};
  std::vector<body::Joint>& joints = fitted.skeleton.joints;
  const auto landmarks = body::FindLandmarks(fitted.skeleton);
  if (!landmarks) return landmarks.error();
  std::string bad;
  const auto offset = [&](int joint) -> Eigen::Vector3d& {
    return joints[static_cast<std::size_t>(joint)].offset_m;
  };
  // Stretches the bones from `of` (not itself) down to `to` by the ratio of their lengths.
  const auto stretch = [&](Landmark of, Landmark to) {
    const double measured_m = lengths.Between(of, to);
    double standard_m = 0;
    const int from = (*landmarks)[of];
    for (int i = (*landmarks)[to]; i != from; i = fitted.skeleton.joint(i).parent) {
      standard_m += offset(i).norm();
    }
    double ratio = measured_m / standard_m;
    // A toe's marker is anywhere from the ball of the foot to the tip of the shoe.
    if (to == Landmark::kLeftToe || to == Landmark::kRightToe) ratio = std::clamp(ratio, 0.8, 1.4);
    if (measured_m == 0) return;  // Never seen: the standard one.
    if (!(ratio > kLeastRatio && ratio < kMostRatio)) {
      bad += (bad.empty() ? "" : ", ") + std::string(LandmarkName(of)) + " to " +
             std::string(LandmarkName(to)) + " " + std::to_string(measured_m) + " m";
      return;
    }
    for (int i = (*landmarks)[to]; i != from; i = fitted.skeleton.joint(i).parent) {
      offset(i) *= ratio;
    }
  };
  const double hips_m = lengths.Between(Landmark::kLeftHip, Landmark::kRightHip);
  const double shoulders_m = lengths.Between(Landmark::kLeftShoulder, Landmark::kRightShoulder);
  for (int side = 0; side < 2; ++side) {
    const auto here = [side](Landmark left) { return LandmarkOfSide(left, side); };
    stretch(here(Landmark::kLeftHip), here(Landmark::kLeftKnee));
    stretch(here(Landmark::kLeftKnee), here(Landmark::kLeftAnkle));
    stretch(here(Landmark::kLeftAnkle), here(Landmark::kLeftToe));
    stretch(here(Landmark::kLeftShoulder), here(Landmark::kLeftElbow));
    stretch(here(Landmark::kLeftElbow), here(Landmark::kLeftWrist));
    const double sign = side == 0 ? 1 : -1;
    offset((*landmarks)[here(Landmark::kLeftHip)]).y() = sign * hips_m / 2;
    if (shoulders_m > 0) {
      offset((*landmarks)[here(Landmark::kLeftShoulder)]).y() = sign * shoulders_m / 2;
    }
  }
  if (!bad.empty()) {
    return InvalidData("no person has these lengths: " + bad +
                       "; are the markers named as in set " + std::string(set.name) + "?");
  }
  // The back is stretched so that hips and shoulders are as far apart as they were seen.
  double back_m = 0;
  const int chest = (*landmarks)[Landmark::kLeftClavicle];
  for (int i = chest; i > 0; i = fitted.skeleton.joint(i).parent) back_m += offset(i).z();
  const double rest_m = offset((*landmarks)[Landmark::kLeftShoulder]).z() -
                        offset((*landmarks)[Landmark::kLeftHip]).z();
  if (trunk_m > 0 && back_m > 0) {
    const double ratio = std::clamp((trunk_m - rest_m) / back_m, kLeastRatio, kMostRatio);
    for (int i = chest; i > 0; i = fitted.skeleton.joint(i).parent) {
      for (body::Joint& joint : joints) {  // All that hang on the same bone.
        if (joint.parent == fitted.skeleton.joint(i).parent && joint.parent > 0 &&
            joint.offset_m == offset(i) && &joint != &joints[static_cast<std::size_t>(i)]) {
          joint.offset_m *= ratio;
        }
      }
      offset(i) *= ratio;
    }
  }
  return fitted;
}

}  // namespace footing::motion

#include "common/camera/camera_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::camera_pose {
namespace {

constexpr double kLeastWidthM = 0.1;
constexpr double kMostScaleOff = 0.02;
/// Noise alone tilts one plumb against the marks of one board by 1.1 degrees per axis
/// (footing-eval calibration), and beyond this once in some 700 calibrations.
constexpr double kMostTiltRad = DegreesToRadians(4);
constexpr double kMostTurnSdRad = DegreesToRadians(1);
/// Of a mark's residual over its standard deviation; noise reaches it once in some thousand marks.
constexpr double kMostDeviations = 4;
constexpr double kSureDeviations = 3;

std::string Mm(double metres) { return text::Fixed(1e3 * metres, 0) + " mm"; }
std::string Degrees(double rad) { return text::Fixed(RadiansToDegrees(rad), 1) + " degrees"; }

/// Extent of the marks across the line that fits them best.
double WidthM(const std::vector<SeenMark>& marks) {
  Eigen::Matrix3Xd places(3, marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = marks[i].p_W_m;
  const Eigen::Matrix3Xd centred = places.colwise() - places.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(centred * centred.transpose());
  const Eigen::RowVectorXd across = axes.eigenvectors().col(1).transpose() * centred;
  return across.maxCoeff() - across.minCoeff();
}

std::optional<Error> WrongMarks(const Observations& observations) {
  if (observations.marks.size() < 3)
    return InvalidData(std::to_string(observations.marks.size()) +
                       " marks were seen: three are needed, four or more are better");
  const double width_m = WidthM(observations.marks);
  if (width_m < kLeastWidthM)
    return InvalidData("the marks lie in a line (" + Mm(width_m) +
                       " wide), so a turn about it is not seen: add a mark beside it");
  return {};
}

/// Marks of one plane that are seen in a mirror fit as well: through the floor, and upside down.
std::optional<Error> Mirrored(const Observations& observations, const CameraPose& pose) {
  double lowest_m = observations.marks.front().p_W_m.z();
  for (const SeenMark& mark : observations.marks) lowest_m = std::min(lowest_m, mark.p_W_m.z());
  const bool is_below = pose.X_WC.translation().z() < lowest_m;
  const bool is_upside_down = pose.X_WC.linear()(2, 1) > 0;  // Its y points down.
  if (!is_below || !is_upside_down) return {};
  return InvalidData(
      "the marks are seen as in a mirror: the image is mirrored, or marks of the left and the "
      "right were exchanged. Switch mirroring off in the camera, and touch the marks in the order "
      "that is asked for");
}

Observations Without(std::size_t mark, Observations observations) {
  observations.marks.erase(observations.marks.begin() + static_cast<std::ptrdiff_t>(mark));
  return observations;
}

/// The mark without which the others fit best; none when the others are too few to say so.
std::optional<std::size_t> WorstMark(const Observations& observations) {
  std::optional<std::size_t> worst;
  double least = 0;
  for (std::size_t i = 0; i < observations.marks.size(); ++i) {
    const Observations others = Without(i, observations);
    if (others.marks.size() < 3 || WidthM(others.marks) < kLeastWidthM) continue;
    const double misfit = Fit(others).misfit;
    if (worst && misfit >= least) continue;
    least = misfit;
    worst = i;
  }
  return worst;
}

Error MisplacedMark(const Observations& observations, const CameraPose& pose, std::size_t mark) {
  return InvalidData("the mark " + observations.marks[mark].name + " is " +
                     Mm(pose.residuals_m[mark]) +
                     " from where the others put it: measure it again, with the sphere right on "
                     "the mark; if it stays, the boards lie otherwise than in the layout");
}

std::optional<Error> WrongLength(const Observations& observations, const CameraPose& pose) {
  const double off = std::abs(pose.scale - 1);
  if (off <= kMostScaleOff || off <= kSureDeviations * pose.scale_sd) return {};
  // A lens is as wrong for the other marks; one mark at an end that is misplaced is not.
  const auto worst = WorstMark(observations);
  if (worst && std::abs(Fit(Without(*worst, observations)).scale - 1) < off / 2)
    return MisplacedMark(observations, pose, *worst);
  const std::string times = text::Fixed(pose.scale, 3);
  return InvalidData("the camera sees the marks " +
                     text::Fixed(100 * std::abs(1 / pose.scale - 1), 1) + " % " +
                     (pose.scale < 1 ? "too far" : "too near") +
                     " from each other, so distances are wrong, too: the focal length, the "
                     "sphere's radius or the boards' layout is not the true one. Calibrate the "
                     "lens; if lens and layout are right, multiply radius_m by " +
                     times);
}

std::optional<Error> WrongPlace(const Observations& observations, const CameraPose& pose) {
  for (std::size_t i = 0; i < observations.marks.size(); ++i) {
    const SeenMark& mark = observations.marks[i];
    const Eigen::Matrix3d& turn = pose.X_WC.linear();
    const Eigen::Matrix3d covariance =
        turn * mark.seen.covariance_m2 * turn.transpose() +
        std::pow(observations.placement_sd_m, 2) * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d error = mark.p_W_m - pose.X_WC * mark.seen.p_C_m;
    if (error.dot(covariance.ldlt().solve(error)) <= kMostDeviations * kMostDeviations) continue;
    const auto worst = WorstMark(observations);
    if (!worst)
      return InvalidData("the marks are up to " + Mm(std::ranges::max(pose.residuals_m)) +
                         " from where they should be, and with so few nobody can say which one is "
                         "wrong: add a fourth mark, or measure all again, with the sphere right on "
                         "each mark");
    return MisplacedMark(observations, pose, *worst);
  }
  return {};
}

std::optional<Error> WrongGravity(const Observations& observations, const CameraPose& pose) {
  if (observations.plumbs.empty() || pose.tilt_rad <= kMostTiltRad) return {};
  return InvalidData("gravity is " + Degrees(pose.tilt_rad) +
                     " off the boards' vertical: the boards do not lie level, or the controller "
                     "did not stand upright on its mark. Level the boards, or measure again");
}

std::optional<Error> Uncertain(const CameraPose& pose) {
  if (pose.TurnSdRad() <= kMostTurnSdRad) return {};
  return InvalidData("the camera's direction stays uncertain by " + Degrees(pose.TurnSdRad()) +
                     ": add marks, farther apart, or move the camera nearer");
}

}  // namespace

Result<CameraPose> Calibrate(const Observations& observations) {
  if (auto refusal = WrongMarks(observations)) return *std::move(refusal);
  Observations marks_only = observations;
  marks_only.plumbs.clear();
  if (auto refusal = Mirrored(observations, Fit(marks_only))) return *std::move(refusal);
  CameraPose pose = Fit(observations);
  if (auto refusal = WrongLength(observations, pose)) return *std::move(refusal);
  if (auto refusal = WrongPlace(observations, pose)) return *std::move(refusal);
  if (auto refusal = WrongGravity(observations, pose)) return *std::move(refusal);
  if (auto refusal = Uncertain(pose)) return *std::move(refusal);
  return pose;
}

}  // namespace footing::camera_pose

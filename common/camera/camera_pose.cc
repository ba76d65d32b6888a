#include "common/camera/camera_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "common/base/result.h"
#include "common/base/rotation.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/geometry.h"
#include "common/stream/hands.h"

namespace footing::camera_pose {
namespace {

/// A hand that holds a sphere against a board trembles by less than this, per axis.
constexpr double kTrembleM = 0.001;
/// Scatter over what noise and trembling explain, as a ratio of variances. The greatest of three
/// directions of 30 frames of noise stays below it (chi-squared, one in 10^4).
constexpr double kMostScatter = 2.5;

}  // namespace

Result<SeenPoint> MeanAtRest(const std::vector<SeenPoint>& frames) {
  if (frames.size() < kLeastFrames)
    return InvalidData("the sphere was seen in " + std::to_string(frames.size()) + " frames, " +
                       std::to_string(kLeastFrames) +
                       " are needed: turn it towards the camera and keep the hand behind it");
  const double count = static_cast<double>(frames.size());
  SeenPoint mean;
  for (const SeenPoint& frame : frames) {
    mean.p_C_m += frame.p_C_m / count;
    mean.covariance_m2 += frame.covariance_m2 / count;
  }
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const SeenPoint& frame : frames) {
    const Eigen::Vector3d off = frame.p_C_m - mean.p_C_m;
    scatter += off * off.transpose() / (count - 1);
  }
  const Eigen::Matrix3d expected =
      mean.covariance_m2 + kTrembleM * kTrembleM * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratio(scatter, expected);
  if (!(ratio.eigenvalues().maxCoeff() <= kMostScatter))
    return InvalidData("the sphere moved by " + text::Fixed(1e3 * std::sqrt(scatter.trace()), 1) +
                       " mm while it was measured: hold it on the mark and keep still");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> common(mean.covariance_m2 - scatter);
  const Eigen::Matrix3d axes = common.eigenvectors();
  mean.covariance_m2 =
      scatter / count + axes * common.eigenvalues().cwiseMax(0).asDiagonal() * axes.transpose();
  return mean;
}

namespace {

constexpr double kLeastWidthM = 0.1;
constexpr double kMostScaleOff = 0.02;
/// Noise alone tilts one plumb against the marks of one board by 1.1 degrees per axis
/// (footing-eval calibration), and beyond this once in some 700 calibrations.
constexpr double kMostTiltRad = DegreesToRadians(4);
constexpr double kMostTurnSdRad = DegreesToRadians(1);
/// Largest ratio of a mark's residual to its standard deviation; noise reaches it once in some
/// thousand marks.
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

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
/// Turn, shift, the common error of depth, scale about the camera.
constexpr int kUnknowns = 8;
constexpr int kCommon = 6, kScale = 7;
using Column = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Rows = Eigen::Matrix<double, 3, kUnknowns>;

constexpr int kIterations = 15;
constexpr double kUnknownM = 10;  // Standard deviation of what is not known.

/// Kabsch: the turn and shift that bring the seen marks nearest to their places, all alike.
Eigen::Isometry3d Start(const std::vector<SeenMark>& marks) {
  Eigen::Matrix3Xd seen(3, marks.size()), places(3, marks.size());
  for (std::size_t i = 0; i < marks.size(); ++i) {
    seen.col(static_cast<Eigen::Index>(i)) = marks[i].seen.p_C_m;
    places.col(static_cast<Eigen::Index>(i)) = marks[i].p_W_m;
  }
  return Eigen::Isometry3d(Eigen::umeyama(seen, places, false));
}

/// The estimate with the scale as a parameter, or held at 1.
struct Solution {
  Eigen::Isometry3d X_WC;
  double common = 0;  ///< Error of depth that all points share, in standard deviations.
  double scale = 1;
  Normal covariance;
  double misfit = 0;
};

/// Sums of weighted rows.
struct Sums {
  Normal normal = Normal::Zero();
  Column gradient = Column::Zero();
  double misfit = 0;
  int rows = 0;

  void Add(const Rows& jacobian, const Vector3d& error, const Matrix3d& covariance, int count) {
    const Eigen::LDLT<Matrix3d> weight(covariance);
    normal += jacobian.transpose() * weight.solve(jacobian);
    gradient += jacobian.transpose() * weight.solve(error);
    misfit += error.dot(weight.solve(error));
    rows += count;
  }
  /// The unknown is 0 with a standard deviation of 1.
  void AddPrior(int unknown, double error) {
    normal(unknown, unknown) += 1;
    gradient[unknown] += error;
    misfit += error * error;
    rows += 1;
  }
};

/// Share of the variance of a point's depth that is common to all points (blur and limb of the
/// camera file, light from within the sphere); the other half is its own (its pixels).
constexpr double kCommonShare = 0.5;

/// One standard deviation of what is common, along the point's ray.
Vector3d CommonSd(const SeenPoint& seen) {
  const Vector3d along = seen.covariance_m2 * seen.p_C_m;
  const double variance = seen.p_C_m.dot(along);
  return variance > 0 ? Vector3d(std::sqrt(kCommonShare / variance) * along) : Vector3d::Zero();
}

Matrix3d OwnCovariance(const SeenPoint& seen) {
  const Vector3d common_sd = CommonSd(seen);
  return seen.covariance_m2 - common_sd * common_sd.transpose();
}

void AddMark(const SeenMark& mark, const Solution& at, double placement_sd_m, Sums& sums) {
  const Matrix3d& turn = at.X_WC.linear();
  const Vector3d common_sd = turn * CommonSd(mark.seen);
  const Vector3d arm = at.scale * (turn * mark.seen.p_C_m);
  const Vector3d place = arm + at.X_WC.translation() - at.common * common_sd;
  Rows jacobian;
  jacobian << -CrossMatrix(place), Matrix3d::Identity(), -common_sd, arm / at.scale;
  const Matrix3d covariance = turn * OwnCovariance(mark.seen) * turn.transpose() +
                              placement_sd_m * placement_sd_m * Matrix3d::Identity();
  sums.Add(jacobian, mark.p_W_m - place, covariance, 3);
}

/// The line from low to high has no level part; how long it is nobody knows.
void AddPlumb(const SeenPlumb& plumb, const Solution& at, double placement_sd_m, Sums& sums) {
  const Matrix3d& turn = at.X_WC.linear();
  const Vector3d common_sd = turn * (CommonSd(plumb.high) - CommonSd(plumb.low));
  const Vector3d line =
      at.scale * (turn * (plumb.high.p_C_m - plumb.low.p_C_m)) - at.common * common_sd;
  Rows jacobian;
  jacobian << -CrossMatrix(line), Matrix3d::Zero(), -common_sd, Vector3d::Zero();
  const double leaning_m = line.norm() * std::sin(plumb.tilt_rad);
  Matrix3d covariance =
      turn * (OwnCovariance(plumb.low) + OwnCovariance(plumb.high)) * turn.transpose();
  covariance +=
      (2 * placement_sd_m * placement_sd_m + leaning_m * leaning_m / 2) * Matrix3d::Identity();
  covariance(2, 2) += kUnknownM * kUnknownM;
  sums.Add(jacobian, Vector3d(-line.x(), -line.y(), 0), covariance, 2);
}

Solution Solve(const Observations& observations, bool with_scale) {
  Solution solution;
  solution.X_WC = Start(observations.marks);
  const int unknowns = with_scale ? kUnknowns : kScale;
  for (int i = 0; i <= kIterations; ++i) {
    Sums sums;
    for (const SeenMark& mark : observations.marks)
      AddMark(mark, solution, observations.placement_sd_m, sums);
    for (const SeenPlumb& plumb : observations.plumbs)
      AddPlumb(plumb, solution, observations.placement_sd_m, sums);
    sums.AddPrior(kCommon, -solution.common);
    const Eigen::MatrixXd inverse = sums.normal.topLeftCorner(unknowns, unknowns)
                                        .ldlt()
                                        .solve(Eigen::MatrixXd::Identity(unknowns, unknowns));
    solution.misfit = sums.misfit / std::max(1, sums.rows - unknowns);
    solution.covariance.setZero();
    solution.covariance.topLeftCorner(unknowns, unknowns) = inverse;
    if (i == kIterations) break;
    const Eigen::VectorXd step = inverse * sums.gradient.head(unknowns);
    const Vector3d turn = step.head<3>();
    const Eigen::AngleAxisd rotation(turn.norm(), turn.stableNormalized());
    Eigen::Isometry3d change = Eigen::Isometry3d::Identity();
    if (turn.norm() > 0) change.linear() = rotation.toRotationMatrix();
    change.translation() = step.segment<3>(3);
    solution.X_WC = change * solution.X_WC;
    solution.common += step[kCommon];
    if (with_scale) solution.scale += step[kScale];
  }
  return solution;
}

double Tilt(const Observations& observations, const Eigen::Isometry3d& X_WC) {
  Vector3d up = Vector3d::Zero();
  for (const SeenPlumb& plumb : observations.plumbs)
    up += X_WC.linear() * (plumb.high.p_C_m - plumb.low.p_C_m);
  return observations.plumbs.empty() ? 0 : std::atan2(up.head<2>().norm(), up.z());
}

}  // namespace

CameraPose Fit(const Observations& observations) {
  FOOTING_CHECK(observations.marks.size() >= 3);
  CameraPose pose;
  const Solution rigid = Solve(observations, false);
  const Solution scaled = Solve(observations, true);
  pose.X_WC = rigid.X_WC;
  pose.covariance = rigid.covariance.topLeftCorner<6, 6>();
  pose.misfit = rigid.misfit;
  pose.scale = scaled.scale;
  pose.scale_sd = std::sqrt(scaled.covariance(kScale, kScale));
  double square = 0;
  for (const SeenMark& mark : observations.marks) {
    pose.residuals_m.push_back((mark.p_W_m - pose.X_WC * mark.seen.p_C_m).norm());
    square += pose.residuals_m.back() * pose.residuals_m.back();
  }
  pose.residual_rms_m = std::sqrt(square / static_cast<double>(pose.residuals_m.size()));
  Observations marks_only = observations;
  marks_only.plumbs.clear();
  pose.tilt_rad =
      observations.plumbs.empty() ? 0 : Tilt(observations, Solve(marks_only, false).X_WC);
  return pose;
}

Matrix3d CameraPose::CovarianceAt(const Vector3d& p_W_m) const {
  Eigen::Matrix<double, 3, 6> rows;
  rows << -CrossMatrix(p_W_m), Matrix3d::Identity();
  return rows * covariance * rows.transpose();
}

double CameraPose::TurnSdRad() const {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> turn(covariance.topLeftCorner<3, 3>());
  return std::sqrt(turn.eigenvalues().maxCoeff());
}

namespace {

Eigen::Isometry3d ToIsometry(const stream::TrackerPose& pose) {
  Eigen::Isometry3d X_WT = Eigen::Isometry3d::Identity();
  X_WT.linear() = pose.rotation.normalized().toRotationMatrix();
  X_WT.translation() = pose.position_m;
  return X_WT;
}

}  // namespace

std::optional<SeenPoint> InTrackerFrame(const stream::HandSample& sample) {
  if (sample.confidence == 0 || !sample.tracker_pose) return {};
  const Eigen::Isometry3d X_TW = ToIsometry(*sample.tracker_pose).inverse();
  return SeenPoint{X_TW * sample.position_m,
                   X_TW.linear() * stream::CovarianceOf(sample) * X_TW.linear().transpose()};
}

stream::HandSample Recalibrated(const stream::HandSample& sample, const Eigen::Isometry3d& X_WC) {
  stream::HandSample other = sample;
  if (!sample.tracker_pose) return other;
  other.tracker_pose = {X_WC.translation(), Eigen::Quaterniond(X_WC.rotation())};
  const auto seen = InTrackerFrame(sample);
  if (!seen) return other;
  const Eigen::Matrix3d covariance =
      X_WC.linear() * seen->covariance_m2 * X_WC.linear().transpose();
  other.position_m = X_WC * seen->p_C_m;
  other.sd_m = covariance.diagonal().cwiseSqrt();
  other.covariance_m2 = {covariance(0, 1), covariance(0, 2), covariance(1, 2)};
  return other;
}

namespace {

using Places = std::array<Vector3d, 3>;  // Origin, ahead, left, in C.

constexpr double kLeastSpanM = 0.2;
constexpr double kMostLengthOff = 0.02;

Eigen::Isometry3d PoseOf(const Places& places, const Vector3d& p_WO_m) {
  const Vector3d x = (places[1] - places[0]).normalized();
  const Vector3d z = x.cross(places[2] - places[0]).normalized();
  Eigen::Isometry3d X_CW = Eigen::Isometry3d::Identity();
  X_CW.linear() << x, z.cross(x), z;
  X_CW.translation() = places[0] - X_CW.linear() * p_WO_m;
  return X_CW.inverse();
}

/// Covariance of turn and shift from the noise of the places, by differences.
Covariance CovarianceOf(const Places& places, const ThreePoses& poses) {
  constexpr double kStepM = 1e-6;
  const Eigen::Isometry3d X_WC = PoseOf(places, poses.p_WO_m);
  const std::array<const SeenPoint*, 3> seen = {&poses.origin, &poses.ahead, &poses.left};
  Covariance covariance = Covariance::Zero();
  for (std::size_t k = 0; k < places.size(); ++k) {
    Eigen::Matrix<double, 6, 3> rows;
    for (int axis = 0; axis < 3; ++axis) {
      Places moved = places;
      moved[k][axis] += kStepM;
      const Eigen::Isometry3d change = PoseOf(moved, poses.p_WO_m) * X_WC.inverse();
      const Eigen::AngleAxisd turn(change.rotation());
      rows.col(axis) << turn.angle() / kStepM * turn.axis(), change.translation() / kStepM;
    }
    const Eigen::Matrix3d noise = seen[k]->covariance_m2 + poses.placement_sd_m *
                                                               poses.placement_sd_m *
                                                               Eigen::Matrix3d::Identity();
    covariance += rows * noise * rows.transpose();
  }
  return covariance;
}

/// Variance of the distance between two places: of each, along the line between them.
double SpanVarianceM2(const SeenPoint& from, const SeenPoint& to, double placement_sd_m) {
  const Vector3d along = (to.p_C_m - from.p_C_m).normalized();
  return along.dot((from.covariance_m2 + to.covariance_m2) * along) +
         2 * placement_sd_m * placement_sd_m;
}

std::optional<Error> WrongSpan(const char* name, double seen_m, double known_m,
                               double variance_m2) {
  const std::string length = text::Fixed(100 * seen_m, 1) + " cm";
  if (seen_m < kLeastSpanM)
    return InvalidData(std::string("the sphere ") + name + " is only " + length +
                       " from the first place: stretch the arm, 20 cm or more");
  if (known_m <= 0) return {};
  const double off_m = std::abs(seen_m - known_m);
  if (off_m <= kMostLengthOff * known_m || off_m <= 3 * std::sqrt(variance_m2)) return {};
  return InvalidData(std::string("the sphere ") + name + " is seen " + length +
                     " from the first place, and should be " + text::Fixed(100 * known_m, 1) +
                     " cm: the lens file or the sphere's radius is not the true one, or the sphere "
                     "was not in its place; measure again");
}

}  // namespace

Result<CameraPose> FromThreePoses(const ThreePoses& poses) {
  const Places places = {poses.origin.p_C_m, poses.ahead.p_C_m, poses.left.p_C_m};
  const Vector3d ahead = places[1] - places[0], left = places[2] - places[0];
  const auto variance_m2 = [&](const SeenPoint& to) {
    return SpanVarianceM2(poses.origin, to, poses.placement_sd_m);
  };
  if (auto wrong = WrongSpan("ahead", ahead.norm(), poses.ahead_m, variance_m2(poses.ahead)))
    return *std::move(wrong);
  if (auto wrong = WrongSpan("to the left", left.norm(), poses.left_m, variance_m2(poses.left)))
    return *std::move(wrong);
  const double angle = std::acos(std::clamp(ahead.normalized().dot(left.normalized()), -1.0, 1.0));
  if (!(angle >= DegreesToRadians(60) && angle <= DegreesToRadians(120)))
    return InvalidData("the second and the third place are " +
                       text::Fixed(RadiansToDegrees(angle), 0) +
                       " degrees apart as seen from the first, 60 to 120 are needed: point "
                       "straight ahead, then straight to the left");
  CameraPose pose;
  pose.X_WC = PoseOf(places, poses.p_WO_m);
  if (pose.X_WC.linear()(2, 1) > 0)
    return InvalidData(
        "the camera would stand on its head: the image is mirrored, or the third place was to the "
        "right. Switch mirroring off in the camera, and point to the left");
  pose.covariance = CovarianceOf(places, poses);
  pose.residuals_m = {0, 0, std::abs(left.norm() * std::cos(angle))};
  pose.residual_rms_m = pose.residuals_m[2] / std::sqrt(3.0);
  return pose;
}

namespace {

/// Once around, which is the way a person walks.
constexpr const char* kCorner[board::kCorners] = {"front left", "front right", "rear right",
                                                  "rear left"};

using CornerPlaces = std::array<Eigen::Vector2d, board::kCorners>;

/// In the order of kCorner for a person who looks forwards: the board's own front may be elsewhere.
CornerPlaces AsSeen(CornerPlaces places) {
  const auto rear = places.begin() + 2;
  std::sort(places.begin(), places.end(),
            [](const auto& a, const auto& b) { return a.x() > b.x(); });
  std::sort(places.begin(), rear, [](const auto& a, const auto& b) { return a.y() > b.y(); });
  std::sort(rear, places.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  return places;
}

void AddMarks(const stream::BoardPose& pose, const std::optional<stream::BoardGeometry>& geometry,
              const std::string& which, double radius_m, std::vector<BoardMark>& marks) {
  const CornerPlaces places = AsSeen(board::SensorPlaces(pose, board::GeometryOr(geometry)));
  for (std::size_t i = 0; i < board::kCorners; ++i)
    marks.push_back({kCorner[i] + which, {places[i].x(), places[i].y(), radius_m}});
}

}  // namespace

std::vector<BoardMark> BoardMarks(const stream::BoardLayout& layout, double radius_m) {
  const bool is_single = layout.preset == "single";
  std::vector<BoardMark> marks;
  AddMarks(layout.left, layout.left_geometry, is_single ? "" : ", left board", radius_m, marks);
  if (!is_single) AddMarks(layout.right, layout.right_geometry, ", right board", radius_m, marks);
  return marks;
}

}  // namespace footing::camera_pose

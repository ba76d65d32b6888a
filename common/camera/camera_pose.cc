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

/// Scatter over what noise and trembling explain, as a ratio of variances. The greatest of three
/// directions of 30 frames of noise stays below it (chi-squared, one in 10^4).
constexpr double kMostScatter = 2.5;

}  // namespace

Result<SeenPoint> MeanAtRest(const std::vector<SeenPoint>& frames, double tremble_m) {
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
      mean.covariance_m2 + tremble_m * tremble_m * Eigen::Matrix3d::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> ratio(scatter, expected);
  if (!(ratio.eigenvalues().maxCoeff() <= kMostScatter))
    return InvalidData("the sphere moved by " + text::Fixed(1e3 * std::sqrt(scatter.trace()), 1) +
                       " mm while it was measured: keep still");
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
constexpr double kMostTurnSdInPosesRad = DegreesToRadians(4);
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

/// The hands do not lie in one plane, so their mirror image fits only when sides were exchanged.
std::optional<Error> Exchanged(const Observations& observations, const CameraPose& pose) {
  Observations exchanged = observations;
  for (SeenMark& mark : exchanged.marks) {
    mark.p_W_m.y() *= -1;
    mark.per_sd.row(1) *= -1;
  }
  if (!(Fit(exchanged).misfit < pose.misfit)) return {};
  return InvalidData(
      "the hands are seen as in a mirror: the image is mirrored, or each controller is in the "
      "other "
      "hand. Switch mirroring off in the camera, and take each controller into its own hand");
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
  if (observations.in_poses)
    return InvalidData("the " + observations.marks[mark].name + ", is " +
                       Mm(pose.residuals_m[mark]) +
                       " from where the other poses put it: hold the three poses again, with "
                       "straight arms; if it stays, the height is not the person's");
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
  if (observations.in_poses)
    return InvalidData(
        "the camera sees the poses " + text::Fixed(100 * std::abs(1 / pose.scale - 1), 0) +
        " % too " + (pose.scale < 1 ? "large" : "small") +
        ", so distances are wrong, too: the focal length, the sphere's radius or the "
        "person's height is not the true one. Check the height, then calibrate the "
        "lens");
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
    const Eigen::Vector3d error =
        mark.p_W_m + mark.per_sd * pose.body - pose.X_WC * mark.seen.p_C_m;
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

std::optional<Error> Uncertain(const Observations& observations, const CameraPose& pose) {
  const double most_rad = observations.in_poses ? kMostTurnSdInPosesRad : kMostTurnSdRad;
  if (pose.TurnSdRad() <= most_rad) return {};
  if (observations.in_poses)
    return InvalidData("the camera's direction stays uncertain by " + Degrees(pose.TurnSdRad()) +
                       ": move the camera nearer, and hold the poses again");
  return InvalidData("the camera's direction stays uncertain by " + Degrees(pose.TurnSdRad()) +
                     ": add marks, farther apart, or move the camera nearer");
}

}  // namespace

Result<CameraPose> Calibrate(const Observations& observations) {
  if (auto refusal = WrongMarks(observations)) return *std::move(refusal);
  Observations marks_only = observations;
  marks_only.plumbs.clear();
  const CameraPose by_marks = Fit(marks_only);
  if (auto refusal = observations.in_poses ? Exchanged(observations, by_marks)
                                           : Mirrored(observations, by_marks))
    return *std::move(refusal);
  CameraPose pose = Fit(observations);
  if (auto refusal = WrongLength(observations, pose)) return *std::move(refusal);
  if (auto refusal = WrongPlace(observations, pose)) return *std::move(refusal);
  if (auto refusal = WrongGravity(observations, pose)) return *std::move(refusal);
  if (auto refusal = Uncertain(observations, pose)) return *std::move(refusal);
  return pose;
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
/// Turn, shift, the common error of depth, the person's measures, scale about the camera.
constexpr int kCommon = 6, kBody = 7, kScale = kBody + kBodyMeasures;
constexpr int kUnknowns = kScale + 1;
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
  Eigen::Matrix<double, kBodyMeasures, 1> body = Eigen::Matrix<double, kBodyMeasures, 1>::Zero();
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
  jacobian << -CrossMatrix(place), Matrix3d::Identity(), -common_sd, -mark.per_sd, arm / at.scale;
  const Matrix3d covariance = turn * OwnCovariance(mark.seen) * turn.transpose() +
                              placement_sd_m * placement_sd_m * Matrix3d::Identity();
  sums.Add(jacobian, mark.p_W_m + mark.per_sd * at.body - place, covariance, 3);
}

/// The line from low to high has no level part; how long it is nobody knows.
void AddPlumb(const SeenPlumb& plumb, const Solution& at, double placement_sd_m, Sums& sums) {
  const Matrix3d& turn = at.X_WC.linear();
  const Vector3d common_sd = turn * (CommonSd(plumb.high) - CommonSd(plumb.low));
  const Vector3d line =
      at.scale * (turn * (plumb.high.p_C_m - plumb.low.p_C_m)) - at.common * common_sd;
  Rows jacobian;
  jacobian << -CrossMatrix(line), Matrix3d::Zero(), -common_sd, PerMeasure::Zero(),
      Vector3d::Zero();
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
    for (int k = 0; k < kBodyMeasures; ++k) sums.AddPrior(kBody + k, -solution.body[k]);
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
    solution.body += step.segment<kBodyMeasures>(kBody);
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
  pose.body = rigid.body;
  pose.scale = scaled.scale;
  pose.scale_sd = std::sqrt(scaled.covariance(kScale, kScale));
  double square = 0;
  for (const SeenMark& mark : observations.marks) {
    pose.residuals_m.push_back(
        (mark.p_W_m + mark.per_sd * pose.body - pose.X_WC * mark.seen.p_C_m).norm());
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

/// A person's measures over the height, and their standard deviations: 17 skeletons of the CMU and
/// HDM05 motion libraries. Shoulders are joint centres; an arm ends in the middle of the fist.
constexpr double kShoulderHeight = 0.791, kShoulderHeightSd = 0.012;
constexpr double kHalfShoulders = 0.108, kHalfShouldersSd = 0.012;
constexpr double kArm = 0.351, kArmSd = 0.014;
/// How far the shoulders are behind the centre of mass, and how much farther while both arms (9 %
/// of the mass) point ahead and the person leans back; their place over the centre of pressure.
constexpr double kShouldersBehind = 0.020, kArmsAheadBehind = 0.0185;
constexpr double kStandingSdM = 0.02;
// How people hold poses, in radians; no measurement of this is known to us. Hands pass the hips.
constexpr double kHangOutRad = 0.07;
constexpr double kHeadingSdRad = 0.035, kArmsLevelSdRad = 0.05;

}  // namespace

std::vector<Mark> PoseMarks(double height_m, double fist_to_sphere_m) {
  const double arm_m = kArm * height_m;
  struct Pose {
    const char* name;
    Vector3d arm;  ///< Direction of the left arm.
    Vector3d to_sphere;
    double behind;
    int level;  ///< Index of the measure that says how high the arms are held; -1: they hang.
  };
  const Pose poses[] = {
      {"arms down", {0, std::sin(kHangOutRad), -std::cos(kHangOutRad)}, Vector3d::UnitX(), 0, -1},
      {"arms ahead", Vector3d::UnitX(), Vector3d::UnitZ(), kArmsAheadBehind, 6},
      {"arms to the sides", Vector3d::UnitY(), Vector3d::UnitZ(), 0, 7}};
  std::vector<Mark> marks;
  for (const Pose& pose : poses) {
    for (const double side : {1.0, -1.0}) {
      const Vector3d arm(pose.arm.x(), side * pose.arm.y(), pose.arm.z());
      const Vector3d shoulder = height_m * Vector3d(-kShouldersBehind - pose.behind,
                                                    side * kHalfShoulders, kShoulderHeight);
      Mark mark;
      mark.name = std::string(side > 0 ? "left" : "right") + " hand, " + pose.name;
      mark.p_W_m = shoulder + arm_m * arm + fist_to_sphere_m * pose.to_sphere;
      mark.per_sd.col(0) = kShoulderHeightSd * height_m * Vector3d::UnitZ();
      mark.per_sd.col(1) = side * kHalfShouldersSd * height_m * Vector3d::UnitY();
      mark.per_sd.col(2) = kArmSd * height_m * arm;
      mark.per_sd.col(3) = kStandingSdM * Vector3d::UnitX();
      mark.per_sd.col(4) = kStandingSdM * Vector3d::UnitY();
      mark.per_sd.col(5) = kHeadingSdRad * Vector3d::UnitZ().cross(mark.p_W_m);
      if (pose.level >= 0)
        mark.per_sd.col(pose.level) = kArmsLevelSdRad * arm_m * Vector3d::UnitZ();
      marks.push_back(mark);
    }
  }
  return marks;
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
              const std::string& which, double radius_m, std::vector<Mark>& marks) {
  const CornerPlaces places = AsSeen(board::SensorPlaces(pose, board::GeometryOr(geometry)));
  for (std::size_t i = 0; i < board::kCorners; ++i)
    marks.push_back(
        {kCorner[i] + which, {places[i].x(), places[i].y(), radius_m}, PerMeasure::Zero()});
}

}  // namespace

std::vector<Mark> BoardMarks(const stream::BoardLayout& layout, double radius_m) {
  const bool is_single = layout.preset == "single";
  std::vector<Mark> marks;
  AddMarks(layout.left, layout.left_geometry, is_single ? "" : ", left board", radius_m, marks);
  if (!is_single) AddMarks(layout.right, layout.right_geometry, ", right board", radius_m, marks);
  return marks;
}

}  // namespace footing::camera_pose

#include "common/camera/fit_lens.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace footing::lens_calibration {
namespace {

constexpr std::size_t kLeastViews = 6;
constexpr double kMostRmsPx = 0.5;
constexpr double kLeastCovered = 0.6;
constexpr double kMostFocalSd = 0.01;  // Of the focal length.
constexpr int kShared = 8, kOwn = 6;   // Parameters of the lens, and of a view.

/// Where a sheet is: its columns and rows in C, in pitches.
struct Pose {
  Eigen::Matrix3d R_CS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_C{0, 0, 1};

  Pose Moved(const Eigen::Matrix<double, kOwn, 1>& by) const {
    const Eigen::Vector3d turn = by.head<3>();
    const double angle = turn.norm();
    Pose next = *this;
    if (angle > 1e-12) next.R_CS = Eigen::AngleAxisd(angle, turn / angle) * R_CS;
    next.p_C += by.tail<3>();
    return next;
  }
};

sphere::Lens Moved(const sphere::Lens& lens, const Eigen::Matrix<double, kShared, 1>& by) {
  sphere::Lens next = lens;
  next.fx_px += by[0];
  next.fy_px += by[1];
  next.cx_px += by[2];
  next.cy_px += by[3];
  next.k1 += by[4];
  next.k2 += by[5];
  next.p1 += by[6];
  next.p2 += by[7];
  return next;
}

Eigen::Vector2d Residual(const sphere::Lens& lens, const Pose& pose, const GridDot& dot) {
  const Eigen::Vector3d p = pose.R_CS.leftCols<2>() * dot.at.cast<double>() + pose.p_C;
  return sphere::ToPixel(lens, p.head<2>() / p.z()) - dot.pixel;
}

/// Homography from the sheet to pixels less a middle, by the direct linear transformation.
Eigen::Matrix3d HomographyOf(const View& view, const Eigen::Vector2d& middle_px, double scale_px) {
  Eigen::MatrixXd rows(2 * view.size(), 9);
  Eigen::Index at = 0;
  for (const GridDot& dot : view) {
    const Eigen::Vector2d to = (dot.pixel - middle_px) / scale_px;
    const Eigen::RowVector3d from(dot.at.x(), dot.at.y(), 1);
    rows.row(at++) << from, Eigen::RowVector3d::Zero(), -to.x() * from;
    rows.row(at++) << Eigen::RowVector3d::Zero(), from, -to.y() * from;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(
      Eigen::Matrix<double, 9, 9>(rows.transpose() * rows));
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  Eigen::Matrix3d homography;
  homography << h.head<3>().transpose(), h.segment<3>(3).transpose(), h.tail<3>().transpose();
  return Eigen::Vector3d(scale_px, scale_px, 1).asDiagonal() * homography;
}

/// Focal length for which the sheets' axes are at right angles and equally long.
std::optional<double> FocalOf(const std::vector<Eigen::Matrix3d>& homographies) {
  double ab = 0, aa = 0;
  for (const Eigen::Matrix3d& one : homographies) {
    const Eigen::Matrix3d h = one / one.norm();
    const auto add = [&](double a, double b) {
      ab += a * b;
      aa += a * a;
    };
    add(h(0, 0) * h(0, 1) + h(1, 0) * h(1, 1), h(2, 0) * h(2, 1));
    add(h.col(0).head<2>().squaredNorm() - h.col(1).head<2>().squaredNorm(),
        h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1));
  }
  if (!(ab < 0) || !(aa > 0)) return std::nullopt;
  return std::sqrt(-aa / ab);
}

Pose PoseOf(const Eigen::Matrix3d& homography, double focal_px) {
  Eigen::Matrix3d b = Eigen::Vector3d(1 / focal_px, 1 / focal_px, 1).asDiagonal() * homography;
  b /= 0.5 * (b.col(0).norm() + b.col(1).norm());
  if (b(2, 2) < 0) b = -b;
  Eigen::Matrix3d turn;
  turn << b.col(0), b.col(1), b.col(0).cross(b.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU() * svd.matrixV().transpose(), b.col(2)};
}

/// Lens and poses together, by Levenberg-Marquardt.
class Adjustment {
 public:
  Adjustment(const std::vector<View>& views, const sphere::Lens& lens, std::vector<Pose> poses)
      : views_(views), lens_(lens), poses_(std::move(poses)) {}

  void Solve() {
    double lambda = 1e-3, cost = Cost(lens_, poses_);
    for (int round = 0; round < 60; ++round) {
      Linearise();
      Eigen::MatrixXd damped = normal_;
      damped.diagonal() *= 1 + lambda;
      const Eigen::VectorXd step = damped.ldlt().solve(-right_);
      const sphere::Lens lens = Moved(lens_, step.head<kShared>());
      std::vector<Pose> poses;
      for (std::size_t i = 0; i < poses_.size(); ++i)
        poses.push_back(
            poses_[i].Moved(step.segment<kOwn>(kShared + kOwn * static_cast<Eigen::Index>(i))));
      const double next = Cost(lens, poses);
      if (!(next < cost)) {
        lambda *= 10;
        if (lambda > 1e8) return;
        continue;
      }
      const bool has_ended = next > (1 - 1e-10) * cost;
      lens_ = lens;
      poses_ = std::move(poses);
      cost = next;
      lambda *= 0.1;
      if (has_ended) return;
    }
  }

  LensFit Report() {
    LensFit fit;
    fit.lens = lens_;
    double count = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      for (const GridDot& dot : views_[i]) {
        fit.largest_px = std::max(fit.largest_px, Residual(lens_, poses_[i], dot).norm());
        ++count;
      }
    }
    fit.rms_px = std::sqrt(Cost(lens_, poses_) / count);
    Linearise();
    const Eigen::MatrixXd covariance =
        0.5 * fit.rms_px * fit.rms_px *
        normal_.ldlt().solve(Eigen::MatrixXd::Identity(normal_.rows(), normal_.cols()));
    const auto sd = [&](int at) { return std::sqrt(covariance(at, at)); };
    fit.focal_sd_px = std::max(sd(0), sd(1));
    fit.centre_sd_px = std::max(sd(2), sd(3));
    return fit;
  }

  /// Of one view.
  double Rms(std::size_t i) const {
    double square = 0;
    for (const GridDot& dot : views_[i]) square += Residual(lens_, poses_[i], dot).squaredNorm();
    return std::sqrt(square / static_cast<double>(views_[i].size()));
  }

 private:
  double Cost(const sphere::Lens& lens, const std::vector<Pose>& poses) const {
    double cost = 0;
    for (std::size_t i = 0; i < views_.size(); ++i)
      for (const GridDot& dot : views_[i]) cost += Residual(lens, poses[i], dot).squaredNorm();
    return cost;
  }

  /// Normal equations by central differences.
  void Linearise() {
    const auto size = kShared + kOwn * static_cast<Eigen::Index>(views_.size());
    normal_.setZero(size, size);
    right_.setZero(size);
    constexpr std::array<double, kShared> kSteps = {1e-3, 1e-3, 1e-3, 1e-3, 1e-6, 1e-6, 1e-6, 1e-6};
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const auto own = kShared + kOwn * static_cast<Eigen::Index>(i);
      for (const GridDot& dot : views_[i]) {
        Eigen::Matrix<double, 2, kShared + kOwn> slope;
        for (int k = 0; k < kShared + kOwn; ++k) {
          const double step = k < kShared ? kSteps[static_cast<std::size_t>(k)] : 1e-6;
          slope.col(k) = (At(i, dot, k, step) - At(i, dot, k, -step)) / (2 * step);
        }
        const Eigen::Vector2d residual = Residual(lens_, poses_[i], dot);
        const auto a = slope.leftCols<kShared>();
        const auto b = slope.rightCols<kOwn>();
        normal_.topLeftCorner<kShared, kShared>() += a.transpose() * a;
        normal_.block<kShared, kOwn>(0, own) += a.transpose() * b;
        normal_.block<kOwn, kShared>(own, 0) += b.transpose() * a;
        normal_.block<kOwn, kOwn>(own, own) += b.transpose() * b;
        right_.head<kShared>() += a.transpose() * residual;
        right_.segment<kOwn>(own) += b.transpose() * residual;
      }
    }
  }

  Eigen::Vector2d At(std::size_t view, const GridDot& dot, int parameter, double by) const {
    if (parameter < kShared) {
      Eigen::Matrix<double, kShared, 1> step = Eigen::Matrix<double, kShared, 1>::Zero();
      step[parameter] = by;
      return Residual(Moved(lens_, step), poses_[view], dot);
    }
    Eigen::Matrix<double, kOwn, 1> step = Eigen::Matrix<double, kOwn, 1>::Zero();
    step[parameter - kShared] = by;
    return Residual(lens_, poses_[view].Moved(step), dot);
  }

  const std::vector<View>& views_;
  sphere::Lens lens_;
  std::vector<Pose> poses_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd right_;
};

std::string Percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

std::string Hundredths(double value) {
  const auto all = std::lround(100 * value);
  const std::string rest = std::to_string(all % 100);
  return std::to_string(all / 100) + "." + (rest.size() < 2 ? "0" : "") + rest;
}

/// What is wrong with a fit; empty when it can be used.
std::string Doubt(const LensFit& fit, const Adjustment& adjustment, std::size_t views) {
  if (fit.rms_px > kMostRmsPx) {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < views; ++i)
      if (adjustment.Rms(i) > adjustment.Rms(worst)) worst = i;
    return "dots are " + Hundredths(fit.rms_px) + " px off, the worst ones in view " +
           std::to_string(worst + 1) + ": keep the sheet flat and still, and the picture sharp";
  }
  if (!(fit.focal_sd_px < kMostFocalSd * fit.lens.fx_px))
    return "the focal length is not certain: tilt the sheet by 30 degrees and more, to all sides";
  return sphere::Problem(fit.lens);
}

}  // namespace

double Covered(const std::vector<View>& views, int width, int height) {
  std::array<bool, 48> has{};
  for (const View& view : views) {
    for (const GridDot& dot : view) {
      const int column = std::clamp(static_cast<int>(8 * dot.pixel.x() / width), 0, 7);
      const int row = std::clamp(static_cast<int>(6 * dot.pixel.y() / height), 0, 5);
      has[static_cast<std::size_t>(8 * row + column)] = true;
    }
  }
  return static_cast<double>(std::count(has.begin(), has.end(), true)) / 48;
}

Result<LensFit> FitLens(const std::vector<View>& views, int width, int height) {
  if (views.size() < kLeastViews)
    return InvalidData("the dots were seen in " + std::to_string(views.size()) +
                       " places, and 6 are needed");
  const double covered = Covered(views, width, height);
  if (covered < kLeastCovered)
    return InvalidData("the dots cover " + Percent(covered) +
                       " of the picture, and 60 % are needed: bring the sheet to its edges, too");
  sphere::Lens lens;
  lens.width = width;
  lens.height = height;
  const Eigen::Vector2d middle_px(0.5 * (width - 1), 0.5 * (height - 1));
  lens.cx_px = middle_px.x();
  lens.cy_px = middle_px.y();
  std::vector<Eigen::Matrix3d> homographies;
  for (const View& view : views) homographies.push_back(HomographyOf(view, middle_px, width));
  const auto focal_px = FocalOf(homographies);
  if (!focal_px)
    return InvalidData("the sheet was parallel to the camera: tilt it by 30 degrees and more");
  lens.fx_px = lens.fy_px = *focal_px;
  std::vector<Pose> poses;
  for (const Eigen::Matrix3d& one : homographies) poses.push_back(PoseOf(one, *focal_px));
  Adjustment adjustment(views, lens, std::move(poses));
  adjustment.Solve();
  LensFit fit = adjustment.Report();
  fit.covered = covered;
  if (const std::string doubt = Doubt(fit, adjustment, views.size()); !doubt.empty())
    return InvalidData(doubt);
  return fit;
}

}  // namespace footing::lens_calibration

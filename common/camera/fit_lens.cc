#include "common/camera/fit_lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Dense>

namespace footing::lens_calibration {
namespace {

constexpr double kDarkShare = 0.75;  // Share of the mean around, to which the dots belong too.
constexpr int kWindowShare = 8;      // The mean is of this part of the width.
constexpr std::size_t kLeastPixels = 12, kMostPixels = 6000;
constexpr double kLeastFill = 0.75, kMostFill = 1.2, kMostAspect = 2.5;
constexpr double kMostAreaRatio = 2.5;   // Ratio of neighbours' areas.
constexpr double kOffPrediction = 0.35;  // Distance from the predicted place, share of the step.

/// Light of every 2 x 2 pixels, which a mosaic mixes alike everywhere; its pixel (0, 0) is at
/// (0.5, 0.5) of the image.
class Grey {
 public:
  explicit Grey(const sphere::Image& image) : width_(image.width - 1), height_(image.height - 1) {
    light_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u)
        light_.push_back(image.Value(u, v) + image.Value(u + 1, v) + image.Value(u, v + 1) +
                         image.Value(u + 1, v + 1));
    Sum();
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool Has(int u, int v) const { return u >= 0 && v >= 0 && u < width_ && v < height_; }
  int At(int u, int v) const { return light_[Index(u, v)]; }
  bool IsDark(int u, int v) const {
    const int half = width_ / kWindowShare / 2;
    const int u0 = std::max(0, u - half), v0 = std::max(0, v - half);
    const int u1 = std::min(width_, u + half + 1), v1 = std::min(height_, v + half + 1);
    const double sum = SumTo(u1, v1) - SumTo(u0, v1) - SumTo(u1, v0) + SumTo(u0, v0);
    return At(u, v) < kDarkShare * sum / ((u1 - u0) * (v1 - v0));
  }

 private:
  std::size_t Index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(u);
  }
  /// Sum of all pixels above and left of a corner.
  double SumTo(int u, int v) const {
    return sums_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_ + 1) +
                 static_cast<std::size_t>(u)];
  }
  void Sum() {
    const auto row = static_cast<std::size_t>(width_ + 1);
    sums_.assign(row * static_cast<std::size_t>(height_ + 1), 0);
    for (int v = 0; v < height_; ++v) {
      double line = 0;
      for (int u = 0; u < width_; ++u) {
        line += At(u, v);
        const auto at = static_cast<std::size_t>(v + 1) * row + static_cast<std::size_t>(u + 1);
        sums_[at] = sums_[at - row] + line;
      }
    }
  }

  int width_, height_;
  std::vector<int> light_;
  std::vector<double> sums_;
};

struct Spot {
  Eigen::Vector2d centre{0, 0};  // In the grey image.
  double area = 0;
};

/// Middle of the darkness in and around a box, less than what is around the spot.
Eigen::Vector2d MiddleOf(const Grey& grey, int left, int top, int right, int bottom) {
  constexpr int kMargin = 3;
  std::vector<int> around;
  for (int v = top - kMargin; v <= bottom + kMargin; ++v)
    for (int u = left - kMargin; u <= right + kMargin; ++u)
      if (grey.Has(u, v) && (u < left - 1 || u > right + 1 || v < top - 1 || v > bottom + 1))
        around.push_back(grey.At(u, v));
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
  std::nth_element(around.begin(), middle, around.end());
  // Noise of the paper is not darkness.
  const double white = 0.93 * *middle;
  double sum = 0;
  Eigen::Vector2d at(0, 0);
  for (int v = top - kMargin; v <= bottom + kMargin; ++v) {
    for (int u = left - kMargin; u <= right + kMargin; ++u) {
      if (!grey.Has(u, v)) continue;
      const double dark = std::max(0.0, white - grey.At(u, v));
      sum += dark;
      at += dark * Eigen::Vector2d(u, v);
    }
  }
  return at / std::max(1e-9, sum);
}

/// Dark connected pixels from one on; `is_open` are those that no spot has yet.
std::optional<Spot> TakeSpot(const Grey& grey, int u, int v, std::vector<bool>& is_open) {
  const auto index = [&grey](int at_u, int at_v) {
    return static_cast<std::size_t>(at_v) * static_cast<std::size_t>(grey.width()) +
           static_cast<std::size_t>(at_u);
  };
  int left = u, right = u, top = v, bottom = v;
  std::size_t pixels = 0;
  std::vector<std::pair<int, int>> waiting = {{u, v}};
  is_open[index(u, v)] = false;
  while (!waiting.empty()) {
    const auto [at_u, at_v] = waiting.back();
    waiting.pop_back();
    ++pixels;
    left = std::min(left, at_u);
    right = std::max(right, at_u);
    top = std::min(top, at_v);
    bottom = std::max(bottom, at_v);
    for (const auto& [du, dv] :
         {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      if (!grey.Has(at_u + du, at_v + dv) || !is_open[index(at_u + du, at_v + dv)]) continue;
      is_open[index(at_u + du, at_v + dv)] = false;
      waiting.emplace_back(at_u + du, at_v + dv);
    }
  }
  const bool is_cut = left < 2 || top < 2 || right > grey.width() - 3 || bottom > grey.height() - 3;
  const double width = right - left + 1, height = bottom - top + 1;
  const double fill = static_cast<double>(pixels) / (std::numbers::pi / 4 * width * height);
  if (is_cut || pixels < kLeastPixels || pixels > kMostPixels || fill < kLeastFill ||
      fill > kMostFill || std::max(width, height) > kMostAspect * std::min(width, height))
    return std::nullopt;
  return Spot{MiddleOf(grey, left, top, right, bottom), static_cast<double>(pixels)};
}

std::vector<Spot> SpotsOf(const Grey& grey) {
  std::vector<bool> is_open;
  for (int v = 0; v < grey.height(); ++v)
    for (int u = 0; u < grey.width(); ++u) is_open.push_back(grey.IsDark(u, v));
  std::vector<Spot> spots;
  std::size_t at = 0;
  for (int v = 0; v < grey.height(); ++v) {
    for (int u = 0; u < grey.width(); ++u, ++at) {
      if (!is_open[at]) continue;
      if (const auto spot = TakeSpot(grey, u, v, is_open)) spots.push_back(*spot);
    }
  }
  return spots;
}

/// The steps of the grid at a dot, px: along a row and along a column.
struct Steps {
  Eigen::Vector2d along, down;
};

bool AreAlike(const Spot& a, const Spot& b) {
  return std::max(a.area, b.area) < kMostAreaRatio * std::min(a.area, b.area);
}

/// The nearest neighbour, and the nearest one across.
std::optional<Steps> StepsAt(const std::vector<Spot>& spots, std::size_t from) {
  std::optional<Eigen::Vector2d> along, down;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < spots.size(); ++i) {
      if (i == from || !AreAlike(spots[i], spots[from])) continue;
      const Eigen::Vector2d step = spots[i].centre - spots[from].centre;
      if (pass == 0 && (!along || step.norm() < along->norm())) along = step;
      if (pass == 0 || !along) continue;
      const double cosine = std::abs(step.normalized().dot(along->normalized()));
      if (cosine < 0.6 && (!down || step.norm() < down->norm())) down = step;
    }
  }
  if (!along || !down || down->norm() > 2.5 * along->norm()) return std::nullopt;
  return Steps{*along, *down};
}

/// Follows the grid from one spot on, step by step.
std::vector<GridDot> GrowFrom(const std::vector<Spot>& spots, std::size_t first) {
  const auto steps = StepsAt(spots, first);
  if (!steps) return {};
  struct Node {
    std::size_t spot;
    Eigen::Vector2i at;
    Steps steps;
  };
  std::vector<bool> is_taken(spots.size());
  std::deque<Node> open = {{first, {0, 0}, *steps}};
  is_taken[first] = true;
  std::vector<GridDot> dots;
  while (!open.empty()) {
    const Node node = open.front();
    open.pop_front();
    dots.push_back({node.at, spots[node.spot].centre + Eigen::Vector2d(0.5, 0.5)});
    for (const Eigen::Vector2i& way : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                       Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
      const Eigen::Vector2d step = way.x() * node.steps.along + way.y() * node.steps.down;
      const Eigen::Vector2d expected = spots[node.spot].centre + step;
      std::size_t nearest = spots.size();
      double least = kOffPrediction * step.norm();
      for (std::size_t i = 0; i < spots.size(); ++i) {
        const double off = (spots[i].centre - expected).norm();
        if (is_taken[i] || off >= least || !AreAlike(spots[i], spots[node.spot])) continue;
        least = off;
        nearest = i;
      }
      if (nearest == spots.size()) continue;
      is_taken[nearest] = true;
      Node next{nearest, node.at + way, node.steps};
      const Eigen::Vector2d seen = spots[nearest].centre - spots[node.spot].centre;
      (way.y() == 0 ? next.steps.along : next.steps.down) = (way.x() + way.y()) * seen;
      open.push_back(next);
    }
  }
  return dots;
}

}  // namespace

std::vector<GridDot> FindDotGrid(const sphere::Image& image) {
  const std::vector<Spot> spots = SpotsOf(Grey(image));
  // Things on the table are spots too: the largest grid counts.
  std::vector<GridDot> largest;
  for (std::size_t first = 0; first < spots.size(); first += 1 + spots.size() / 12) {
    std::vector<GridDot> dots = GrowFrom(spots, first);
    if (dots.size() > largest.size()) largest = std::move(dots);
  }
  return largest.size() < kLeastDots ? std::vector<GridDot>() : largest;
}

namespace {

constexpr std::size_t kLeastViews = 6;
constexpr double kMostRmsPx = 0.5;
constexpr double kLeastCovered = 0.6;
constexpr double kMostFocalSd = 0.01;  // Share of the focal length.
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

  /// Residual of one view, RMS.
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

/// Problem of a fit; empty when it can be used.
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

namespace {

constexpr double kNew = 0.025;    // Share of the image's width, in one of six numbers.
constexpr double kRests = 0.001;  // From one frame to the next.
constexpr double kEnoughCovered = 0.75;

}  // namespace

ViewCollector::Shape ViewCollector::ShapeOf(const View& view, int width) {
  const auto count = static_cast<double>(view.size());
  Eigen::Vector2d mean(0, 0);
  for (const GridDot& dot : view) mean += dot.pixel / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  // Perspective makes one side smaller: the third moments.
  Eigen::Vector2d skew(0, 0);
  for (const GridDot& dot : view) {
    const Eigen::Vector2d from = dot.pixel - mean;
    spread += from * from.transpose() / count;
    skew += from.cwiseAbs2().cwiseProduct(from) / count;
  }
  Shape shape;
  shape << mean, std::sqrt(spread(0, 0)), std::sqrt(spread(1, 1)), std::cbrt(skew.x()),
      std::cbrt(skew.y());
  return shape / width;
}

bool ViewCollector::Take(const sphere::Image& image) {
  width_ = image.width;
  height_ = image.height;
  View view = FindDotGrid(image);
  if (view.empty()) {
    last_.reset();
    return false;
  }
  const Shape shape = ShapeOf(view, image.width);
  const std::optional<Shape> before = std::exchange(last_, shape);
  const auto apart = [&shape](const Shape& other) { return (shape - other).cwiseAbs().maxCoeff(); };
  if (needs_rest_ && (!before || apart(*before) > kRests)) return false;
  const bool is_known = std::any_of(shapes_.begin(), shapes_.end(),
                                    [&](const Shape& other) { return apart(other) < kNew; });
  if (is_known) return false;
  views_.push_back(std::move(view));
  shapes_.push_back(shape);
  return true;
}

bool ViewCollector::is_complete() const {
  return static_cast<int>(views_.size()) >= wanted_ &&
         Covered(views_, width_, height_) >= kEnoughCovered;
}

std::string ViewCollector::Advice() const {
  const std::string count =
      "view " + std::to_string(views_.size()) + " of " + std::to_string(wanted_) + ": ";
  if (!last_) return count + "hold the sheet of dots before the camera, well lit and flat";
  if (static_cast<int>(views_.size()) < wanted_)
    return count + "move the sheet elsewhere, tilt it another way, and keep it still";
  const auto covered = std::lround(100 * Covered(views_, width_, height_));
  return count + "bring the sheet to the picture's edges and corners (" + std::to_string(covered) +
         " % are covered)";
}

}  // namespace footing::lens_calibration

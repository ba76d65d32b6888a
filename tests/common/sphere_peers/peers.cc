#include "tests/common/sphere_peers/peers.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace footing::sphere_peers {
namespace {

using Contour = std::vector<cv::Point>;

// psmoveapi's widths of hue (of 180), saturation and value.
constexpr int kHue = 8, kSaturation = 85, kValue = 85;
constexpr double kLeastAreaPx = 4;

cv::Vec3b Hsv(const Eigen::Vector3d& colour_dn) {
  const cv::Vec3b bgr(cv::saturate_cast<uchar>(colour_dn.z()),
                      cv::saturate_cast<uchar>(colour_dn.y()),
                      cv::saturate_cast<uchar>(colour_dn.x()));
  cv::Mat pixel(1, 1, CV_8UC3, cv::Scalar(bgr[0], bgr[1], bgr[2]));
  cv::cvtColor(pixel, pixel, cv::COLOR_BGR2HSV);
  return pixel.at<cv::Vec3b>(0, 0);
}

/// Pixels of the sphere's colour.
cv::Mat MaskOf(const virtual_camera::Mosaic& mosaic, const Setup& setup) {
  cv::Mat raw(mosaic.height, mosaic.width, CV_8UC1,
              const_cast<std::uint8_t*>(mosaic.bytes.data()));  // cv::Mat has no const view.
  cv::Mat hsv;
  cv::cvtColor(raw, hsv, cv::COLOR_BayerGB2BGR);  // Rows G R, B G.
  cv::cvtColor(hsv, hsv, cv::COLOR_BGR2HSV);
  const cv::Vec3b colour = Hsv(setup.colour_dn);
  const auto range = [&](int low_hue, int high_hue) {
    cv::Mat mask;
    cv::inRange(hsv, cv::Scalar(low_hue, colour[1] - kSaturation, colour[2] - kValue),
                cv::Scalar(high_hue, colour[1] + kSaturation, colour[2] + kValue), mask);
    return mask;
  };
  const int low = colour[0] - kHue, high = colour[0] + kHue;
  cv::Mat mask = range(std::max(0, low), std::min(179, high));
  if (low < 0) mask |= range(low + 180, 179);
  if (high > 179) mask |= range(0, high - 180);
  return mask;
}

std::optional<Contour> LargestContour(const virtual_camera::Mosaic& mosaic, const Setup& setup) {
  std::vector<Contour> contours;
  cv::findContours(MaskOf(mosaic, setup), contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  if (contours.empty()) return std::nullopt;
  const auto largest = std::max_element(
      contours.begin(), contours.end(),
      [](const Contour& a, const Contour& b) { return cv::contourArea(a) < cv::contourArea(b); });
  if (cv::contourArea(*largest) < kLeastAreaPx) return std::nullopt;
  return *largest;
}

Eigen::Vector3d RayAt(const virtual_camera::Lens& lens, double u_px, double v_px) {
  return Eigen::Vector3d((u_px - lens.cx_px) / lens.fx_px, (v_px - lens.cy_px) / lens.fy_px, 1)
      .normalized();
}

}  // namespace

std::optional<Eigen::Vector3d> HullCone(const virtual_camera::Mosaic& mosaic, const Setup& setup) {
  const auto contour = LargestContour(mosaic, setup);
  if (!contour) return std::nullopt;
  Contour hull;
  cv::convexHull(*contour, hull);
  // Points on the image's edge are none of the sphere's.
  std::erase_if(hull, [&](const cv::Point& point) {
    return point.x <= 0 || point.y <= 0 || point.x >= mosaic.width - 1 ||
           point.y >= mosaic.height - 1;
  });
  if (hull.size() < 5) return std::nullopt;
  // Unit rays u that touch the sphere satisfy u . w = 1, and |w| = 1 / cos of the half angle.
  cv::Mat rays(static_cast<int>(hull.size()), 3, CV_64F);
  for (int i = 0; i < rays.rows; ++i) {
    const cv::Point& point = hull[static_cast<std::size_t>(i)];
    const Eigen::Vector3d ray = RayAt(setup.lens, point.x, point.y);
    for (int k = 0; k < 3; ++k) rays.at<double>(i, k) = ray[k];
  }
  cv::Mat w;
  cv::solve(rays, cv::Mat::ones(rays.rows, 1, CV_64F), w, cv::DECOMP_SVD);
  const Eigen::Vector3d axis(w.at<double>(0), w.at<double>(1), w.at<double>(2));
  const double cosine = 1 / axis.norm();
  if (!(cosine < 1)) return std::nullopt;
  return setup.radius_m / std::sqrt(1 - cosine * cosine) * axis.normalized();
}

std::optional<Eigen::Vector3d> EnclosingCircle(const virtual_camera::Mosaic& mosaic,
                                               const Setup& setup) {
  const auto contour = LargestContour(mosaic, setup);
  if (!contour) return std::nullopt;
  cv::Point2f centre;
  float radius_px = 0;
  cv::minEnclosingCircle(*contour, centre, radius_px);
  if (!(radius_px > 0)) return std::nullopt;
  const Eigen::Vector3d ray = RayAt(setup.lens, centre.x, centre.y);
  return ray * (setup.lens.fx_px * setup.radius_m / (radius_px * ray.z()));
}

}  // namespace footing::sphere_peers

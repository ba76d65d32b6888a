#include "daemon/sensor/reports/camera.h"

namespace footing::reports {
namespace {

constexpr std::uint32_t kRows = 768;
constexpr std::size_t kBasicPairBytes = 5;
constexpr std::size_t kExtendedBytes = 3;
constexpr std::size_t kFullBytes = 9;

void AppendSeen(std::vector<stream::CameraPoint>& points, int x, int y, int size) {
  const stream::CameraPoint point{static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                  static_cast<std::uint32_t>(size)};
  if (point.y < kRows) points.push_back(point);
}

/// Two points in five bytes: x1, y1, upper bits of y1 x1 y2 x2, x2, y2.
void AppendBasicPair(std::vector<stream::CameraPoint>& points, Bytes pair) {
  const int upper = pair[2];
  AppendSeen(points, pair[0] | (upper >> 4 & 3) << 8, pair[1] | (upper >> 6 & 3) << 8, 0);
  AppendSeen(points, pair[3] | (upper & 3) << 8, pair[4] | (upper >> 2 & 3) << 8, 0);
}

/// x, y, then the upper bits of y and x and the size; the full format goes on with the bounding box
/// and the brightness.
void AppendExtended(std::vector<stream::CameraPoint>& points, Bytes point) {
  const int upper = point[2];
  AppendSeen(points, point[0] | (upper >> 4 & 3) << 8, point[1] | (upper >> 6 & 3) << 8,
             upper & 0x0f);
}

}  // namespace

std::vector<stream::CameraPoint> DecodeCamera(Bytes camera) {
  std::vector<stream::CameraPoint> points;
  switch (camera.size()) {
    case 2 * kBasicPairBytes:
      AppendBasicPair(points, camera.first(kBasicPairBytes));
      AppendBasicPair(points, camera.subspan(kBasicPairBytes));
      break;
    case 4 * kExtendedBytes:
      for (std::size_t at = 0; at < camera.size(); at += kExtendedBytes) {
        AppendExtended(points, camera.subspan(at, kExtendedBytes));
      }
      break;
    case 2 * kFullBytes:
    case 4 * kFullBytes:
      for (std::size_t at = 0; at < camera.size(); at += kFullBytes) {
        AppendExtended(points, camera.subspan(at, kFullBytes));
      }
      break;
    default:
      break;
  }
  return points;
}

}  // namespace footing::reports

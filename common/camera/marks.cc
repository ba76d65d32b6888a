#include "common/camera/marks.h"

#include <algorithm>
#include <array>

#include "common/board/geometry.h"

namespace footing::camera_pose {
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

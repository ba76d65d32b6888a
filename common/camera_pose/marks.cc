#include "common/camera_pose/marks.h"

#include "common/board/geometry.h"

namespace footing::camera_pose {
namespace {

/// In the order of the corners.
constexpr const char* kCorner[board::kCorners] = {"front left", "front right", "rear left",
                                                  "rear right"};
/// Once around, which is the way a person walks.
constexpr std::size_t kOrder[board::kCorners] = {0, 1, 3, 2};

void AddMarks(const stream::BoardPose& pose, const std::optional<stream::BoardGeometry>& geometry,
              const std::string& which, double radius_m, std::vector<BoardMark>& marks) {
  const auto places = board::SensorPlaces(pose, board::GeometryOr(geometry));
  for (const std::size_t corner : kOrder)
    marks.push_back({kCorner[corner] + which, {places[corner].x(), places[corner].y(), radius_m}});
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

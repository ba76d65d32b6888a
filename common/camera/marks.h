#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/stream/setup.h"

namespace footing::camera_pose {

/// A point on a board's surface that a sphere is held on.
struct BoardMark {
  std::string name;                ///< As a person finds it: "front left, left board".
  Eigen::Vector3d p_W_m{0, 0, 0};  ///< Of the centre of a sphere that lies on it.
};

/// Four marks on each board, over its load cells, whose places the layout and the board's geometry
/// give; the plates' surface is z = 0 of W, as for the feet on it. Front and left are the person's,
/// also of a board that lies turned. The left board first; of "single" it is the only one.
std::vector<BoardMark> BoardMarks(const stream::BoardLayout& layout, double radius_m);

}  // namespace footing::camera_pose

#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace footing::guide {

/// A mark of the boards while a camera's pose is calibrated, for whoever draws it.
struct MarkState {
  enum class Stage { kToCome, kNext, kTaken };
  std::string name;
  Eigen::Vector3d p_W_m{0, 0, 0};  ///< Of the centre of a sphere that lies on it.
  Stage stage = Stage::kToCome;
  std::optional<double> residual_m = {};  ///< Of the pose, once there is one.
};

struct MarksState {
  std::vector<MarkState> marks;
  bool upright = false;           ///< The controller stands on the next mark, sphere up.
  std::size_t done = 0, all = 0;  ///< Places, upright ones included.
  double rest_share = 0;          ///< Of the time for which the sphere must rest.
  std::optional<Eigen::Isometry3d> X_WC = {};  ///< The pose, once there is one.
};

}  // namespace footing::guide

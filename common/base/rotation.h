#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace footing {

/// The least rotation that turns the direction of `from` into that of `to`; both of any length but
/// 0. Compiled once: Eigen's FromTwoVectors takes some five seconds wherever it is used.
Eigen::Quaterniond LeastTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// The matrix of the cross product: CrossMatrix(v) a = v x a.
Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v);

}  // namespace footing

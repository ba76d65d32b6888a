#pragma once

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/camera/find.h"
#include "common/virtual/camera/scene.h"

namespace footing::eval {

/// Errors of many estimates: those along the line of sight are depth, those across it lateral.
class SphereErrors {
 public:
  void Add(const sphere::Estimate& found, const Eigen::Vector3d& truth_m);
  nlohmann::ordered_json Json() const;
  /// Found where they are.
  int right() const { return found_ - wrong_; }

 private:
  std::vector<double> depth_mm_;
  int found_ = 0, wrong_ = 0;
  double lateral_mm2_ = 0, nees_ = 0, depth_nees_ = 0, variance_mm2_ = 0, confidence_ = 0;
};

/// One row for every sphere that is there or is found, in a CSV file.
class EstimateRows {
 public:
  /// Adds to the file; an empty path writes nothing.
  Result<void> Open(const std::string& path, const std::string& condition);
  void Add(int frame, std::size_t sphere, const std::optional<sphere::Estimate>& found,
           const std::optional<virtual_camera::Seen>& seen);

 private:
  std::ofstream file_;
  std::string condition_;
};

}  // namespace footing::eval

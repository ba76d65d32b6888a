#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace footing::body {

/// Standard deviation of an angle of a reconstructed body: the RMS error on people who trained no
/// model, in the group of clips where it is largest, in whole degrees above
/// (docs/measurements/pose-angles.csv). Errors are not independent from frame to frame: the mean
/// error of a clip is a great part of them. They were measured with tracked hands.
struct AngleDeviation {
  std::string_view name;
  double upright_deg = 0;
  double bent_deg = 0;  ///< While the mean of both knees is reported as kBentKneeDeg or more.
};

inline constexpr double kBentKneeDeg = 30;
/// Meaning and source of the figures, in one sentence for the exports.
std::string_view AngleDeviationSource();

/// Deviations of the coordinates of joint_angles::JointAngles, both sides alike: "hip_flexion", ...
std::span<const AngleDeviation> CoordinateDeviations();
/// Deviation of a column, such as "hip_flexion_r"; nothing where it is not an angle.
std::optional<AngleDeviation> CoordinateDeviation(std::string_view column);

/// Deviations of the orientation of links in W, as the angle of the rotation between estimate and
/// truth: "pelvis", "thigh", ...
std::span<const AngleDeviation> LinkDeviations();
/// Deviation of each link of a skeleton of a person, by the names and parents of its links (a
/// parent comes first; -1: the root). A link without a landmark has that of the link that it hangs
/// on. Empty where this is not the skeleton of a person.
std::vector<AngleDeviation> DeviationsOfLinks(std::span<const std::string> names,
                                              std::span<const int> parents);

/// The angles of pelvis, trunk and legs whose standard deviation the pose engine states in each
/// frame, in this order: names of joint_angles::JointAngles.
inline constexpr std::array<std::string_view, 16> kStatedAngles = {
    "pelvis_tilt",     "pelvis_list",      "pelvis_rotation", "hip_flexion_r",
    "hip_adduction_r", "hip_rotation_r",   "knee_angle_r",    "ankle_angle_r",
    "hip_flexion_l",   "hip_adduction_l",  "hip_rotation_l",  "knee_angle_l",
    "ankle_angle_l",   "lumbar_extension", "lumbar_bending",  "lumbar_rotation"};
/// Place of a column among them, such as "hip_flexion_r"; nothing where none is stated.
std::optional<std::size_t> StatedAngle(std::string_view column);

}  // namespace footing::body
